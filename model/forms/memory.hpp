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
#include <optional>
#include <utility>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/laws/shear_memory.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// A change of volume from a history, with what is the same all along it. Compression beyond phi_max is a
/// first one (M = 1 in Eq. 5.1); below it, from phi_H on, it is part of one more cycle, M growing with ln nu.
/// A packing that jams later than M = 1 has it, as one that starts from a measured pressure may, stays as far
/// below. Next to phi_SJ, where Eq. 5.5 has a first compression to nu leave more than nu, it leaves nu: the
/// packing does not jam yet.
template <class P, class T>
class Compression {
 public:
  /// `share` is share_of_first(); `limit` Eq. 5.5 at before.phi_max.
  Compression(const BasicOverCompression<P>& o, const P& share, const BasicHistory<T>& before, const T& limit)
      : o_(&o), share_(share), before_(before), limit_(limit) {
    using std::log, std::pow;
    from_ = before.phi_H < before.nu ? before.nu : before.phi_H;
    cycles_ = from_ < before.phi_max && before.phi_H >= o.phi_SJ && before.phi_H < limit_;
    if (!cycles_) return;
    M_ = o.mu * pow(-log((limit_ - before.phi_H) / (limit_ - o.phi_SJ)), 1 / o.beta);
    length_ = log(before.phi_max / before.phi_H);
  }

  /// History where the volume fraction is nu, of this change or of its way back.
  template <class N>
  BasicHistory<Meet<T, N>> at(const N& nu) const {
    using std::expm1, std::log, std::pow;
    using R = Meet<T, N>;
    BasicHistory<R> h{before_.phi_H, before_.phi_max, nu};
    if (!(nu > from_)) return h;
    if (cycles_) {
      R to = before_.phi_max;
      if (nu < to) to = nu;
      const R M = M_ + log(to / from_) / length_;
      h.phi_H = o_->phi_SJ - (limit_ - o_->phi_SJ) * expm1(-pow(M / o_->mu, o_->beta));
    }
    if (before_.phi_max < nu) {
      const R before = left_by_first<R>(before_.phi_max, limit_),
              first = left_by_first<R>(nu, jamming_density_limit(*o_, nu));
      h.phi_max = nu;
      if (h.phi_H < before)
        h.phi_H = h.phi_H + (first - before);
      else if (h.phi_H < first)
        h.phi_H = first;
    }
    return h;
  }
  /// Eq. 5.5 at phi_max of such a history.
  template <class R>
  R limit_at(const BasicHistory<R>& h) const {
    if (before_.phi_max < h.phi_max) return jamming_density_limit(*o_, h.phi_max);
    return limit_;
  }

 private:
  template <class R>
  R left_by_first(const R& to, const R& limit) const {
    const R left = o_->phi_SJ + (limit - o_->phi_SJ) * share_;
    if (to < left) return to;
    return left;
  }

  const BasicOverCompression<P>* o_;
  P share_;
  BasicHistory<T> before_;
  T limit_, from_, M_ = 0.0, length_ = 0.0;
  bool cycles_;
};

/// History after an isotropic or other change of volume from h.nu to nu.
template <class P, class T>
BasicHistory<T> compressed(const BasicOverCompression<P>& o, const std::type_identity_t<P>& share,
                           BasicHistory<T> h, const T& nu) {
  if (nu > h.nu && nu > h.phi_H)
    return Compression<P, T>(o, share, h, jamming_density_limit(o, h.phi_max)).at(nu);
  h.nu = nu;
  return h;
}
template <class P, class T>
BasicHistory<T> compressed(const BasicOverCompression<P>& o, const BasicHistory<T>& h, const T& nu) {
  return compressed<P, T>(o, share_of_first(o), h, nu);
}

/// Variables sigma*_dev, F_dev, and of BasicShearHistory plus, minus, packed, steady. Fabric and memory go on
/// without contacts: shear can jam the point, and F_dev is then the anisotropy that it will have.
template <class P>
struct BasicMemory {
  static constexpr Form form = Form::memory;
  static constexpr std::size_t size = 6;
  static constexpr bool goes_on_unjammed = true;
  BasicLaws<P> laws;
  P share;  ///< share_of_first()

  explicit BasicMemory(BasicLaws<P> numbers)
      : laws(std::move(numbers)), share(share_of_first(laws.memory.over)) {}

  /// phi_t follows phi_ss over eps0/following of what is remembered, of which this is the least that counts.
  static constexpr double following = 4, least_share = 0.05;

  /// Everything in the rates that depends on nu and the history alone.
  template <class T>
  struct Coefficients {
    T nu, phi_H, phi_max, limit, phi_ss, s_max, F_max, beta_F;  ///< limit: Eq. 5.5 at phi_max
  };
  /// What coefficients along one stretch have in common, of those at its start.
  template <class C>
  struct Common {
    Coefficients<C> start;
    std::optional<Compression<P, C>> compression;  ///< none where the volume grows
  };
  template <class C, class S>
  Common<C> common(const Coefficients<C>& start, const BasicStretch<S>& stretch,
                   const BasicDirection<S>& direction) const {
    Common<C> common{start, {}};
    if (stretch.eps_vol > 0)
      common.compression = Compression<P, C>(laws.memory.over, share, history<C>(direction), start.limit);
    return common;
  }
  template <class T, class C>
  Coefficients<Meet<T, C>> coefficients(const T& nu, const Common<C>& common) const {
    using R = Meet<T, C>;
    const Coefficients<C>& start = common.start;
    BasicHistory<R> here{start.phi_H, start.phi_max, nu};
    R limit = start.limit;
    if (common.compression) {
      here = common.compression->at(nu);
      limit = common.compression->limit_at(here);
    }
    return {nu,
            here.phi_H,
            here.phi_max,
            limit,
            steady_density(nu, value(start.nu), value(start.phi_ss)),
            saturation(laws.s_max, nu),
            saturation(laws.F_max, nu),
            saturation(laws.beta_F, nu)};
  }
  template <class T, class S>
  Coefficients<Meet<P, T>> coefficients(const T& nu, const BasicDirection<S>& direction) const {
    using R = Meet<P, T>;
    const BasicHistory<R> here = compressed<P, R>(laws.memory.over, share, history<R>(direction), nu);
    return {nu,
            here.phi_H,
            here.phi_max,
            jamming_density_limit(laws.memory.over, here.phi_max),
            steady_density(nu),
            saturation(laws.s_max, nu),
            saturation(laws.F_max, nu),
            saturation(laws.beta_F, nu)};
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    const auto mix = [&t](const auto& from, const auto& to) { return from + t * (to - from); };
    return {mix(a.nu, b.nu),       mix(a.phi_H, b.phi_H),   mix(a.phi_max, b.phi_max),
            mix(a.limit, b.limit), mix(a.phi_ss, b.phi_ss), mix(a.s_max, b.s_max),
            mix(a.F_max, b.F_max), mix(a.beta_F, b.beta_F)};
  }

  /// phi_ss: the phi_J at which the isotropic row has the pressure of steady shear at nu. Where that has
  /// none, nu_c of its row, phi_s. It is looked for from the one `known` at another nu, if that is > phi_s.
  template <class C>
  Meet<P, C> steady_density(const C& nu, double known_at = 0, double known = 0) const {
    using R = Meet<P, C>;
    const P& phi_s = laws.shear_pressure.nu_c;
    if (nu <= phi_s) return phi_s;
    const R wanted = pressure(laws.shear_pressure, nu);
    // Eq. 2.14 at phi_J depends on ratio = nu/phi_J alone, and ratio - 1 is about proportional to nu/phi_s -
    // 1.
    const double from = value(phi_s), e = value(nu) - from;
    double ratio =
        1 + (known_at > from ? (known_at / known - 1) * e / (known_at - from)
                             : e / from * (value(laws.shear_pressure.p0) / value(laws.pressure.p0)));
    for (int i = 0; i < 30 && ratio > 1; ++i) {
      const auto [p, slope, curvature] = pressure_with_slopes(ratio);
      const double step = (value(wanted) - p) / slope;
      const double before =
          std::exchange(ratio, ratio + step / (1 + step * curvature / (2 * slope)));  // Halley
      if (!(ratio > 1)) ratio = 1 + (before - 1) / 8;                                 // jammed it is
      if (std::abs(ratio - before) < 2e-5 * (ratio - 1) + 1e-15) break;  // its cube is what is left
    }
    if constexpr (std::is_same_v<R, double>) {
      return nu / ratio;
    } else {
      // Once more, with slopes. Where contacts begin all are infinite; they are taken a little above.
      const double begin = value(laws.pressure.contacts.nu_c) / value(laws.pressure.nu_c);
      if (std::abs(ratio / begin - 1) < 1e-12) ratio = begin * (1 + 1e-12);
      const R at = laws.pressure.nu_c * ratio;
      return nu /
             (ratio - (pressure(laws.pressure, at) - wanted) * ratio / pressure_slope(laws.pressure, at));
    }
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
    const R begin = phi_J * least_ratio;
    if (nu < begin) nu = begin;
    return stiffness<R>(contacts, phi_J, nu, log(nu / phi_J));
  }
  /// The same for e = ln(nu/phi_J), nu at least phi_J least_ratio.
  static constexpr double least_ratio = 1 + 1e-9;
  template <class R>
  Stiffness<R> stiffness(BasicContactCurve<R> contacts, const R& phi_J, const R& nu, const R& e) const {
    contacts.nu_c = phi_J;
    BasicModuli<R> m{laws.moduli.p0,     laws.moduli.gamma_p, contacts.nu_c,       laws.moduli.g3, {}, {}, {},
                     laws.moduli.GB_max, laws.moduli.Fv_min,  laws.moduli.Fv_alpha};
    const auto fabric = fabric_with_slope(contacts, R(laws.g3), nu, e);
    R ratio = 0.0;
    if (fabric.F_v > m.Fv_min) ratio = initial_shear_ratio(m, fabric.F_v);
    return {bulk_modulus(m, fabric, e), ratio};
  }

  /// The coefficients, and what of the rates depends on them and on the variables: phi_H with what is packed,
  /// a of either direction, m, phi_J, P*, and with contacts the moduli.
  template <class C, class R>
  struct Here {
    Coefficients<C> c;
    R phi_H, a_plus, a_minus, m, phi_J, P_star;
    Stiffness<R> moduli;
  };
  template <class C, class S, class Y>
  Here<C, Meet<Meet<P, C>, Y>> here(const Coefficients<C>& c, const BasicDirection<S>& direction,
                                    const Y* y) const {
    using std::log;
    using R = Meet<Meet<P, C>, Y>;
    const R phi_H = packed_density(c.phi_H, y[4]), a_plus = remembered(y[2], laws.memory.alpha),
            a_minus = remembered(y[3], laws.memory.alpha), m = 1 - (1 - a_plus) * (1 - a_minus),
            phi_J = phi_H + m * (y[5] - phi_H), ratio = c.nu / phi_J;
    Here<C, R> here{c, phi_H, a_plus, a_minus, m, phi_J, 0.0, {0.0, 0.0}};
    R e = 0.0;
    if (ratio > 1) {
      e = log(ratio);
      here.P_star = pressure_at_strain(laws.pressure, R(laws.pressure.nu_c * ratio), e);
    }
    if (!direction.jammed) return here;
    here.moduli = ratio > least_ratio ? stiffness<R>(contacts_of(phi_H, m), phi_J, R(c.nu), e)
                                      : stiffness<R>(contacts_of(phi_H, m), phi_J, R(c.nu));
    return here;
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

  /// dy/dt along a stretch, of what is here(). False where it is not defined: jammed with P* <= 0, or
  /// saturation values that are not > 0.
  template <class C, class R, class S, class Y>
  bool rate(const Here<C, R>& here, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    using std::abs;
    const Coefficients<C>& c = here.c;
    const Y &sigma = y[0], &F = y[1];
    const S &v = stretch.eps_vol, &e = stretch.eps_dev;
    for (std::size_t i = 0; i < size; ++i) dydt[i] = 0.0;
    const bool shears = !vanishes(e);
    if (shears && !(c.s_max > 0 && c.F_max > 0 && c.beta_F >= 0)) return false;
    const auto q = stretch.q();
    const S size_e = abs(e);
    const S opposed = opposition(direction.S_F_I);
    const auto free = 1 - laws.memory.hold * opposed;
    if (direction.jammed) {
      const auto& [B, ratio_ini] = here.moduli;
      dydt[0] = anisotropy_modulus_2(laws.moduli, B, F) * v;
      if (shears) {
        // Half of the pressure at which the event comes holds beyond it: P* is not a variable that a step
        // could keep above 0, and a step has to look past the event to find it.
        R P_star = here.P_star;
        if (P_star < smallest_pressure / 2) P_star = smallest_pressure / 2;
        const auto G = shear_modulus(laws.moduli, B, ratio_ini, sigma, F);
        dydt[0] = dydt[0] + G * (1 - q * sigma / (P_star * c.s_max)) * (e / direction.S_I);
      }
    }
    if (laws.terms.volumetric) dydt[1] = fabric_by_volume(laws.volumetric, v, F);
    if (v > 0 && direction.jammed) {  // it begins with contacts, at an event
      const auto growth = [&]<class Phi>(const Phi& phi) -> Phi {
        return growth_by_compression<P, Phi>(laws.memory.over, share, c.limit, phi, c.nu, c.phi_max);
      };
      const bool packs = laws.memory.phi_pack > c.phi_H;
      const R unpacked = growth(R(c.phi_H)), whole = packs && !vanishes(y[4]) ? growth(here.phi_H) : unpacked;
      const R lost = loss_by_compression(here, whole, growth);
      for (const std::size_t i : {2, 3}) dydt[i] = y[i] * (lost * -v);
      // phi_t goes along with phi_H, so that it is phi_J that grows by Eqs. 5.1 and 5.5
      dydt[5] = packs ? (1 - y[4]) * unpacked * v : unpacked * v;
    }
    if (!shears) return true;
    dydt[1] = dydt[1] + approach_rate(q * c.F_max, F, c.beta_F * free * (size_e / direction.S_F_I));
    const std::size_t along = q > 0 ? 2 : 3, against = 5 - along;
    const auto per_strain = [&](const P& reversed) {
      return ((1 - opposed) / laws.memory.eps0 + opposed / reversed) * size_e;
    };
    dydt[along] = dydt[along] + filling_rate_of(q > 0 ? here.a_plus : here.a_minus, laws.memory.alpha) *
                                    per_strain(laws.memory.eps0_R);
    // What is remembered, as u of one direction, has to be turned over; next to nothing is at once.
    const R whole = (y[2] < y[3] ? y[3] : y[2]) + least_share;
    dydt[5] = dydt[5] + (c.phi_ss - y[5]) * (following * size_e / (laws.memory.eps0 * whole));
    if (vanishes(y[against])) return true;
    const R emptied = emptying_rate(y[against]) * per_strain(laws.memory.eps_r);
    dydt[against] = dydt[against] - emptied;
    if (y[against] > y[4]) dydt[4] = laws.memory.pack_rate * (y[against] - y[4]) * emptied;
    return true;
  }
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    return rate(here(c, direction, y), stretch, direction, y, dydt);
  }
  /// The fastest rate of approach, per unit t.
  template <class C, class R, class S>
  double relaxation(const Here<C, R>& here, const BasicStretch<S>& stretch,
                    const BasicDirection<S>& direction, const S* y) const {
    const double e = std::abs(value(stretch.eps_dev));
    if (e == 0) return 0;
    const double emptying = value(y[stretch.q() > 0 ? 3 : 2]);
    double rate = std::max(value(here.c.beta_F) / value(direction.S_F_I),
                           value(laws.memory.alpha) / value(laws.memory.eps0));
    const double remembers = std::max(value(y[2]), value(y[3]));
    if (remembers > 0)
      rate = std::max(rate, following / (value(laws.memory.eps0) * (remembers + least_share)) *
                                std::min(1.0, value(here.m)));
    if (emptying > 0)  // the fast end of what empties is as small as that is
      rate = std::max(rate,
                      emptying_rate(emptying) / (std::max(emptying, smooth_end) * value(laws.memory.eps_r)));
    if (direction.jammed) {
      const auto G = shear_modulus(laws.moduli, here.moduli.B, here.moduli.ratio_ini, y[0], y[1]);
      rate = std::max(rate,
                      std::abs(value(G)) / (value(here.P_star) * value(here.c.s_max) * value(direction.S_I)));
    }
    return e * rate;
  }
  /// What errors of the variables are relative to: what saturation allows.
  template <class C, class R, class S>
  std::array<double, size> scales(const Here<C, R>& here, const S* y) const {
    return {std::max(value(here.c.s_max) * value(here.P_star), std::abs(value(y[0]))),
            std::max(value(here.c.F_max), std::abs(value(y[1]))),
            1,
            1,
            1,
            0.01};
  }
  /// Reaches 0 where the pressure vanishes, or without contacts where it begins.
  template <class C, class R, class S, class Y>
  R distance_to_event(const Here<C, R>& here, const BasicDirection<S>& direction, const Y*) const {
    return direction.jammed ? here.P_star - smallest_pressure : first_pressure - here.P_star;
  }
  template <class C, class S, class Y>
  auto distance_to_event(const Coefficients<C>& c, const BasicDirection<S>& direction, const Y* y) const {
    const auto pressure = pressure_at(c, y);
    return direction.jammed ? pressure - smallest_pressure : first_pressure - pressure;
  }

  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t, const T* y,
                      const Here<Meet<P, T>, Meet<P, T>>* here = nullptr) const {
    BasicState<T> state = begin.moved(stretch, t);
    if (here)
      state.history = {here->c.phi_H, here->c.phi_max, state.nu};
    else
      state.history = compressed<P, T>(laws.memory.over, share, begin.history, state.nu);
    state.sigma_dev = y[0];
    state.F_dev = y[1];
    const auto part = [](const T& u) -> T {  // a step may end a little beyond
      if (u < 0) return 0.0;
      if (u > 1) return 1.0;
      return u;
    };
    state.shear = {part(y[2]), part(y[3]), part(y[4]), y[5]};
    state.P = 0.0;
    if (here && state.shear.packed == y[4]) {
      state.phi_J = here->phi_J;
      if (state.jammed) state.P = here->P_star;
      return state;
    }
    state.phi_J = jamming_density_of(state);
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
  template <class R, class S>
  static BasicHistory<R> history(const BasicDirection<S>& direction) {
    return {direction.history.phi_H, direction.history.phi_max, direction.history.nu};
  }

  /// Value, slope and curvature of Eq. 2.14, the isotropic row, over ratio = nu/nu_c > 1.
  std::array<double, 3> pressure_with_slopes(double ratio) const {
    const auto& row = laws.pressure.contacts;
    const double gamma = value(laws.pressure.gamma_p), per = value(laws.pressure.nu_c) / value(row.nu_c),
                 x = std::max(per * ratio - 1, 1e-16), alpha = value(row.alpha),
                 power = value(row.C1) * std::pow(x, alpha), C_star = value(row.C0) + power,
                 v = value(row.phi_v), phi = value(row.phi_c) * std::exp(-v * x);
    const double C = (1 - phi) * C_star, e = std::log(ratio), turned = 1 - 2 * gamma * e;
    double slope = 0, curvature = 0;  // of C; it stays where contacts have not begun
    if (per * ratio > 1) {
      const double rise = alpha * power / x;
      slope = per * ((1 - phi) * rise + v * phi * C_star);
      curvature = per * per * ((1 - phi) * rise * (alpha - 1) / x + v * phi * (2 * rise - v * C_star));
    }
    const double E = e * (1 - gamma * e), E_1 = turned / ratio, E_2 = -(2 * gamma + turned) / (ratio * ratio),
                 p0 = value(laws.pressure.p0);
    return {p0 * ratio * C * E, p0 * (C * E + ratio * (slope * E + C * E_1)),
            p0 * (2 * (slope * E + C * E_1) + ratio * (curvature * E + 2 * slope * E_1 + C * E_2))};
  }

  /// -d ln u/d ln nu of either direction under compression: m falls by as much as phi_J rises faster than
  /// phi_H, whose growth is `whole`, by Eqs. 5.1 and 5.5.
  template <class C, class R, class Growth>
  R loss_by_compression(const Here<C, R>& here, const R& whole, Growth growth) const {
    using std::abs;
    const R deficit = here.phi_H - here.phi_J;
    if (!(here.m > 0)) return 0.0;
    // Of two densities next to each other the difference would be one of roundings.
    R rate = 0.0;
    if (value(abs(deficit)) > 1e-6)
      rate = (growth(here.phi_J) - whole) / deficit;
    else
      rate = -growth(Dual<1, R>((here.phi_J + here.phi_H) / 2, 0)).slope[0];
    if (rate <= 0) return 0.0;
    constexpr double gentle = 1e-3;  // it begins without a corner
    rate = rate * rate / (rate + gentle);
    const R &a = here.a_plus, &b = here.a_minus;
    R part = a * (1 - b) + b * (1 - a);
    if (part < 1e-3 * here.m) part = 1e-3 * here.m;  // of two full memories neither takes any from m
    return rate * here.m / (part * laws.memory.alpha);
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
