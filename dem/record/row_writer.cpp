#include "grainlaw/dem/record/row_writer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::dem {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr double quasi_static = 1e-3;  // E_k/E_p of the thesis's data stays below (section 2.2.3)
constexpr double bearing_pressure =
    1e-3;  // P* from which the grains bear load, be it at rest or by their motion

constexpr auto not_watched =
    "E_k/E_p was not watched: that needs \"stress\" and \"energy_ratio\" in measure.standard";

/// The standard values of one row, by column name.
class Row {
 public:
  explicit Row(const std::vector<std::string>& columns)
      : columns_(columns), values_(columns.size(), undefined) {}
  void set(const char* column, double value) {
    const auto at = std::find(columns_.begin(), columns_.end(), column);
    if (at == columns_.end()) throw Error(std::string("this record has no column ") + column);
    values_[static_cast<std::size_t>(at - columns_.begin())] = value;
  }
  void set(const ComponentNames& columns, const Sym6& tensor, double factor) {
    for (std::size_t c = 0; c < 6; ++c) set(columns[c], factor * tensor[c]);
  }
  std::vector<double> take() { return std::move(values_); }

 private:
  const std::vector<std::string>& columns_;
  std::vector<double> values_;
};

Wanted wanted_for(const std::vector<std::string>& groups) {
  const auto asked = [&](const char* group) {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
  };
  return {.stress = asked("stress"),
          .fabric = asked("fabric"),
          .coordination = asked("coordination"),
          .energies = asked("energy_ratio")};
}

template <class T>
std::vector<T> with(std::vector<T> list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

}  // namespace

RowWriter::RowWriter(const Material& material, const std::vector<Leg>& legs, double nu_start,
                     const std::vector<std::string>& standard, const std::vector<std::string>& observe)
    : material_(material),
      sign_(legs),
      nu_start_(nu_start),
      observers_(observe),
      columns_(record_columns_with(standard)),
      standard_(wanted_for(standard)),
      wanted_(standard_ | observers_.reads()),
      record_(with(columns_, observers_.columns())) {}

double RowWriter::eps_vol(const Measurement& m) const { return std::log(m.nu / nu_start_); }

double RowWriter::pressure(const Measurement& m) const {
  return trace(m.stress) / 3 * (1 / material_.stress_unit());
}

void RowWriter::append(const Dynamics& dynamics, std::size_t segment, double eps_dev, double time) {
  const Grains& grains = dynamics.grains();
  const Quads velocity =
      wanted_.of_velocity() || observers_.sees_velocity() ? dynamics.velocities() : Quads{};
  const Measurement m =
      measure(dynamics.law(), grains, velocity, dynamics.cell(), dynamics.neighbours().pairs(), wanted_);
  const bool stable = wanted_.energies ? std::isfinite(m.kinetic) && std::isfinite(m.elastic)
                                       : std::isfinite(kinetic_energy(grains, grains.motion));
  if (!stable)
    throw Error("the motion of the grains became unstable at nu = " + to_text(m.nu) +
                ", t = " + to_text(time) + " us; take a smaller measure.time_step or rate");
  record_.append(with(standard_values(m, segment, eps_dev, time),
                      observers_.observe(dynamics, velocity, m, material_, sign_, segment, record_.rows())));
  watch(m);
}

std::vector<double> RowWriter::standard_values(const Measurement& m, std::size_t segment, double eps_dev,
                                               double time) const {
  const double per_unit = 1 / material_.stress_unit();
  Row row(columns_);
  row.set("segment", static_cast<double>(segment));
  row.set("eps_vol", eps_vol(m));
  row.set("eps_dev", eps_dev);
  row.set("nu", m.nu);
  row.set("t", time);
  if (standard_.stress) {
    const double P = pressure(m), shear = sign_.signed_deviator(m.stress, segment) * per_unit;
    row.set("P", P);
    row.set("sigma_dev", shear);
    row.set("s_dev", P > 0 ? shear / P : undefined);
    row.set(stress_columns, m.stress, per_unit);
  }
  if (standard_.fabric) {
    row.set("F_v", trace(m.fabric));
    row.set("F_dev", sign_.signed_deviator(m.fabric, segment));
    row.set(fabric_columns, m.fabric, 1);
  }
  if (standard_.coordination) {
    row.set("C", m.C);
    row.set("C_star", m.C_star);
    row.set("f_NR", m.f_NR);
  }
  if (standard_.energies) row.set("Ek_over_Ep", m.elastic > 0 ? m.kinetic / m.elastic : undefined);
  return row.take();
}

bool RowWriter::watches() const { return wanted_.stress && wanted_.energies; }

void RowWriter::watch(const Measurement& m) {
  if (!watches()) return;
  if (pressure(m) < bearing_pressure || !(m.elastic > 0)) return;
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
  if (!watches()) list.emplace_back(not_watched);
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
