// Approach of the stress ratio and the deviatoric fabric to their steady values under shear: Eqs. 2.17, 2.18,
// their rate forms, and the density dependence 2.20 of all four numbers in them. Templates over the scalar of
// the numbers (P) and of the state (T).
#pragma once

#include <cmath>

namespace grainlaw::model {

/// Numbers of Eq. 2.20 (Table 2.2 heads Q_v as "Q_c").
template <class P>
struct BasicSaturation {
  P Q_max = 0;   ///< limit at high volume fraction
  P Q_v = 0;     ///< excess at nu_c
  P alpha = 0;   ///< decay rate
  P nu_c = 0.5;  ///< volume fraction the decay counts from
};
using Saturation = BasicSaturation<double>;

/// Eq. 2.20: Q(nu) = Q_max + Q_v exp[-alpha (nu/nu_c - 1)]. Non-dimensional, >= 0 for the four quantities it
/// serves.
template <class P, class T>
auto saturation(const BasicSaturation<P>& q, const T& nu) {
  using std::exp;
  return q.Q_max + q.Q_v * exp(-q.alpha * (nu / q.nu_c - 1));
}

/// dQ/d nu of Eq. 2.20.
template <class P, class T>
auto saturation_slope(const BasicSaturation<P>& q, const T& nu) {
  using std::exp;
  return -q.alpha / q.nu_c * q.Q_v * exp(-q.alpha * (nu / q.nu_c - 1));
}

/// Eqs. 2.17, 2.18: x = x_sat - (x_sat - x_0) exp(-beta e), with e >= 0 the deviatoric strain since x was
/// x_0. Signed: in a direction q of shear the saturation value is q x_max.
template <class A, class B, class C, class E>
auto approach(const A& x_sat, const B& x_0, const C& beta, const E& e) {
  using std::expm1;
  return x_0 - (x_sat - x_0) * expm1(-beta * e);
}

/// Rate form of Eqs. 2.17, 2.18: dx/d|eps_dev| = beta (x_sat - x). Its derivative with respect to x is -beta.
template <class A, class X, class B>
auto approach_rate(const A& x_sat, const X& x, const B& beta) {
  return beta * (x_sat - x);
}

}  // namespace grainlaw::model
