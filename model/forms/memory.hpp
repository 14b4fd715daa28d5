// The coupled form with memory: pressure is bounded by the volume fraction and a jamming density phi_J(H)
// that over-compression raises (Eqs. 5.1, 5.5), and that shear takes away and gives back at a reversal (the
// thesis has Eqs. 5.3 and 5.13 for that; here it is one rate).
//
// Shear is remembered as m in [0, 1], 0 where it is forgotten and 1 in steady shear. It follows the square of
// the fabric, late by the strain eps_c:
//   dm    = [min(1, (F_dev/F_max)^2) - m] |d eps_dev|/eps_c
// and what is remembered holds the fabric: dF_dev is that of Eq. 4.16 times 1 - hold m.
//   phi_J = phi_H + (phi_s - phi_H) m, or phi_H where that is below phi_s
//   P*    = Eq. 2.14 at phi_J; its numbers go from the isotropic row to that of steady shear as m goes from 0
//           to 1
// dsigma*_dev is that of Eq. 4.16. phi_H is what over-compression has left, phi_s where pressure
// begins in steady shear.
//
// From isotropy F_dev/F_max = 1 - exp(-beta_F eps_dev), so m begins as eps_dev^3, without the singular strain
// of exp[-(eps/eps0)^alpha]. After a reversal the fabric has to turn, through isotropy, and phi_J comes back
// meanwhile: nothing jumps, and dm/d eps_dev = 0 on both sides of a reversal of steady shear, so that cycles
// much smaller than 1/beta_F leave m alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// History after an isotropic or other change of volume from h.nu to nu: compression beyond phi_max is a
/// first one (M = 1 in Eq. 5.1); below it, from phi_H on, it is part of one more cycle, M growing with ln nu.
/// A packing that jams later than M = 1 has it, as one that starts from a measured pressure may, stays as far
/// below.
template <class P, class T>
BasicHistory<T> compressed(const BasicOverCompression<P>& o, BasicHistory<T> h, const T& nu) {
  using std::exp, std::log, std::pow;
  T from = h.nu;
  h.nu = nu;
  if (from < h.phi_H) from = h.phi_H;
  if (!(nu > from)) return h;
  if (from < h.phi_max) {
    const T limit = jamming_density_limit(o, h.phi_max);
    T to = nu;
    if (h.phi_max < to) to = h.phi_max;
    if (h.phi_H >= o.phi_SJ && h.phi_H < limit) {
      const T cycles = o.mu * pow(-log((limit - h.phi_H) / (limit - o.phi_SJ)), 1 / o.beta);
      h.phi_H = jamming_density_after(o, h.phi_max, T(cycles + log(to / from) / log(h.phi_max / h.phi_H)));
    }
  }
  if (h.phi_max < nu) {
    const T before = jamming_density_after(o, h.phi_max, 1.0), first = jamming_density_after(o, nu, 1.0);
    h.phi_max = nu;
    if (h.phi_H < before)
      h.phi_H = h.phi_H + (first - before);
    else if (h.phi_H < first)
      h.phi_H = first;
  }
  return h;
}

/// Variables sigma*_dev, F_dev, m. Fabric and memory go on without contacts: shear can jam the point, and
/// F_dev is then the anisotropy that it will have.
template <class P>
struct BasicMemory {
  static constexpr Form form = Form::memory;
  static constexpr std::size_t size = 3;
  static constexpr bool goes_on_unjammed = true;
  BasicLaws<P> laws;

  /// Everything in the rates that depends on nu and the history alone.
  template <class T>
  struct Coefficients {
    T nu, phi_H, s_max, F_max, beta_F;
  };
  template <class T, class S>
  Coefficients<Meet<P, T>> coefficients(const T& nu, const BasicDirection<S>& direction) const {
    using C = Meet<P, T>;
    const BasicHistory<C> before{direction.history.phi_H, direction.history.phi_max, direction.history.nu};
    return {nu, compressed<P, C>(laws.memory.over, before, nu).phi_H, saturation(laws.s_max, nu),
            saturation(laws.F_max, nu), saturation(laws.beta_F, nu)};
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    return {a.nu + t * (b.nu - a.nu), a.phi_H + t * (b.phi_H - a.phi_H), a.s_max + t * (b.s_max - a.s_max),
            a.F_max + t * (b.F_max - a.F_max), a.beta_F + t * (b.beta_F - a.beta_F)};
  }

  /// phi_J of a memory m and history phi_H.
  template <class C, class Y>
  auto jamming_density_of(const C& phi_H, const Y& m) const {
    return phi_H + m * (steady_density(phi_H) - phi_H);
  }
  /// phi_s, but not above phi_H: shear takes and never gives.
  template <class C>
  Meet<P, C> steady_density(const C& phi_H) const {
    if (phi_H < laws.shear_pressure.nu_c) return phi_H;
    return laws.shear_pressure.nu_c;
  }
  /// Eq. 2.14 of a memory m and history phi_H: its numbers lie between those of both rows.
  template <class C, class Y>
  BasicPressureCurve<Meet<Meet<P, C>, Y>> curve_of(const C& phi_H, const Y& m) const {
    using R = Meet<Meet<P, C>, Y>;
    const auto& iso = laws.pressure;
    const auto& shear = laws.shear_pressure;
    const auto mix = [&](const auto& a, const auto& b) -> R { return a + m * (b - a); };
    const auto scale = phi_H / iso.nu_c;
    return {
        {mix(iso.contacts.C0, shear.contacts.C0), mix(iso.contacts.C1, shear.contacts.C1),
         mix(iso.contacts.alpha, shear.contacts.alpha), mix(iso.contacts.nu_c * scale, shear.contacts.nu_c),
         mix(iso.contacts.phi_c, shear.contacts.phi_c), mix(iso.contacts.phi_v, shear.contacts.phi_v)},
        mix(iso.p0, shear.p0),
        mix(iso.gamma_p, shear.gamma_p),
        R(jamming_density_of(phi_H, m))};
  }
  /// P* at nu of a memory m and history phi_H; 0 at and below phi_J.
  template <class C, class Y>
  Meet<Meet<P, C>, Y> pressure_of(const C& nu, const C& phi_H, const Y& m) const {
    return pressure(curve_of(phi_H, m), Meet<Meet<P, C>, Y>(nu));
  }

  /// B and (G/B)_ini (Eqs. 4.11, 4.14) with contacts and strain counted from phi_J (section 5.H); below
  /// F_v,min the latter is 0, where 4.14 is negative.
  template <class R>
  struct Stiffness {
    R B, ratio_ini;
  };
  template <class R>
  Stiffness<R> stiffness(const BasicPressureCurve<R>& curve, R nu) const {
    using std::log;
    BasicContactCurve<R> contacts = curve.contacts;
    contacts.nu_c = curve.nu_c;
    const R begin = contacts.nu_c * (1 + 1e-9);
    if (nu < begin) nu = begin;
    BasicModuli<R> m{laws.moduli.p0,     laws.moduli.gamma_p, contacts.nu_c,       laws.moduli.g3, {}, {}, {},
                     laws.moduli.GB_max, laws.moduli.Fv_min,  laws.moduli.Fv_alpha};
    const R e = log(nu / contacts.nu_c);
    const auto fabric = fabric_with_slope(contacts, R(laws.g3), nu, e);
    R ratio = 0.0;
    if (fabric.F_v > m.Fv_min) ratio = initial_shear_ratio(m, fabric.F_v);
    return {bulk_modulus(m, fabric, e), ratio};
  }

  template <class T>
  std::array<T, size> variables(const BasicState<T>& begin) const {
    return {begin.sigma_dev, begin.F_dev, begin.memory};
  }

  /// dy/dt along a stretch where the coefficients are `c`. False where it is not defined: jammed with P* <=
  /// 0, or saturation values that are not > 0.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    using std::abs;
    const Y &sigma = y[0], &F = y[1], &m = y[2];
    const S &v = stretch.eps_vol, &e = stretch.eps_dev;
    using R = Meet<C, Y>;
    dydt[0] = dydt[1] = dydt[2] = 0.0;
    const bool shears = !vanishes(e);
    if (shears && !(c.s_max > 0 && c.F_max > 0 && c.beta_F >= 0)) return false;
    const auto q = stretch.q();
    const S size_e = abs(e);
    if (direction.jammed) {
      const BasicPressureCurve<R> curve = curve_of(c.phi_H, m);
      const auto [B, ratio_ini] = stiffness(curve, R(c.nu));
      dydt[0] = anisotropy_modulus_2(laws.moduli, B, F) * v;
      if (shears) {
        // Half of the pressure at which the event comes holds beyond it: P* is not a variable that a step
        // could keep above 0, and a step has to look past the event to find it.
        R P_star = pressure(curve, R(c.nu));
        if (P_star < smallest_pressure / 2) P_star = smallest_pressure / 2;
        const auto G = shear_modulus(laws.moduli, B, ratio_ini, sigma, F);
        dydt[0] = dydt[0] + G * (1 - q * sigma / (P_star * c.s_max)) * (e / direction.S_I);
      }
    }
    if (laws.terms.volumetric) dydt[1] = fabric_by_volume(laws.volumetric, v, F);
    if (!shears) return true;
    const auto free = 1 - laws.memory.hold * m;
    dydt[1] = dydt[1] + approach_rate(q * c.F_max, F, c.beta_F * free * (size_e / direction.S_F_I));
    const auto f = F / c.F_max;
    R aligned = f * f;
    if (aligned > 1) aligned = 1.0;
    dydt[2] = approach_rate(aligned, m, size_e / laws.memory.eps_c);
    return true;
  }
  /// The fastest rate of approach, per unit t.
  template <class C, class S>
  double relaxation(const Coefficients<C>& c, const BasicStretch<S>& stretch,
                    const BasicDirection<S>& direction, const S* y) const {
    const double e = std::abs(value(stretch.eps_dev));
    if (e == 0) return 0;
    double rate = std::max(value(c.beta_F) / value(direction.S_F_I), 1 / value(laws.memory.eps_c));
    if (direction.jammed) {
      const auto curve = curve_of(c.phi_H, y[2]);
      const auto [B, ratio_ini] = stiffness(curve, Meet<C, S>(c.nu));
      const auto G = shear_modulus(laws.moduli, B, ratio_ini, y[0], y[1]);
      rate = std::max(rate, std::abs(value(G)) / (value(pressure(curve, Meet<C, S>(c.nu))) * value(c.s_max) *
                                                  value(direction.S_I)));
    }
    return e * rate;
  }
  /// What errors of the variables are relative to: what saturation allows.
  template <class C, class S>
  std::array<double, size> scales(const Coefficients<C>& c, const S* y) const {
    const double pressure = value(pressure_of(c.nu, c.phi_H, y[2]));
    return {std::max(value(c.s_max) * pressure, std::abs(value(y[0]))),
            std::max(value(c.F_max), std::abs(value(y[1]))), 1};
  }
  /// Reaches 0 where the pressure vanishes, or without contacts where it begins.
  template <class C, class S, class Y>
  auto distance_to_event(const Coefficients<C>& c, const BasicDirection<S>& direction, const Y* y) const {
    const auto pressure = pressure_of(c.nu, c.phi_H, y[2]);
    return direction.jammed ? pressure - smallest_pressure : first_pressure - pressure;
  }

  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                      const T* y) const {
    BasicState<T> state = begin.moved(stretch, t);
    state.history = compressed<P, T>(laws.memory.over, begin.history, state.nu);
    state.sigma_dev = y[0];
    state.F_dev = y[1];
    state.memory = y[2];
    state.phi_J = jamming_density_of(state.history.phi_H, state.memory);
    state.P = 0.0;
    if (state.jammed) state.P = pressure_of(state.nu, state.history.phi_H, state.memory);
    return state;
  }

  /// Above it shear can jam a point of any history.
  P unjamming_density() const { return laws.shear_pressure.nu_c; }

  /// What the rates have to know of the state that a stretch begins with.
  template <class T>
  void prepare(BasicState<T>& state) const {
    state.direction.history = state.history;
    state.direction.jammed = state.jammed;
  }

  /// Takes stress away; fabric and memory stay.
  template <class T>
  void unjam(BasicState<T>& state) const {
    state.P = state.sigma_dev = 0.0;
    state.jammed = false;
  }

  /// Jams a point on this stretch on the solution for P* -> 0: for sigma* proportional to P*, s = g/(1 + q
  /// g/s_max) with g = G (d eps_dev/dt)/(dP*/dt).
  template <class T>
  void jam(BasicState<T>& state, const BasicStretch<T>& stretch) const {
    state.jammed = true;
    state.direction.S_I = 1.0;
    prepare(state);
    state.P = pressure_of(state.nu, state.history.phi_H, state.memory);
    state.sigma_dev = 0.0;
    if (vanishes(stretch.eps_dev)) return;
    const auto q = stretch.q();
    const auto c = coefficients(state.nu, state.direction);
    const auto [B, ratio_ini] =
        stiffness(BasicPressureCurve<T>(curve_of(state.history.phi_H, state.memory)), state.nu);
    const T slope = B * ratio_ini * stretch.eps_dev / pressure_rate(state, stretch);
    state.sigma_dev = state.P * slope / (1 + q * slope / c.s_max);
  }

  /// Begins a direction of shear q.
  template <class T>
  void begin_direction(BasicState<T>& state, const Sign<T>& q) const {
    begin_direction_of(laws, state, q);
    if (state.jammed) return;
    state.direction.S_I = 1.0;
    state.direction.s_0 = 0.0;
  }

 private:
  /// dP*/dt where the stretch begins.
  template <class T>
  T pressure_rate(const BasicState<T>& state, const BasicStretch<T>& stretch) const {
    using D = Dual<1, T>;
    const BasicStretch<T> here{state.nu, stretch.eps_vol, stretch.eps_dev};
    const std::array<T, size> y{T(0.0), state.F_dev, state.memory};
    std::array<T, size> dydt;
    BasicDirection<T> unjammed = state.direction;
    unjammed.jammed = false;  // stress is not asked for
    const auto c = coefficients(here.nu_0, unjammed);
    rate(c, here, unjammed, y.data(), dydt.data());
    const D nu = here.nu(D(T(0.0), 0));
    const auto moving = coefficients(nu, unjammed);
    D m = state.memory;
    m.slope[0] = dydt[2];
    return pressure_of(moving.nu, moving.phi_H, m).slope[0];
  }
};
using Memory = BasicMemory<double>;

}  // namespace grainlaw::model
