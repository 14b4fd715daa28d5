// The coupled form with memory: pressure is bounded by the volume fraction and a jamming density phi_J(H)
// that over-compression raises (Eqs. 5.1, 5.5) and shear takes down (5.3), gives back at a reversal and takes
// again (5.13).
//
// phi_H is what over-compression has left, m in [0, 1] what shear along either direction remembers
// (laws/shear_memory.hpp), phi_t the jamming density of the steady state that it was sheared towards.
//   phi_J = phi_H + (phi_t - phi_H) m
//   P*    = Eq. 2.14, the isotropic row, at phi_J
// phi_t follows phi_ss(nu), the phi_J at which that is the pressure of steady shear (row closure.contacts),
// over a strain eps0 of what is remembered. dsigma*_dev is that of Eq. 4.16, and dF_dev, too, times 1 - hold
// r, where r in [0, 1] says how far the fabric opposed the shear when it began.
//
// Decompression leaves phi_J. Compression raises it by Eqs. 5.1 and 5.5, whatever had lowered it: m falls by
// as much as phi_J rises faster than phi_H. Past the thesis: what a reversal gives back comes back denser;
// while the memory of the direction before empties, the packed part g goes up to its u, dg = pack_rate (u -
// g) (-du), and phi_H stands for phi_H + g (phi_pack - phi_H).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/laws/shear_memory.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// History after an isotropic or other change of volume from h.nu to nu: compression beyond phi_max is a
/// first one (M = 1 in Eq. 5.1); below it, from phi_H on, it is part of one more cycle, M growing with ln nu.
/// A packing that jams later than M = 1 has it, as one that starts from a measured pressure may, stays as far
/// below. Next to phi_SJ, where Eq. 5.5 has a first compression to nu leave more than nu, it leaves nu: the
/// packing does not jam yet.
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
    const auto left_by_first = [&o](const T& to) -> T {
      const T left = jamming_density_after(o, to, 1.0);
      if (to < left) return to;
      return left;
    };
    const T before = left_by_first(h.phi_max), first = left_by_first(nu);
    h.phi_max = nu;
    if (h.phi_H < before)
      h.phi_H = h.phi_H + (first - before);
    else if (h.phi_H < first)
      h.phi_H = first;
  }
  return h;
}

/// Variables sigma*_dev, F_dev, and of BasicShearHistory plus, minus, packed, steady. Fabric and memory go on
/// without contacts: shear can jam the point, and F_dev is then the anisotropy that it will have.
template <class P>
struct BasicMemory {
  static constexpr Form form = Form::memory;
  static constexpr std::size_t size = 6;
  static constexpr bool goes_on_unjammed = true;
  BasicLaws<P> laws;

  /// phi_t follows phi_ss over eps0/following of what is remembered, of which this is the least that counts.
  static constexpr double following = 4, least_share = 0.05;

  /// Everything in the rates that depends on nu and the history alone.
  template <class T>
  struct Coefficients {
    T nu, phi_H, phi_max, phi_ss, s_max, F_max, beta_F;
  };
  template <class T, class S>
  Coefficients<Meet<P, T>> coefficients(const T& nu, const BasicDirection<S>& direction) const {
    using C = Meet<P, T>;
    const BasicHistory<C> before{direction.history.phi_H, direction.history.phi_max, direction.history.nu};
    const BasicHistory<C> here = compressed<P, C>(laws.memory.over, before, nu);
    return {nu,
            here.phi_H,
            here.phi_max,
            steady_density<C>(nu),
            saturation(laws.s_max, nu),
            saturation(laws.F_max, nu),
            saturation(laws.beta_F, nu)};
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    const auto mix = [&t](const auto& from, const auto& to) { return from + t * (to - from); };
    return {mix(a.nu, b.nu),       mix(a.phi_H, b.phi_H), mix(a.phi_max, b.phi_max), mix(a.phi_ss, b.phi_ss),
            mix(a.s_max, b.s_max), mix(a.F_max, b.F_max), mix(a.beta_F, b.beta_F)};
  }

  /// phi_ss: the phi_J at which the isotropic row has the pressure of steady shear at nu. Where that has
  /// none, nu_c of its row, phi_s.
  template <class C>
  Meet<P, C> steady_density(const C& nu) const {
    using R = Meet<P, C>;
    const P& phi_s = laws.shear_pressure.nu_c;
    if (nu <= phi_s) return phi_s;
    const R wanted = pressure(laws.shear_pressure, nu);
    // Eq. 2.14 at phi_J depends on nu/phi_J alone: Newton's method in ratio = nu/phi_J, to half the digits,
    // and once more with slopes.
    const auto next = [&](const R& ratio) -> R {
      const R at = laws.pressure.nu_c * ratio;
      return ratio - (pressure(laws.pressure, at) - wanted) * ratio / pressure_slope(laws.pressure, at);
    };
    double ratio =
        1 + (value(nu) / value(phi_s) - 1) * (value(laws.shear_pressure.p0) / value(laws.pressure.p0));
    for (int i = 0; i < 30; ++i) {
      const double before = std::exchange(ratio, value(next(R(ratio))));
      if (!(ratio > 1)) ratio = 1 + (before - 1) / 8;  // jammed it is
      if (std::abs(ratio - before) < 1e-8) break;
    }
    return nu / next(R(ratio));
  }
  /// C of a memory m and history phi_H: its numbers lie between those of both rows.
  template <class C, class Y>
  BasicContactCurve<Meet<Meet<P, C>, Y>> contacts_of(const C& phi_H, const Y& m) const {
    using R = Meet<Meet<P, C>, Y>;
    const auto &iso = laws.pressure.contacts, &shear = laws.shear_pressure.contacts;
    const auto mix = [&](const auto& a, const auto& b) -> R { return a + m * (b - a); };
    return {mix(iso.C0, shear.C0),       mix(iso.C1, shear.C1),
            mix(iso.alpha, shear.alpha), mix(iso.nu_c * (phi_H / laws.pressure.nu_c), shear.nu_c),
            mix(iso.phi_c, shear.phi_c), mix(iso.phi_v, shear.phi_v)};
  }
  /// That of a state.
  template <class T>
  BasicContactCurve<Meet<P, T>> contacts_of(const BasicState<T>& state) const {
    return contacts_of(packed_density(state), memory(state.shear));
  }

  /// m of what is remembered of either direction.
  template <class Y>
  Meet<P, Y> memory(const Y& plus, const Y& minus) const {
    return memory_of(plus, minus, laws.memory.alpha);
  }
  template <class T>
  Meet<P, T> memory(const BasicShearHistory<T>& shear) const {
    return memory(shear.plus, shear.minus);
  }
  /// phi_H of what over-compression has left and of the packed part of the way to phi_pack.
  template <class C, class Y>
  Meet<Meet<P, C>, Y> packed_density(const C& phi_H, const Y& packed) const {
    if (laws.memory.phi_pack <= phi_H) return phi_H;
    return phi_H + packed * (laws.memory.phi_pack - phi_H);
  }
  template <class T>
  Meet<P, T> packed_density(const BasicState<T>& state) const {
    return packed_density(state.history.phi_H, state.shear.packed);
  }
  /// phi_J of a state.
  template <class T>
  Meet<P, T> jamming_density_of(const BasicState<T>& state) const {
    const auto phi_H = packed_density(state);
    return phi_H + memory(state.shear) * (state.shear.steady - phi_H);
  }
  /// P* at nu of a packing that jams at phi_J; 0 at and below that.
  template <class N, class R>
  auto pressure_of(const N& nu, const R& phi_J) const {
    return pressure(laws.pressure, laws.pressure.nu_c * (nu / phi_J));
  }
  /// phi_J of the variables y, and P*.
  template <class C, class Y>
  Meet<Meet<P, C>, Y> jamming_density_at(const Coefficients<C>& c, const Y* y) const {
    const auto phi_H = packed_density(c.phi_H, y[4]);
    return phi_H + memory(y[2], y[3]) * (y[5] - phi_H);
  }
  template <class C, class Y>
  Meet<Meet<P, C>, Y> pressure_at(const Coefficients<C>& c, const Y* y) const {
    return pressure_of(c.nu, jamming_density_at(c, y));
  }

  /// B and (G/B)_ini (Eqs. 4.11, 4.14) with contacts and strain counted from phi_J (section 5.H); below
  /// F_v,min the latter is 0, where 4.14 is negative.
  template <class R>
  struct Stiffness {
    R B, ratio_ini;
  };
  template <class R>
  Stiffness<R> stiffness(BasicContactCurve<R> contacts, const R& phi_J, R nu) const {
    using std::log;
    contacts.nu_c = phi_J;
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
  Stiffness<T> stiffness_of(const BasicState<T>& state) const {
    return stiffness<T>(contacts_of(state), jamming_density_of(state), state.nu);
  }

  template <class T>
  std::array<T, size> variables(const BasicState<T>& begin) const {
    return {begin.sigma_dev,   begin.F_dev,        begin.shear.plus,
            begin.shear.minus, begin.shear.packed, begin.shear.steady};
  }

  /// dy/dt along a stretch where the coefficients are `c`. False where it is not defined: jammed with P* <=
  /// 0, or saturation values that are not > 0.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    using std::abs;
    const Y &sigma = y[0], &F = y[1];
    const S &v = stretch.eps_vol, &e = stretch.eps_dev;
    using R = Meet<C, Y>;
    for (std::size_t i = 0; i < size; ++i) dydt[i] = 0.0;
    const bool shears = !vanishes(e);
    if (shears && !(c.s_max > 0 && c.F_max > 0 && c.beta_F >= 0)) return false;
    const auto q = stretch.q();
    const S size_e = abs(e);
    const S opposed = opposition(direction.S_F_I);
    const auto free = 1 - laws.memory.hold * opposed;
    const R phi_H = packed_density(c.phi_H, y[4]), m = memory(y[2], y[3]), phi_J = phi_H + m * (y[5] - phi_H);
    if (direction.jammed) {
      const auto [B, ratio_ini] = stiffness<R>(contacts_of(phi_H, m), phi_J, R(c.nu));
      dydt[0] = anisotropy_modulus_2(laws.moduli, B, F) * v;
      if (shears) {
        // Half of the pressure at which the event comes holds beyond it: P* is not a variable that a step
        // could keep above 0, and a step has to look past the event to find it.
        R P_star = pressure_of(c.nu, phi_J);
        if (P_star < smallest_pressure / 2) P_star = smallest_pressure / 2;
        const auto G = shear_modulus(laws.moduli, B, ratio_ini, sigma, F);
        dydt[0] = dydt[0] + G * (1 - q * sigma / (P_star * c.s_max)) * (e / direction.S_I);
      }
    }
    if (laws.terms.volumetric) dydt[1] = fabric_by_volume(laws.volumetric, v, F);
    if (v > 0 && direction.jammed) {  // it begins with contacts, at an event
      const R lost = loss_by_compression(c, phi_H, m, phi_J, y);
      for (const std::size_t i : {2, 3}) dydt[i] = y[i] * (lost * -v);
      // phi_t goes along with phi_H, so that it is phi_J that grows by Eqs. 5.1 and 5.5
      R share = 1.0;
      if (laws.memory.phi_pack > c.phi_H) share = 1 - y[4];
      dydt[5] = share * growth_by_compression(laws.memory.over, c.phi_H, c.nu, c.phi_max) * v;
    }
    if (!shears) return true;
    dydt[1] = dydt[1] + approach_rate(q * c.F_max, F, c.beta_F * free * (size_e / direction.S_F_I));
    const std::size_t along = q > 0 ? 2 : 3, against = 5 - along;
    const auto per_strain = [&](const P& reversed) {
      return ((1 - opposed) / laws.memory.eps0 + opposed / reversed) * size_e;
    };
    dydt[along] = dydt[along] + filling_rate(y[along], laws.memory.alpha) * per_strain(laws.memory.eps0_R);
    // What is remembered, as u of one direction, has to be turned over; next to nothing is at once.
    const R whole = (y[2] < y[3] ? y[3] : y[2]) + least_share;
    dydt[5] = dydt[5] + (c.phi_ss - y[5]) * (following * size_e / (laws.memory.eps0 * whole));
    const R emptied = emptying_rate(y[against]) * per_strain(laws.memory.eps_r);
    dydt[against] = dydt[against] - emptied;
    if (y[against] > y[4]) dydt[4] = laws.memory.pack_rate * (y[against] - y[4]) * emptied;
    return true;
  }
  /// The fastest rate of approach, per unit t.
  template <class C, class S>
  double relaxation(const Coefficients<C>& c, const BasicStretch<S>& stretch,
                    const BasicDirection<S>& direction, const S* y) const {
    const double e = std::abs(value(stretch.eps_dev));
    if (e == 0) return 0;
    const double emptying = value(y[stretch.q() > 0 ? 3 : 2]);
    double rate = std::max(value(c.beta_F) / value(direction.S_F_I),
                           value(laws.memory.alpha) / value(laws.memory.eps0));
    const double remembers = std::max(value(y[2]), value(y[3]));
    if (remembers > 0)
      rate = std::max(rate, following / (value(laws.memory.eps0) * (remembers + least_share)) *
                                std::min(1.0, value(memory(y[2], y[3]))));
    if (emptying > 0) rate = std::max(rate, emptying_rate(emptying) / (emptying * value(laws.memory.eps_r)));
    if (direction.jammed) {
      using R = Meet<C, S>;
      const R phi_J = jamming_density_at(c, y);
      const auto [B, ratio_ini] =
          stiffness<R>(contacts_of(packed_density(c.phi_H, y[4]), memory(y[2], y[3])), phi_J, R(c.nu));
      const auto G = shear_modulus(laws.moduli, B, ratio_ini, y[0], y[1]);
      rate = std::max(rate, std::abs(value(G)) /
                                (value(pressure_of(c.nu, phi_J)) * value(c.s_max) * value(direction.S_I)));
    }
    return e * rate;
  }
  /// What errors of the variables are relative to: what saturation allows.
  template <class C, class S>
  std::array<double, size> scales(const Coefficients<C>& c, const S* y) const {
    const double pressure = value(pressure_at(c, y));
    return {std::max(value(c.s_max) * pressure, std::abs(value(y[0]))),
            std::max(value(c.F_max), std::abs(value(y[1]))),
            1,
            1,
            1,
            0.01};
  }
  /// Reaches 0 where the pressure vanishes, or without contacts where it begins.
  template <class C, class S, class Y>
  auto distance_to_event(const Coefficients<C>& c, const BasicDirection<S>& direction, const Y* y) const {
    const auto pressure = pressure_at(c, y);
    return direction.jammed ? pressure - smallest_pressure : first_pressure - pressure;
  }

  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                      const T* y) const {
    BasicState<T> state = begin.moved(stretch, t);
    state.history = compressed<P, T>(laws.memory.over, begin.history, state.nu);
    state.sigma_dev = y[0];
    state.F_dev = y[1];
    const auto part = [](const T& u) -> T {  // a step may end a little beyond
      if (u < 0) return 0.0;
      if (u > 1) return 1.0;
      return u;
    };
    state.shear = {part(y[2]), part(y[3]), part(y[4]), y[5]};
    state.phi_J = jamming_density_of(state);
    state.P = 0.0;
    if (state.jammed) state.P = pressure_of(state.nu, state.phi_J);
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
    state.P = pressure_of(state.nu, jamming_density_of(state));
    state.sigma_dev = 0.0;
    if (vanishes(stretch.eps_dev)) return;
    const auto q = stretch.q();
    const auto c = coefficients(state.nu, state.direction);
    const auto [B, ratio_ini] = stiffness_of(state);
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
  /// -d ln u/d ln nu of either direction under compression: m falls by as much as phi_J rises faster than
  /// phi_H by Eqs. 5.1 and 5.5.
  template <class C, class R, class Y>
  R loss_by_compression(const Coefficients<C>& c, const R& phi_H, const R& m, const R& phi_J,
                        const Y* y) const {
    using std::abs;
    const R deficit = phi_H - phi_J, phi_max = c.phi_max;
    if (value(abs(deficit)) < 1e-10 || !(m > 0)) return 0.0;
    const R rate = (growth_by_compression(laws.memory.over, phi_J, R(c.nu), phi_max) -
                    growth_by_compression(laws.memory.over, phi_H, R(c.nu), phi_max)) /
                   deficit;
    if (rate <= 0) return 0.0;
    const R a = remembered(y[2], laws.memory.alpha), b = remembered(y[3], laws.memory.alpha);
    R share = a * (1 - b) + b * (1 - a);
    if (share < 1e-3 * m) share = 1e-3 * m;  // of two full memories neither takes any from m
    return rate * m / (share * laws.memory.alpha);
  }

  /// dP*/dt where the stretch begins.
  template <class T>
  T pressure_rate(const BasicState<T>& state, const BasicStretch<T>& stretch) const {
    using D = Dual<1, T>;
    const BasicStretch<T> here{state.nu, stretch.eps_vol, stretch.eps_dev};
    const std::array<T, size> y = variables(state);
    std::array<T, size> dydt;
    BasicDirection<T> unjammed = state.direction;
    unjammed.jammed = false;  // stress is not asked for
    const auto c = coefficients(here.nu_0, unjammed);
    rate(c, here, unjammed, y.data(), dydt.data());
    const D nu = here.nu(D(T(0.0), 0));
    const auto moving = coefficients(nu, unjammed);
    std::array<D, size> along;
    for (std::size_t i = 0; i < size; ++i) {
      along[i] = y[i];
      along[i].slope[0] = dydt[i];
    }
    return pressure_at(moving, along.data()).slope[0];
  }
};
using Memory = BasicMemory<double>;

}  // namespace grainlaw::model
