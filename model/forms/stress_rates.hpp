// How stress and the variables of each form change with d ln nu and with d eps_dev in a given direction of
// shear: every form's rates are linear in the two.
#pragma once

#include <array>
#include <type_traits>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/walk/prescribed.hpp"

namespace grainlaw::model {

/// StressRates, and the same of the form's N variables.
template <class T, std::size_t N>
struct FormRates {
  StressRates<T> stress;
  std::array<T, N> v, e;       ///< of the variables; v where nu rises
  std::array<T, N> back;       ///< per d ln nu where nu falls: only fabric and memory tell them apart
  StressRates<T> stress_back;  ///< only in the form with memory
};

template <class T>
BasicDirection<T> with_scalar(const Direction& d) {
  return {
      d.q,     d.S_I, d.S_F_I, d.s_0, d.F_0, d.eps_dev_0, {d.history.phi_H, d.history.phi_max, d.history.nu},
      d.jammed};
}

/// Of a coupled form: its variables are P* and sigma*_dev themselves.
template <class T, std::size_t N>
StressRates<T> stress_of_variables(const T* y, const FormRates<T, N>& rates) {
  const T s = y[0] > 0 ? y[1] / y[0] : T(0.0);
  return {y[0],
          y[1],
          rates.v[0],
          rates.e[0],
          rates.v[1],
          rates.e[1],
          s,
          (rates.v[1] - s * rates.v[0]) / y[0],
          (rates.e[1] - s * rates.e[0]) / y[0]};
}

/// Eq. 2.14. Below its nu_c, where the law has no pressure, the formula goes on, so that an integration may
/// look a little beyond.
template <class P, class T>
T pressure_beyond(const BasicPressureCurve<P>& p, const T& nu) {
  using std::log;
  const T e = log(nu / p.nu_c);
  return p.p0 * nu * coordination(p.contacts, at_least_isostatic(p.contacts, nu)) / p.nu_c * e *
         (1 - p.gamma_p * e);
}

/// Where P* is that and s_dev changes by s_v, s_e.
template <class T>
StressRates<T> stress_of_ratio(const Laws& laws, const T& nu, const T& s, const T& s_v, const T& s_e) {
  using std::log;
  const PressureCurve& p = laws.pressure;
  const T e = log(nu / p.nu_c), C = coordination(p.contacts, at_least_isostatic(p.contacts, nu));
  const T dC = nu * coordination_slope(p.contacts, nu);
  const T P = p.p0 * nu * C / p.nu_c * e * (1 - p.gamma_p * e);
  const T P_v = p.p0 * nu / p.nu_c * ((C + dC) * e * (1 - p.gamma_p * e) + C * (1 - 2 * p.gamma_p * e));
  return {P, s * P, P_v, T(0.0), s * P_v + P * s_v, P * s_e, s, s_v, s_e};
}

/// Of the form with memory: P* follows from nu, the history and the variables, of which `by_volume` are the
/// rates per d ln nu.
template <class T>
StressRates<T> stress_of_memory(const Memory& form, const BasicDirection<T>& direction, const T& nu,
                                const T* y, const std::array<T, Memory::size>& by_volume,
                                const std::array<T, Memory::size>& by_shear) {
  using D = Dual<1, T>;
  if (!direction.jammed) return {};
  const auto pressure_along = [&](const T& nu_slope, const std::array<T, Memory::size>& slopes) {
    D at(nu);
    at.slope[0] = nu_slope;
    std::array<D, Memory::size> z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      z[i] = D(y[i]);
      z[i].slope[0] = slopes[i];
    }
    const D ratio = at / form.jamming_density_at(form.coefficients(at, direction), z.data());
    return pressure_beyond(form.laws.pressure, D(form.laws.pressure.nu_c * ratio));
  };
  const D v = pressure_along(nu, by_volume), e = pressure_along(T(0.0), by_shear);
  const T P = v.value, P_v = v.slope[0], P_e = e.slope[0], s = y[0] / P;
  return {P,
          y[0],
          P_v,
          P_e,
          by_volume[0],
          by_shear[0],
          s,
          (by_volume[0] - s * P_v) / P,
          (by_shear[0] - s * P_e) / P};
}

/// Eq. 2.17 at the current nu: s = q s_max - (q s_max - s_0) exp(-beta_s E), E = q (eps_dev - eps_dev_0).
template <class T>
StressRates<T> stress_of_closed(const Laws& laws, const State& begin, const Direction& d, const T& nu,
                                const T& eps_dev) {
  using std::exp, std::expm1;
  if (d.q == 0) return stress_of_ratio(laws, nu, T(begin.s_dev()), T(0.0), T(0.0));
  const T E = d.q * (eps_dev - d.eps_dev_0);
  const T limit = d.q * saturation(laws.s_max, nu), beta = saturation(laws.beta_s, nu);
  const T s = approach(limit, d.s_0, beta, E);
  const T s_v = nu * (-(d.q * saturation_slope(laws.s_max, nu)) * expm1(-beta * E) +
                      (limit - d.s_0) * E * saturation_slope(laws.beta_s, nu) * exp(-beta * E));
  return stress_of_ratio(laws, nu, s, s_v, T(d.q * approach_rate(limit, s, beta)));
}

/// At volume fraction nu, eps_dev from the path's start and variables y of the form; `d` is the direction of
/// shear, with q = 0 for none (then nothing changes by eps_dev). `begin` is where the direction is followed
/// from. False where the rates are not defined.
template <class Form, class T>
bool form_rates(const Form& form, const State& begin, const Direction& d, const T& nu, const T& eps_dev,
                const T* y, FormRates<T, Form::size>& rates) {
  constexpr std::size_t n = Form::size;
  if constexpr (n == 0) {
    rates.stress = stress_of_closed(form.laws, begin, d, nu, eps_dev);
  } else {
    const auto direction = with_scalar<T>(d);
    auto coefficients = form.coefficients(nu, direction);
    if (!form.rate(coefficients, BasicStretch<T>{nu, 1.0, 0.0}, direction, y, rates.v.data())) return false;
    rates.back = rates.v;
    if (form.laws.terms.volumetric || std::is_same_v<Form, Memory>) {
      if (!form.rate(coefficients, BasicStretch<T>{nu, -1.0, 0.0}, direction, y, rates.back.data()))
        return false;
      for (T& rate : rates.back) rate = -rate;
    }
    rates.e.fill(T(0.0));
    if (d.q != 0) {
      if (!form.rate(coefficients, BasicStretch<T>{nu, 0.0, d.q}, direction, y, rates.e.data())) return false;
      for (T& rate : rates.e) rate = d.q * rate;
    }
    if constexpr (std::is_base_of_v<Coupled, Form>)
      rates.stress = stress_of_variables(y, rates);
    else if constexpr (std::is_same_v<Form, Memory>) {
      rates.stress = stress_of_memory(form, direction, nu, y, rates.v, rates.e);
      rates.stress_back = stress_of_memory(form, direction, nu, y, rates.back, rates.e);
    } else
      rates.stress = stress_of_ratio(form.laws, nu, y[0], rates.v[0], rates.e[0]);
  }
  return true;
}

}  // namespace grainlaw::model
