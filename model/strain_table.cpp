#include "grainlaw/model/strain_table.hpp"

#include <cmath>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/path_limits.hpp"

namespace grainlaw::model {

namespace {

/// A step in strain below this is rounding.
constexpr double no_step = 1e-14;

class StrainTable {
 public:
  StrainTable(const Record& table, std::string file) : table_(table), file_(std::move(file)) {
    if (table.rows() < 2)
      throw Error(file_, "", "must have two rows at least, got " + std::to_string(table.rows()));
  }

  double at(const std::string& column, std::size_t row, const Range& range) const {
    const double x = table_[column][row];
    if (std::isnan(x)) fail(column, row, "is empty");
    if (!range.contains(x)) fail(column, row, "must be " + range.text() + ", got " + to_text(x));
    return x;
  }
  [[noreturn]] void fail(const std::string& column, std::size_t row, const std::string& what) const {
    throw Error(file_, column, "line " + std::to_string(row + 2) + ": " + what);
  }

  /// What the first row or an option says.
  std::optional<double> start(const std::string& column, const std::optional<double>& option,
                              const Range& range) const {
    if (!table_.has(column) || std::isnan(table_[column].front())) return option;
    if (option) fail(column, 0, "says the start already; leave out --" + column);
    return at(column, 0, range);
  }

 private:
  const Record& table_;
  std::string file_;
};

}  // namespace

MeasuredPath strain_path(const Record& table, const std::string& file, std::optional<double> nu,
                         std::optional<double> P) {
  const StrainTable strains(table, file);
  Path asked;
  asked.file = file;
  asked.start.nu = strains.start("nu", nu, inside(0, 1));
  asked.start.P = strains.start("P", P, of_k_star(between(0, largest_stress)));
  if (!asked.start.nu)
    throw Error(file, "nu", "is missing: the volume fraction of the first row, as a column or by --nu");
  asked.segments.resize(1);
  asked.segments.front().mode = Mode::relax;
  asked.segments.front().duration = 0;

  const Range any = between(-largest_strain, largest_strain);
  const double vol_0 = strains.at("eps_vol", 0, any), dev_0 = strains.at("eps_dev", 0, any);
  Record moved({"segment", "eps_vol", "eps_dev", "nu"});
  std::vector<Sample> samples;
  double last_vol = 0, last_dev = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double vol = strains.at("eps_vol", row, any) - vol_0, dev = strains.at("eps_dev", row, any) - dev_0;
    const double nu_here = *asked.start.nu * std::exp(vol);
    if (!(nu_here < 1))
      strains.fail("eps_vol", row, "takes nu to " + to_text(nu_here) + "; must stay below 1");
    if (row == 0 || std::abs(vol - last_vol) > no_step || std::abs(dev - last_dev) > no_step) {
      moved.append({0, vol, dev, nu_here});
      last_vol = vol;
      last_dev = dev;
    }
    const std::size_t steps = moved.rows() - 1;
    samples.push_back(steps == 0 ? Sample{0, 0} : Sample{steps - 1, 1});
  }
  if (moved.rows() < 2) throw Error(file, "", "must strain somewhere: all rows are the same");
  MeasuredPath path = measured_path(moved, asked);
  path.samples = std::move(samples);
  path.segments.assign(table.rows(), 0);
  return path;
}

}  // namespace grainlaw::model
