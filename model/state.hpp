// A material point: its state, what a direction of shear remembers of its start, and the stretch of strain it
// is walked along (rate independent: the path variable t runs from 0 to 1). Templates over the scalar.
#pragma once

#include <cmath>
#include <limits>

#include "grainlaw/model/laws/shear_memory.hpp"
#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

/// -1, 0 or 1.
inline double sign(double x) { return static_cast<double>((x > 0) - (x < 0)); }
template <std::size_t N, class T>
double sign(const Dual<N, T>& x) {
  return sign(value(x));
}
/// The type of a sign of T.
template <class T>
using Sign = decltype(sign(std::declval<T>()));

/// A straight stretch of logarithmic strain, compression positive; t in [0, 1].
template <class T>
struct BasicStretch {
  T nu_0 = 0.5;   ///< volume fraction at t = 0
  T eps_vol = 0;  ///< change of ln nu: the full volume strain, 3 d eps_v of the thesis
  T eps_dev = 0;  ///< signed deviatoric strain

  template <class X>
  auto nu(const X& t) const {
    using std::exp;
    return nu_0 * exp(eps_vol * t);
  }
  BasicStretch rest(const T& t) const { return {nu(t), eps_vol * (1 - t), eps_dev * (1 - t)}; }
  /// q = sgn(d eps_dev): -1, 0 or 1.
  Sign<T> q() const { return sign(eps_dev); }
};
using Stretch = BasicStretch<double>;

/// What over-compression has left, in the form with memory.
template <class T>
struct BasicHistory {
  T phi_H = 0;    ///< phi_J of the isotropic packing
  T phi_max = 0;  ///< largest volume fraction seen
  T nu = 0;       ///< where this is so
};
using History = BasicHistory<double>;

/// What a direction of shear remembers of its start. A direction begins at the start of a path, at a
/// reversal, after a relaxation, and with the first shear after a purely isotropic stretch.
template <class T>
struct BasicDirection {
  Sign<T> q = 0;    ///< +1 or -1; 0: the next shear begins a new one
  T S_I = 1;        ///< |S| at its start, S = 1 - q s/s_max (Eq. 4.16), at least 1e-6
  T S_F_I = 1;      ///< the same of 1 - q F_dev/F_max
  T s_0 = 0;        ///< s_dev at its start (Eq. 2.17)
  T F_0 = 0;        ///< F_dev at its start (Eq. 2.18)
  T eps_dev_0 = 0;  ///< eps_dev at its start
  /// Of the state that the present stretch begins with; only in the form with memory.
  BasicHistory<T> history{};
  bool jammed = true;
};
using Direction = BasicDirection<double>;

/// A material point. Stresses over k*, compression positive; deviatoric values signed.
template <class T>
struct BasicState {
  T nu = 0.5;
  T eps_vol = 0;  ///< ln(nu/nu_start)
  T eps_dev = 0;
  T P = 0;
  T sigma_dev = 0;
  T F_dev = 0;
  T phi_J = 0;          ///< jamming density: at and below it the point is unjammed
  bool jammed = false;  ///< unjammed: P = sigma_dev = 0, no contacts; F_dev = 0 but with memory
  BasicDirection<T> direction;
  BasicHistory<T> history{};     ///< only in the form with memory, as is
  BasicShearHistory<T> shear{};  ///< what shear has left

  /// sigma_dev/P; NaN where unjammed.
  T s_dev() const {
    if (!jammed) return std::numeric_limits<double>::quiet_NaN();
    return sigma_dev / P;
  }
  /// The state at t of a stretch from here, with stress and fabric as they are.
  BasicState moved(const BasicStretch<T>& stretch, const T& t) const {
    BasicState state = *this;
    state.nu = stretch.nu(t);
    state.eps_vol += stretch.eps_vol * t;
    state.eps_dev += stretch.eps_dev * t;
    return state;
  }
};
using State = BasicState<double>;

/// The same without derivatives.
template <class T>
Stretch values_of(const BasicStretch<T>& s) {
  return {value(s.nu_0), value(s.eps_vol), value(s.eps_dev)};
}
template <class T>
History values_of(const BasicHistory<T>& h) {
  return {value(h.phi_H), value(h.phi_max), value(h.nu)};
}
template <class T>
Direction values_of(const BasicDirection<T>& d) {
  return {d.q,          value(d.S_I),       value(d.S_F_I),       value(d.s_0),
          value(d.F_0), value(d.eps_dev_0), values_of(d.history), d.jammed};
}
template <class T>
State values_of(const BasicState<T>& s) {
  return {value(s.nu),          value(s.eps_vol),   value(s.eps_dev),
          value(s.P),           value(s.sigma_dev), value(s.F_dev),
          value(s.phi_J),       s.jammed,           values_of(s.direction),
          values_of(s.history), values_of(s.shear)};
}

/// Every number of it but what the direction remembers.
template <class T>
bool is_finite(const BasicState<T>& s) {
  return std::isfinite(value(s.nu) + value(s.eps_vol) + value(s.eps_dev) + value(s.P) + value(s.sigma_dev) +
                       value(s.F_dev) + value(s.history.phi_H) + value(s.history.phi_max) +
                       value(s.shear.plus) + value(s.shear.minus) + value(s.shear.packed) + value(s.shear.steady));
}

/// |1 - q x/x_sat|, the scale of S and S_F in a direction. At saturation there is no elastic part: plastic
/// from the start. The floor keeps that limit finite; an elastic part this short (in strain, it over beta) is
/// none.
template <class T>
T distance_scale(const Sign<T>& q, const T& x, const T& x_sat) {
  using std::abs;
  constexpr double floor = 1e-6;
  const T scale = abs(1 - q * x / x_sat);
  if (scale < floor) return floor;
  return scale;
}

}  // namespace grainlaw::model
