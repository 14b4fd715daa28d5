// The coupled form, Eq. 4.16, with signed deviatoric quantities, q = sgn(d eps_dev) and d ln nu = 3 d eps_v:
//   dP*         = B d ln nu  + A1 S_sigma d eps_dev
//   dsigma*_dev = A2 d ln nu + G  S_sigma d eps_dev
//   dF_dev      = beta_F (q F_max) S_F |d eps_dev|
//   S_sigma = (1 - q s/s_max)/|S_I|,  S_F = (1 - q F_dev/F_max)/|S_F,I|
// The thesis's sign(d eps_dev) F_max S_F d eps_dev would not let F reverse. The magnitude of S_I makes s
// return to s_max from beyond it, where the quotient of the thesis would run away.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// At and below this P* (over k*) the coupled form is unjammed: sigma*_dev/P* has no limit at P* = 0.
inline constexpr double smallest_pressure = 1e-9;

/// P* at which the coupled form jams: small against every pressure of interest, large against
/// smallest_pressure.
inline constexpr double first_pressure = 10 * smallest_pressure;

/// Eq. 4.16; variables P*, sigma*_dev, F_dev. `P` is the scalar of the laws' numbers; states may have
/// another.
template <class P>
struct BasicCoupled {
  static constexpr Form form = Form::coupled;
  static constexpr std::size_t size = 3;
  BasicLaws<P> laws;

  /// Everything in the rates that depends on nu alone.
  template <class T>
  struct Coefficients {
    T B, F_v, ratio_ini, s_max, F_max, beta_F;
  };
  template <class T>
  Coefficients<Meet<P, T>> coefficients(const T& nu) const {
    using std::log;
    const Meet<P, T> e = log(nu / laws.moduli.nu_c);
    const auto fabric = fabric_at(nu, e);
    return {bulk_modulus(laws.moduli, fabric, e),
            fabric.F_v,
            initial_shear_ratio(laws.moduli, fabric.F_v),
            saturation(laws.s_max, nu),
            saturation(laws.F_max, nu),
            saturation(laws.beta_F, nu)};
  }

  /// B at nu (Eq. 4.11).
  template <class T>
  Meet<P, T> bulk_modulus_at(const T& nu) const {
    using std::log;
    const Meet<P, T> e = log(nu / laws.moduli.nu_c);
    return bulk_modulus(laws.moduli, fabric_at(nu, e), e);
  }

  template <class T>
  std::array<T, size> variables(const BasicState<T>& begin) const {
    return {begin.P, begin.sigma_dev, begin.F_dev};
  }

  template <class T, class S>
  auto coefficients(const T& nu, const BasicDirection<S>&) const {
    return coefficients(nu);
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    return {a.B + t * (b.B - a.B),
            a.F_v + t * (b.F_v - a.F_v),
            a.ratio_ini + t * (b.ratio_ini - a.ratio_ini),
            a.s_max + t * (b.s_max - a.s_max),
            a.F_max + t * (b.F_max - a.F_max),
            a.beta_F + t * (b.beta_F - a.beta_F)};
  }

  template <class C, class Y>
  AnisotropyModuli<Meet<C, Y>> anisotropy_moduli(const Coefficients<C>& c, const Y& pressure, const Y& sigma,
                                                 const Y& F) const {
    if (laws.terms.energy) return anisotropy_moduli_of_energy(laws.moduli, c.B, c.F_v, pressure, sigma, F);
    return {anisotropy_modulus_1(laws.moduli, c.B, F), anisotropy_modulus_2(laws.moduli, c.B, F)};
  }
  template <class C, class Y>
  Meet<C, Y> shear_modulus_of(const Coefficients<C>& c, const Y& sigma, const Y& F) const {
    return shear_modulus(laws.moduli, c.B, c.ratio_ini, sigma, F);
  }

  /// dy/dt along a stretch where the coefficients are `c`. False where it is not defined: P* <= 0, or
  /// saturation values that are not > 0.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    return rate_of(*this, c, stretch, direction, y, dydt);
  }
  /// The same with the moduli of a form that derives from this one, and its coefficients.
  template <class Form, class Numbers, class S, class Y>
  static bool rate_of(const Form& form, const Numbers& c, const BasicStretch<S>& stretch,
                      const BasicDirection<S>& direction, const Y* y, Y* dydt) {
    using std::abs;
    const auto& laws = form.laws;
    const Y &pressure = y[0], &sigma = y[1], &F = y[2];
    const S &v = stretch.eps_vol, &e = stretch.eps_dev;
    // s = sigma/P; the event at smallest_pressure comes first
    if (!(pressure > 0) && (!vanishes(e) || laws.terms.energy)) return false;
    const auto [A1, A2] = form.anisotropy_moduli(c, pressure, sigma, F);
    dydt[0] = c.B * v;
    dydt[1] = A2 * v;
    dydt[2] = 0.0;
    if (laws.terms.volumetric) dydt[2] = fabric_by_volume(laws.volumetric, v, F);
    if (vanishes(e)) return true;
    if (!(c.s_max > 0 && c.F_max > 0 && c.beta_F >= 0)) return false;
    const auto q = stretch.q();
    const auto G = form.shear_modulus_of(c, sigma, F);
    const auto S_e = (1 - q * sigma / (pressure * c.s_max)) * (e / direction.S_I);
    dydt[0] = dydt[0] + A1 * S_e;
    dydt[1] = dydt[1] + G * S_e;
    dydt[2] = dydt[2] + approach_rate(q * c.F_max, F, c.beta_F * (abs(e) / direction.S_F_I));
    return true;
  }
  /// The fastest rate at which s_dev or F_dev approach saturation, per unit t.
  template <class C, class S>
  double relaxation(const Coefficients<C>& c, const BasicStretch<S>& stretch,
                    const BasicDirection<S>& direction, const S* y) const {
    const double e = std::abs(value(stretch.eps_dev));
    if (e == 0) return 0;
    const auto G = shear_modulus(laws.moduli, c.B, c.ratio_ini, y[1], y[2]);
    return e * std::max(std::abs(value(G)) / (value(y[0]) * value(c.s_max) * value(direction.S_I)),
                        value(c.beta_F) / value(direction.S_F_I));
  }
  /// What errors of the variables are relative to: P*, and what saturation allows of the others.
  template <class C, class S>
  std::array<double, size> scales(const Coefficients<C>& c, const S* y) const {
    const double pressure = std::abs(value(y[0]));
    return {pressure, std::max(value(c.s_max) * pressure, std::abs(value(y[1]))),
            std::max(value(c.F_max), std::abs(value(y[2])))};
  }

  /// Reaches 0 where the pressure vanishes.
  template <class C, class S, class Y>
  Y distance_to_event(const Coefficients<C>&, const BasicDirection<S>&, const Y* y) const {
    return y[0] - smallest_pressure;
  }

  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                      const T* y) const {
    BasicState<T> state = begin.moved(stretch, t);
    state.P = y[0];
    state.sigma_dev = y[1];
    state.F_dev = y[2];
    return state;
  }

  /// The volume fraction at and below which a jammed point has no contacts whatever it carries. It is kept a
  /// little above the density at which the contacts begin: with the contact law of a row (its nu_c not the
  /// one of the moduli) B is infinite there, though its integral is not.
  P unjamming_density() const { return laws.contacts.nu_c * (1 + 1e-9); }

  /// Takes stress, fabric and direction away; phi_J becomes the current nu, the density at which the pressure
  /// vanished.
  template <class T>
  void unjam(BasicState<T>& state) const {
    state.phi_J = state.nu;
    state.P = state.sigma_dev = state.F_dev = 0.0;
    state.jammed = false;
    state.direction = {};
  }

  /// The volume fraction at which an unjammed point jams when compressed: a little above phi_J, where P* =
  /// first_pressure.
  template <class T>
  Meet<P, T> jamming_density(const BasicState<T>& state) const {
    return jamming_density_of(state, [&](const auto& nu) { return bulk_modulus_at(nu); });
  }
  /// The same where B is that of `bulk(nu)`.
  template <class T, class Bulk>
  Meet<P, T> jamming_density_of(const BasicState<T>& state, Bulk bulk) const {
    using std::exp;
    Meet<P, T> nu = unjamming_density();
    if (nu < state.phi_J) nu = state.phi_J;
    return nu * exp(first_pressure / bulk(nu));
  }

  /// Jams a point that has reached jamming_density() on this stretch, on the solution of Eq. 4.16 for P* ->
  /// 0. There F_dev -> 0, so A1 = A2 = 0, dP* = B d ln nu and d sigma* = G S d eps_dev with G/B = (G/B)_ini
  /// and S_I = 1. For sigma* proportional to P*, s = (G/B)_ini r (1 - q s/s_max), r = d eps_dev/d ln nu;
  /// F_dev is proportional to the volume strain since phi_J.
  template <class T>
  void jam(BasicState<T>& state, const BasicStretch<T>& stretch) const {
    jam_with(coefficients(state.nu), state, stretch);
  }
  template <class C, class T>
  static void jam_with(const Coefficients<C>& c, BasicState<T>& state, const BasicStretch<T>& stretch) {
    const auto q = stretch.q();
    const auto ratio = stretch.eps_dev / stretch.eps_vol, slope = c.ratio_ini * ratio;
    state.jammed = true;
    state.direction = {.q = q, .eps_dev_0 = state.eps_dev};
    state.P = first_pressure;
    state.sigma_dev = first_pressure * slope / (1 + q * slope / c.s_max);
    state.F_dev = c.beta_F * c.F_max * first_pressure / c.B * ratio;
  }

  /// Begins a direction of shear q at a jammed state: S_I, S_F,I, s_0, F_0.
  template <class T>
  void begin_direction(BasicState<T>& state, const Sign<T>& q) const {
    begin_direction_of(laws, state, q);
  }

 private:
  /// F_v and its slope by the contacts; with the term constant_F_v the slope alone, which is that of a probe.
  template <class T>
  FabricWithSlope<Meet<P, T>> fabric_at(const T& nu, const Meet<P, T>& e) const {
    auto fabric = fabric_with_slope(laws.contacts, laws.g3, nu, e);
    if (laws.terms.constant_F_v) fabric.F_v = laws.F_v;
    return fabric;
  }
};
using Coupled = BasicCoupled<double>;

}  // namespace grainlaw::model
