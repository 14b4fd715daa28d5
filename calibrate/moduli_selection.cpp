#include "grainlaw/calibrate/moduli_selection.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/moduli_table.hpp"

namespace grainlaw::calibrate {
namespace {

/// NaN where the table has no such column.
double field(const Record& table, const char* column, std::size_t row) {
  return table.has(column) ? table[column][row] : std::nan("");
}

bool has_moduli(const Record& table, std::size_t row) {
  return std::isfinite(table["B"][row] + table["A1"][row] + table["A2"][row] + table["G_oct"][row]);
}

ModuliState state_at(const Record& table, std::size_t row) {
  ModuliState s;
  s.eps_dev = field(table, "eps_dev", row);
  s.nu = table["nu"][row];
  s.P = table["P"][row];
  s.sigma_dev = table["sigma_dev"][row];
  s.F_v = table["F_v"][row];
  s.F_dev = table["F_dev"][row];
  s.B = table["B"][row];
  s.A1 = table["A1"][row];
  s.A2 = table["A2"][row];
  s.G = table["G_oct"][row];
  return s;
}

/// Whether strains of the box in every direction cost energy; where the table has no constants, whether
/// compression does.
bool resists(const Record& table, std::size_t row) {
  if (!(table["B"][row] > 0)) return false;
  const auto& names = moduli_columns();
  const auto first = std::find(names.begin(), names.end(), "E_xx_xx");
  Eigen::Matrix<double, 6, 6> stiffness;
  auto name = first;
  for (Eigen::Index a = 0; a < 6; ++a)
    for (Eigen::Index b = a; b < 6; ++b, ++name)
      stiffness(a, b) = stiffness(b, a) = field(table, name->c_str(), row);
  return !stiffness.allFinite() || stiffness.llt().info() == Eigen::Success;
}

void refuse(const Record& table, std::size_t row, ModuliCount& count) {
  ++count.refused;
  const double eps_dev = field(table, "eps_dev", row);
  const std::string where =
      std::isfinite(eps_dev) ? "eps_dev = " + to_text(eps_dev) : "row " + std::to_string(row + 1);
  count.reasons +=
      (count.reasons.empty() ? "" : "; ") + where + ": " +
      why_no_moduli(field(table, "backbone", row), field(table, "contacts", row), table["residual"][row]);
}

}  // namespace

std::string ModuliCount::text() const {
  std::string all;
  const auto add = [&](std::size_t n, const std::string& what) {
    if (n > 0)
      all += (all.empty() ? "" : "; ") + std::to_string(n) + (n == 1 ? " state " : " states ") + what;
  };
  add(unstable, "in no stable balance");
  add(soft, "that would give way to a strain of the box");
  add(changed, "whose contacts changed under the strain");
  if (!reasons.empty()) all += (all.empty() ? "" : "; ") + reasons;
  return all;
}

ModuliSeries moduli_states(const Record& table, const std::string& test, const std::string& group,
                           std::optional<std::size_t> segment, ModuliCount& count) {
  ModuliSeries series{test, group, {}};
  count = {};
  const std::vector<double>& amplitude = table["amplitude"];
  const bool linear = std::count(amplitude.begin(), amplitude.end(), 0.0) > 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool elsewhere = segment && table["segment"][row] != static_cast<double>(*segment);
    if (elsewhere || (linear && amplitude[row] != 0)) continue;
    if (!has_moduli(table, row) || table["residual"][row] > largest_moduli_residual)
      refuse(table, row, count);
    else if (linear && table["unstable"][row] > 0)
      ++count.unstable;
    else if (!resists(table, row))
      ++count.soft;
    else if (table["contacts_changed"][row] > 0)
      ++count.changed;
    else
      series.states.push_back(state_at(table, row));
  }
  count.taken = series.states.size();
  return series;
}

std::string moduli_rule() {
  return "states along the first loading of d2 tests, brought into balance, with moduli by linear response; "
         "left out are states that are unjammed, below isostatic, not in balance (a net force above 1e-5 of "
         "the mean contact force), in no stable balance, or "
         "would give way to a strain of the box (a 6x6 that is not positive definite)";
}

}  // namespace grainlaw::calibrate
