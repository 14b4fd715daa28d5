#include "grainlaw/dem/record/row_writer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::dem {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double quasi_static = 1e-3;  // E_k/E_p of the thesis's data stays below (section 2.2.3)
constexpr double bearing_pressure =
    1e-3;  // P* from which the grains bear load, be it at rest or by their motion

/// One row by column name.
class Row {
 public:
  Row() : values_(record_columns().size(), undefined) {}
  void set(const char* column, double value) {
    const auto& names = record_columns();
    const auto at = std::find(names.begin(), names.end(), column);
    if (at == names.end()) throw Error(std::string("a DEM record has no column ") + column);
    values_[static_cast<std::size_t>(at - names.begin())] = value;
  }
  void set(const ComponentNames& columns, const Sym6& tensor, double factor) {
    for (std::size_t c = 0; c < 6; ++c) set(columns[c], factor * tensor[c]);
  }
  /// The row, with what observers add after it.
  std::vector<double> with(const std::vector<double>& more) const {
    std::vector<double> all = values_;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

 private:
  std::vector<double> values_;
};

std::vector<std::string> with(std::vector<std::string> columns, const std::vector<std::string>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

}  // namespace

RowWriter::RowWriter(const Material& material, const std::vector<Leg>& legs, double nu_start,
                     const std::vector<std::string>& observe)
    : material_(material),
      sign_(legs),
      nu_start_(nu_start),
      observers_(observe),
      record_(with(record_columns(), observers_.columns())) {}

double RowWriter::eps_vol(const Measurement& m) const { return std::log(m.nu / nu_start_); }

void RowWriter::append(const Dynamics& dynamics, std::size_t segment, double eps_dev, double time) {
  const Quads velocity = dynamics.velocities();
  const Measurement m =
      measure(dynamics.law(), dynamics.grains(), velocity, dynamics.cell(), dynamics.neighbours().pairs());
  if (!std::isfinite(m.kinetic) || !std::isfinite(m.elastic))
    throw Error("the motion of the grains became unstable at nu = " + to_text(m.nu) +
                ", t = " + to_text(time) + " us; take a smaller measure.time_step or rate");
  const double per_unit = 1 / material_.stress_unit();
  const double pressure = trace(m.stress) / 3 * per_unit;
  const double shear = sign_.signed_deviator(m.stress, segment) * per_unit;
  Row row;
  row.set("segment", static_cast<double>(segment));
  row.set("eps_vol", eps_vol(m));
  row.set("eps_dev", eps_dev);
  row.set("nu", m.nu);
  row.set("P", pressure);
  row.set("sigma_dev", shear);
  row.set("s_dev", pressure > 0 ? shear / pressure : undefined);
  row.set("F_v", trace(m.fabric));
  row.set("F_dev", sign_.signed_deviator(m.fabric, segment));
  row.set("C", m.C);
  row.set("C_star", m.C_star);
  row.set("f_NR", m.f_NR);
  row.set("t", time);
  row.set("Ek_over_Ep", m.elastic > 0 ? m.kinetic / m.elastic : undefined);
  row.set(stress_columns, m.stress, per_unit);
  row.set(fabric_columns, m.fabric, 1);
  record_.append(
      row.with(observers_.observe(dynamics, velocity, m, material_, sign_, segment, record_.rows())));
  watch(m, pressure);
}

void RowWriter::watch(const Measurement& m, double pressure) {
  if (pressure < bearing_pressure || !(m.elastic > 0)) return;
  const double ratio = m.kinetic / m.elastic;
  ++bearing_;
  if (ratio > quasi_static) ++restless_;
  if (ratio > 1) ++violent_;
  if (ratio > worst_ratio_) {
    worst_ratio_ = ratio;
    worst_nu_ = m.nu;
  }
}

std::vector<std::string> RowWriter::warnings() const {
  std::vector<std::string> list;
  const std::string rows = " of " + std::to_string(bearing_) + " load-bearing rows";
  if (violent_ > 0)
    list.push_back("E_k/E_p is above 1 in " + std::to_string(violent_) + rows +
                   ": the grains fly rather than rest on one another; lower the rate, or relax first");
  else if (restless_ > 0)
    list.push_back("E_k/E_p is above 1e-3 in " + std::to_string(restless_) + rows + " (largest " +
                   short_text(worst_ratio_, 3) + ", at nu = " + short_text(worst_nu_, 3) +
                   "): there the deformation is not quasi-static");
  return list;
}

}  // namespace grainlaw::dem
