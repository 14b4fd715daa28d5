#include "grainlaw/calibrate/memory_shear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Majority of each row and its neighbours.
std::vector<bool> smoothed(const std::vector<bool>& jammed) {
  std::vector<bool> out(jammed.size());
  for (std::size_t i = 0; i < jammed.size(); ++i) {
    const std::size_t begin = i < smoothing ? 0 : i - smoothing;
    const std::size_t end = std::min(jammed.size(), i + smoothing + 1);
    std::size_t yes = 0;
    for (std::size_t j = begin; j < end; ++j) yes += jammed[j] ? 1 : 0;
    out[i] = 2 * yes > end - begin;
  }
  return out;
}

bool mostly(const std::vector<double>& strain, const std::vector<bool>& jammed, std::size_t from,
            double up_to) {
  std::size_t yes = 0, all = 0;
  for (std::size_t j = from; j < strain.size() && strain[j] <= up_to; ++j) {
    ++all;
    yes += jammed[j] ? 1 : 0;
  }
  return static_cast<double>(yes) >= sustained_share * static_cast<double>(all);
}

/// Whether it stays jammed from row i on.
bool sustained(const std::vector<double>& strain, const std::vector<bool>& jammed, std::size_t i) {
  return jammed[i] && strain.back() - strain[i] >= 0.5 * sustained_strain &&
         mostly(strain, jammed, i, strain[i] + sustained_strain) && mostly(strain, jammed, i, strain.back());
}

bool shows(const TestRecord& test, std::size_t row, JamSign sign, const Selection& selection) {
  switch (sign) {
    case JamSign::contacts:
      return test.rows["C_star"][row] >= isostatic_C_star;
    case JamSign::percolation:
      return test.rows["percolating"][row] >= 3;
    case JamSign::pressure:
      return test.rows["P"][row] >= selection.P_min;
  }
  return false;
}

struct LegRows {
  std::vector<std::size_t> rows;
  std::vector<double> strain;
};

LegRows rows_of(const TestRecord& test, std::size_t leg) {
  LegRows out;
  const std::vector<double>& segment = test.rows["segment"];
  for (std::size_t i = 0; i < segment.size(); ++i) {
    if (static_cast<std::size_t>(segment[i]) != leg) continue;
    out.rows.push_back(i);
    out.strain.push_back(std::abs(test.rows["eps_dev"][i] - test.legs[leg].eps_dev[0]));
  }
  return out;
}

std::vector<bool> rows_that_show(const TestRecord& test, const LegRows& at, JamSign sign,
                                 const Selection& selection) {
  std::vector<bool> jammed;
  for (const std::size_t row : at.rows) jammed.push_back(shows(test, row, sign, selection));
  return jammed;
}

/// The first row that percolates along all axes, from the first that is loose by contacts; 0 where none is.
double percolation_strain(const std::vector<double>& strain, const std::vector<bool>& percolating,
                          const std::vector<bool>& contacts) {
  const std::vector<bool> state = smoothed(contacts);
  const auto loose = std::find(state.begin(), state.end(), false);
  if (loose == state.end()) return 0;
  for (auto i = static_cast<std::size_t>(loose - state.begin()); i < strain.size(); ++i)
    if (percolating[i]) return strain[i];
  return nan;
}

double share_from(const std::vector<double>& strain, const std::vector<bool>& rows, double from) {
  double yes = 0, all = 0;
  for (std::size_t i = 0; i < strain.size(); ++i) {
    if (!(strain[i] >= from)) continue;
    all += 1;
    yes += rows[i] ? 1 : 0;
  }
  return all > 0 ? yes / all : nan;
}

ShearJamming measure(const TestRecord& test, const LegRows& at, const Selection& selection) {
  ShearJamming out;
  out.test = test.name;
  out.group = test.seed;
  out.nu = test.rows["nu"][at.rows.front()];
  out.longest = at.strain.back();
  const auto contacts = rows_that_show(test, at, JamSign::contacts, selection);
  const double by_contacts = jamming_strain(at.strain, contacts);
  out.strain = {by_contacts, nan,
                jamming_strain(at.strain, rows_that_show(test, at, JamSign::pressure, selection))};
  out.percolating = nan;
  if (!test.rows.has("percolating")) return out;
  const auto percolating = rows_that_show(test, at, JamSign::percolation, selection);
  out.strain[static_cast<std::size_t>(JamSign::percolation)] =
      percolation_strain(at.strain, percolating, contacts);
  out.percolating = share_from(at.strain, percolating, by_contacts);
  return out;
}

/// Whether the leg ended jammed by contacts.
bool ends_jammed(const TestRecord& test, const LegRows& at, const Selection& selection) {
  std::size_t yes = 0, all = 0;
  for (std::size_t i = 0; i < at.rows.size(); ++i) {
    if (at.strain[i] < at.strain.back() - 0.5 * sustained_strain) continue;
    ++all;
    yes += shows(test, at.rows[i], JamSign::contacts, selection) ? 1 : 0;
  }
  return 2 * yes > all;
}

}  // namespace

std::string name_of(JamSign sign) {
  if (sign == JamSign::contacts) return "contacts";
  return sign == JamSign::percolation ? "percolation" : "pressure";
}

double jamming_strain(const std::vector<double>& strain, const std::vector<bool>& jammed) {
  const std::vector<bool> state = smoothed(jammed);
  const auto loose = std::find(state.begin(), state.end(), false);
  if (loose == state.end()) return 0;
  for (auto i = static_cast<std::size_t>(loose - state.begin()); i < state.size(); ++i)
    if (sustained(strain, state, i)) return strain[i];
  return nan;
}

std::vector<ShearJamming> shear_jammings(const TestRecord& test, const CycleDensity& from,
                                         const Selection& selection) {
  std::vector<ShearJamming> out;
  bool jammed_before = false;
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg) {
    if (test.legs[leg].mode != Mode::d2) continue;
    const LegRows at = rows_of(test, leg);
    if (at.rows.empty()) continue;
    ShearJamming one = measure(test, at, selection);
    one.phi_max = from.phi_max;
    one.M = from.M;
    one.phi_J0 = from.from_P;
    one.reversals = out.size();
    one.jammed_before = jammed_before;
    jammed_before = ends_jammed(test, at, selection);
    out.push_back(one);
  }
  return out;
}

std::string shear_jamming_rule(const Selection& selection) {
  return "first strain from which three quarters of the rows over " + to_text(sustained_strain) +
         ", and of those to the leg's end, have C* >= 6 (by pressure: P >= " + to_text(selection.P_min) +
         "), each row by the majority of the five about it; by percolation: the first row whose strong "
         "forces "
         "percolate along three axes";
}

}  // namespace grainlaw::calibrate
