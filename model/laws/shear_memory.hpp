// What shear leaves in the jamming density, as rates: Eq. 5.3 on first loading, Eq. 5.13 after a reversal, in
// one law without jumps. Pure functions, over any scalar that knows log and pow.
//
// Each of the two directions of shear has a memory a in [0, 1]. Shear along it fills it,
//   1 - a = exp[-(eps/eps0)^alpha]                                                  (Eq. 5.3)
// with eps0_R in place of eps0 as far as the fabric opposed the shear when it began (Eq. 5.13). Together they
// are m, 1 - m = (1 - a_plus)(1 - a_minus), and
//   phi_J = phi_H + (phi_t - phi_H) m,
// phi_t the jamming density of the steady state towards which it was sheared.
// Since alpha > 1, a rate of a never leaves a = 0. What is integrated is u = a^(1/alpha), which begins as
// eps/eps0. Shear against a direction empties its u at a constant rate, down to 0: du = -|d eps_dev|/eps_r
// after steady shear, and as it was filled, with eps0, where the fabric does not oppose.
#pragma once

#include <cmath>

#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

/// What shear has left: u = a^(1/alpha) of either direction in [0, 1]; the part, in [0, 1], of the way from
/// phi_H to phi_pack that shear to and fro has packed; and phi_t, a density.
template <class T>
struct BasicShearHistory {
  T plus = 0;   ///< of shear with d eps_dev > 0
  T minus = 0;  ///< of shear with d eps_dev < 0
  T packed = 0;
  T steady = 0.5;
};
using ShearHistory = BasicShearHistory<double>;

template <class T>
ShearHistory values_of(const BasicShearHistory<T>& h) {
  return {value(h.plus), value(h.minus), value(h.packed), value(h.steady)};
}

/// a = u^alpha; u beyond [0, 1], as a step of an integrator may leave it, counts as its end.
template <class U, class A>
Meet<U, A> remembered(const U& u, const A& alpha) {
  using std::pow;
  if (u <= 0) return 0.0;
  if (u >= 1) return 1.0;
  return pow(u, alpha);
}

/// m of both directions.
template <class U, class A>
Meet<U, A> memory_of(const U& plus, const U& minus, const A& alpha) {
  return 1 - (1 - remembered(plus, alpha)) * (1 - remembered(minus, alpha));
}

/// du/dx where 1 - a = exp(-x^alpha), of a = remembered(u): [-ln(1 - a)/a]^((alpha - 1)/alpha) (1 - a), 1 at
/// a = 0 and 0 at a = 1.
template <class R, class A>
R filling_rate_of(const R& a, const A& alpha) {
  using std::log, std::pow;
  if (a >= 1) return 0.0;
  const R ratio = a < 1e-5 ? R(1 + a / 2 + a * a / 3) : R(-log(1 - a) / a);
  return pow(ratio, R(1 - 1 / alpha)) * (1 - a);
}
template <class U, class A>
Meet<U, A> filling_rate(const U& u, const A& alpha) {
  return filling_rate_of(remembered(u, alpha), alpha);
}

/// -eps_r du/d eps of the direction that is sheared against: 1, and about u = smooth_end less, to end at 0
/// without a corner; below 0, where a step may end, it leads back.
inline constexpr double smooth_end = 0.03;
template <class U>
U emptying_rate(const U& u) {
  using std::sqrt;
  return u / sqrt(u * u + smooth_end * smooth_end);
}

/// How far the fabric opposes a shear that begins where |1 - q F_dev/F_max| = S_F_I: 0 from isotropy, 1 after
/// steady shear the other way.
template <class T>
T opposition(const T& S_F_I) {
  const T r = S_F_I - 1;
  if (r <= 0) return 0.0;
  if (r >= 1) return 1.0;
  return r;
}

}  // namespace grainlaw::model
