#include "grainlaw/model/law.hpp"

#include <algorithm>
#include <limits>

#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// P* at which the coupled form jams: small against every pressure of interest, large against
/// smallest_pressure.
constexpr double first_pressure = 10 * smallest_pressure;

/// The coupled form keeps this much above the density at which its contacts begin: with the contact law of a
/// row (its nu_c not the one of the moduli) B is infinite there, though its integral is not.
constexpr double contact_margin = 1 + 1e-9;

/// |1 - q x/x_sat|, the scale of S and S_F in a direction. At saturation there is no elastic part: plastic
/// from the start. The floor keeps that limit finite; an elastic part this short (in strain, it over beta) is
/// none.
double distance_scale(double q, double x, double x_sat) {
  constexpr double floor = 1e-6;
  return std::max(std::abs(1 - q * x / x_sat), floor);
}

std::optional<std::string> out_of_range(const char* name, const Saturation& law, double nu,
                                        bool zero_allowed) {
  const double value = saturation(law, nu);
  if (value > 0 || (zero_allowed && value == 0)) return std::nullopt;
  return std::string(name) + " is " + shown(value) + " at nu = " + shown(nu) + " and must be " +
         (zero_allowed ? ">= 0" : "> 0");
}

}  // namespace

double State::s_dev() const { return jammed ? sigma_dev / P : undefined; }

Law make_law(const ParameterSet& parameters, Form form) {
  const Laws laws = laws_of(parameters, form);
  switch (form) {
    case Form::reduced_closed:
      return ReducedClosed{laws};
    case Form::reduced:
      return Reduced{laws};
    default:
      return Coupled{laws};
  }
}

Form form_of(const Law& law) {
  if (std::holds_alternative<ReducedClosed>(law)) return Form::reduced_closed;
  return std::holds_alternative<Reduced>(law) ? Form::reduced : Form::coupled;
}

const Laws& laws_of(const Law& law) {
  return std::visit([](const auto& form) -> const Laws& { return form.laws; }, law);
}

double unjamming_density(const Law& law) {
  const Laws& laws = laws_of(law);
  return form_of(law) == Form::coupled ? laws.contacts.nu_c * contact_margin : jamming_density(laws.pressure);
}

void unjam(const Law& law, State& state) {
  if (form_of(law) == Form::coupled) state.phi_J = state.nu;
  state.P = state.sigma_dev = state.F_dev = 0;
  state.jammed = false;
  state.direction = {};
}

double jamming_density(const Law& law, const State& state) {
  const Laws& laws = laws_of(law);
  // At the density itself P* is 0 and s_dev has no value; the next number above it will do.
  if (form_of(law) != Form::coupled) return jamming_density(laws.pressure) * (1 + 1e-12);
  const double nu = std::max(state.phi_J, unjamming_density(law));
  return nu * std::exp(first_pressure / bulk_modulus(laws.moduli, laws.contacts, nu));
}

void jam(const Law& law, State& state, const Stretch& stretch) {
  const Laws& laws = laws_of(law);
  const double q = stretch.q();
  state.jammed = true;
  state.P = pressure(laws.pressure, state.nu);
  state.sigma_dev = state.F_dev = 0;
  state.direction = {.q = q, .eps_dev_0 = state.eps_dev};
  if (form_of(law) != Form::coupled) return;
  // F_dev -> 0, so A1 = A2 = 0, dP* = B d ln nu and d sigma* = G S d eps_dev with G/B = (G/B)_ini and S_I
  // = 1. For sigma* proportional to P*, s = (G/B)_ini r (1 - q s/s_max), r = d eps_dev/d ln nu.
  const double F_v = isotropic_fabric(laws.contacts, laws.g3, state.nu);
  const double B = bulk_modulus(laws.moduli, laws.contacts, state.nu);
  const double slope = initial_shear_ratio(laws.moduli, F_v) * stretch.eps_dev / stretch.eps_vol;
  state.P = first_pressure;
  state.sigma_dev = state.P * slope / (1 + q * slope / saturation(laws.s_max, state.nu));
  state.F_dev = saturation(laws.beta_F, state.nu) * saturation(laws.F_max, state.nu) * first_pressure / B *
                stretch.eps_dev / stretch.eps_vol;
}

void begin_direction(const Law& law, State& state, double q) {
  const Laws& laws = laws_of(law);
  state.direction = {.q = q,
                     .S_I = distance_scale(q, state.s_dev(), saturation(laws.s_max, state.nu)),
                     .S_F_I = distance_scale(q, state.F_dev, saturation(laws.F_max, state.nu)),
                     .s_0 = state.s_dev(),
                     .F_0 = state.F_dev,
                     .eps_dev_0 = state.eps_dev};
}

std::optional<std::string> objection(const Law& law, const Stretch& stretch) {
  const Laws& laws = laws_of(law);
  if (stretch.eps_dev == 0) return std::nullopt;
  for (const double nu : {stretch.nu(0), stretch.nu(1)}) {  // Eq. 2.20 is monotonic between
    if (auto reason = out_of_range("s_max", laws.s_max, nu, false)) return reason;
    if (auto reason = out_of_range("F_max", laws.F_max, nu, false)) return reason;
    if (auto reason = out_of_range("beta_F", laws.beta_F, nu, true)) return reason;
    if (form_of(law) == Form::coupled) continue;
    if (auto reason = out_of_range("beta_s", laws.beta_s, nu, true)) return reason;
  }
  return std::nullopt;
}

Contacts contacts_of(const Law& law, const State& state) {
  const Laws& laws = laws_of(law);
  if (!state.jammed) return {0, 0, undefined, 0};
  const double nu = at_least_isostatic(laws.contacts, state.nu), C = coordination(laws.contacts, nu);
  return {laws.g3 * state.nu * C, C, corrected_coordination(laws.contacts, nu),
          1 - rattlers(laws.contacts, nu)};
}

}  // namespace grainlaw::model
