// The reduced forms: pressure from the packing law (Eq. 2.14), stress ratio and fabric from their approach to
// saturation, solved at the current volume fraction (Eqs. 2.17, 2.18) or by rate.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/state.hpp"
#include "grainlaw/model/walk/walk.hpp"

namespace grainlaw::model {

/// What both have in common.
template <class P>
struct BasicReducedPoint {
  BasicLaws<P> laws;

  /// A jammed state at t of a stretch.
  template <class T>
  BasicState<T> state_with(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                           const T& s_dev, const T& F_dev) const {
    BasicState<T> state = begin.moved(stretch, t);
    state.P = pressure(laws.pressure, state.nu);
    state.sigma_dev = s_dev * state.P;
    state.F_dev = F_dev;
    return state;
  }
  /// The volume fraction at and below which there is no pressure.
  P unjamming_density() const { return model::jamming_density(laws.pressure); }
  template <class T>
  void unjam(BasicState<T>& state) const {
    state.P = state.sigma_dev = state.F_dev = 0.0;
    state.jammed = false;
    state.direction = {};
  }
  /// At the density itself P* is 0 and s_dev has no value; the next number above it will do.
  template <class T>
  Meet<P, T> jamming_density(const BasicState<T>&) const {
    return unjamming_density() * (1 + 1e-12);
  }
  /// Isotropic before, at the start of a direction now.
  template <class T>
  void jam(BasicState<T>& state, const BasicStretch<T>& stretch) const {
    state.jammed = true;
    state.P = pressure(laws.pressure, state.nu);
    state.sigma_dev = state.F_dev = 0.0;
    state.direction = {.q = stretch.q(), .eps_dev_0 = state.eps_dev};
  }
  template <class T>
  void begin_direction(BasicState<T>& state, const Sign<T>& q) const {
    begin_direction_of(laws, state, q);
  }
};

/// Eqs. 2.17, 2.18 evaluated at the current volume fraction; nothing to integrate.
template <class P>
struct BasicReducedClosed : BasicReducedPoint<P> {
  static constexpr Form form = Form::reduced_closed;
  static constexpr std::size_t size = 0;
  using BasicReducedPoint<P>::laws;

  template <class T>
  BasicState<T> at(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t) const {
    using std::abs;
    // Without shear nothing approaches anything: s_dev and F_dev stay.
    if (stretch.eps_dev == 0) return this->state_with(begin, stretch, t, begin.s_dev(), begin.F_dev);
    const auto& d = begin.direction;
    const T nu = stretch.nu(t), e = abs(begin.eps_dev + stretch.eps_dev * t - d.eps_dev_0);
    const T s = approach(d.q * saturation(laws.s_max, nu), d.s_0, saturation(laws.beta_s, nu), e);
    const T F = approach(d.q * saturation(laws.F_max, nu), d.F_0, saturation(laws.beta_F, nu), e);
    return this->state_with(begin, stretch, t, s, F);
  }
};
using ReducedClosed = BasicReducedClosed<double>;

/// The solver of a Walk in this form: nothing to integrate.
struct Closed {
  template <class P, class T, class NextSample, class Visit>
  Reached<T> operator()(const BasicReducedClosed<P>& form, BasicState<T>& state,
                        const BasicStretch<T>& stretch, NextSample next_sample, Visit visit) const {
    const BasicState<T> begin = state;
    for (T t = next_sample(); t <= 1; t = next_sample()) visit(form.at(begin, stretch, t));
    state = form.at(begin, stretch, T(1.0));
    return {};
  }
};

/// ds = beta_s (q s_max - s)|d eps_dev|, dF = beta_F (q F_max - F)|d eps_dev|, P* = Eq. 2.14; variables
/// s_dev, F_dev.
template <class P>
struct BasicReduced : BasicReducedPoint<P> {
  static constexpr Form form = Form::reduced;
  static constexpr std::size_t size = 2;
  using BasicReducedPoint<P>::laws;

  template <class T>
  std::array<T, size> variables(const BasicState<T>& begin) const {
    return {begin.s_dev(), begin.F_dev};
  }
  /// Everything in the rates that depends on nu alone.
  template <class T>
  struct Coefficients {
    T s_max, beta_s, F_max, beta_F;
  };
  template <class T>
  Coefficients<Meet<P, T>> coefficients(const T& nu) const {
    return {saturation(laws.s_max, nu), saturation(laws.beta_s, nu), saturation(laws.F_max, nu),
            saturation(laws.beta_F, nu)};
  }
  template <class T, class S>
  auto coefficients(const T& nu, const BasicDirection<S>&) const {
    return coefficients(nu);
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    return {a.s_max + t * (b.s_max - a.s_max), a.beta_s + t * (b.beta_s - a.beta_s),
            a.F_max + t * (b.F_max - a.F_max), a.beta_F + t * (b.beta_F - a.beta_F)};
  }
  /// dy/dt along a stretch where the coefficients are `c`.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>&, const Y* y,
            Y* dydt) const {
    const auto q = stretch.q();
    const auto e = q * stretch.eps_dev;
    dydt[0] = approach_rate(q * c.s_max, y[0], c.beta_s * e);
    dydt[1] = approach_rate(q * c.F_max, y[1], c.beta_F * e);
    if (laws.terms.volumetric) dydt[1] = dydt[1] + fabric_by_volume(laws.volumetric, stretch.eps_vol, y[1]);
    return true;
  }
  /// The fastest rate of approach, per unit t.
  template <class C, class S>
  double relaxation(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>&,
                    const S*) const {
    return std::abs(value(stretch.eps_dev)) * std::max(value(c.beta_s), value(c.beta_F));
  }
  /// What errors of the variables are relative to: what saturation allows.
  template <class C, class S>
  std::array<double, size> scales(const Coefficients<C>& c, const S* y) const {
    return {std::max(value(c.s_max), std::abs(value(y[0]))), std::max(value(c.F_max), std::abs(value(y[1])))};
  }
  /// Pressure follows the volume: no event of its own.
  template <class C, class S, class Y>
  double distance_to_event(const Coefficients<C>&, const BasicDirection<S>&, const Y*) const {
    return 1;
  }
  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                      const T* y) const {
    return this->state_with(begin, stretch, t, y[0], y[1]);
  }
};
using Reduced = BasicReduced<double>;

}  // namespace grainlaw::model
