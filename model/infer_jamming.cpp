#include "grainlaw/model/infer_jamming.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::model {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Over k*. A packing in balance has it 4e-5 above phi_J: what is below could not be told from phi_J = nu.
constexpr double least_pressure = 1e-5;

/// What a row has measured; NaN where it has not.
struct Measured {
  double nu, P, C, C_star, f_NR;
};

using Estimates = std::array<double, 4>;
constexpr const char* names[] = {"phi_J", "phi_J_pressure_alone", "phi_J_contacts", "phi_J_nonrattlers"};

Estimates estimates_of(const PackingLaw& law, const Measured& s) {
  const PressureCurve pressure = law.pressure();
  const ContactCurve contacts = law.contacts();
  // Grains that touch in passing press a little, too: with fewer contacts than balance needs nothing is
  // jammed; where contacts are not measured, nothing that presses so little.
  const bool presses = std::isnan(s.C_star) ? s.P >= least_pressure : s.P > 0 && !(s.C_star < contacts.C0);
  return {presses ? jamming_density_from_pressure_and_contacts(pressure, s.nu, s.P, s.C).value_or(nan) : nan,
          presses ? jamming_density_from_pressure(pressure, s.nu, s.P).value_or(nan) : nan,
          jamming_density_from_contacts(contacts, s.nu, s.C_star).value_or(nan),
          jamming_density_from_nonrattlers(contacts, s.nu, s.f_NR).value_or(nan)};
}

constexpr Parameter PackingLaw::*numbers[] = {&PackingLaw::C0,     &PackingLaw::C1,    &PackingLaw::alpha,
                                              &PackingLaw::phi_c,  &PackingLaw::phi_v, &PackingLaw::p0,
                                              &PackingLaw::gamma_p};

/// Root of the sum of squares of the scatter and of what each stated error moves; NaN where that is nothing.
Estimates errors_of(const PackingLaw& law, const Measured& s, const Estimates& at, double scatter) {
  Estimates squares;
  for (std::size_t i = 0; i < at.size(); ++i) squares[i] = std::isfinite(at[i]) ? scatter * scatter : nan;
  for (const auto number : numbers) {
    PackingLaw moved = law;
    Parameter& p = moved.*number;
    if (!p.stderr_) continue;
    p.value += *p.stderr_;
    const Estimates there = estimates_of(moved, s);
    for (std::size_t i = 0; i < at.size(); ++i) squares[i] += std::pow(there[i] - at[i], 2);
  }
  for (double& square : squares) square = square > 0 ? std::sqrt(square) : nan;
  return squares;
}

}  // namespace

std::optional<double> jamming_density_from_contacts(const ContactCurve& c, double nu, double C_star) {
  if (!(C_star >= c.C0)) return std::nullopt;
  return nu / (1 + std::pow((C_star - c.C0) / c.C1, 1 / c.alpha));
}

std::optional<double> jamming_density_from_nonrattlers(const ContactCurve& c, double nu, double f_NR) {
  const double phi_r = 1 - f_NR;
  if (!(phi_r > 0 && phi_r <= c.phi_c)) return std::nullopt;
  return nu / (1 + std::log(c.phi_c / phi_r) / c.phi_v);
}

std::optional<double> jamming_density_from_pressure_and_contacts(const PressureCurve& law, double nu,
                                                                 double P, double C) {
  if (!(P > 0 && C > 0)) return std::nullopt;
  // With phi_J = nu exp(-e), Eq. 5.9 reads P = p0 C exp(e) e (1 - gamma_p e).
  const auto too_little = [&](double e) { return law.p0 * C * std::exp(e) * e * (1 - law.gamma_p * e) < P; };
  const double range = range_of_inversion(law);
  if (too_little(range)) return std::nullopt;
  return nu * std::exp(-turning_point(0, range, too_little));
}

Record infer_jamming_density(const Record& record, const PackingLaw& law, double scatter) {
  std::vector<std::string> columns;
  for (const char* name : {"segment", "eps_vol", "eps_dev"})
    if (record.has(name)) columns.emplace_back(name);
  columns.emplace_back("nu");
  const std::size_t kept = columns.size();
  for (const char* name : names) {
    columns.emplace_back(name);
    columns.push_back(std::string(name) + "_error");
  }
  const auto field = [&](const char* name, std::size_t row) {
    return record.has(name) ? record[name][row] : nan;
  };
  Record out(columns);
  for (std::size_t i = 0; i < record.rows(); ++i) {
    const Measured s{record["nu"][i], record["P"][i], field("C", i), field("C_star", i), field("f_NR", i)};
    const Estimates phi_J = estimates_of(law, s), errors = errors_of(law, s, phi_J, scatter);
    std::vector<double> row;
    for (std::size_t k = 0; k < kept; ++k) row.push_back(record[columns[k]][i]);
    for (std::size_t k = 0; k < phi_J.size(); ++k) {
      row.push_back(phi_J[k]);
      row.push_back(errors[k]);
    }
    out.append(row);
  }
  return out;
}

}  // namespace grainlaw::model
