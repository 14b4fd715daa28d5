// Approach of the stress ratio and the deviatoric fabric to their steady values under shear: Eqs. 2.17, 2.18,
// their rate forms, and the density dependence 2.20 of all four numbers in them.
#pragma once

#include <cmath>

namespace grainlaw::model {

/// Numbers of Eq. 2.20 (Table 2.2 heads Q_v as "Q_c").
struct Saturation {
  double Q_max = 0;   ///< limit at high volume fraction
  double Q_v = 0;     ///< excess at nu_c
  double alpha = 0;   ///< decay rate
  double nu_c = 0.5;  ///< volume fraction the decay counts from
};

/// Eq. 2.20: Q(nu) = Q_max + Q_v exp[-alpha (nu/nu_c - 1)]. Non-dimensional, >= 0 for the four quantities it
/// serves.
inline double saturation(const Saturation& q, double nu) {
  return q.Q_max + q.Q_v * std::exp(-q.alpha * (nu / q.nu_c - 1));
}

/// dQ/d nu of Eq. 2.20.
inline double saturation_slope(const Saturation& q, double nu) {
  return -q.alpha / q.nu_c * q.Q_v * std::exp(-q.alpha * (nu / q.nu_c - 1));
}

/// Eqs. 2.17, 2.18: x = x_sat - (x_sat - x_0) exp(-beta e), with e >= 0 the deviatoric strain since x was
/// x_0. Signed: in a direction q of shear the saturation value is q x_max.
inline double approach(double x_sat, double x_0, double beta, double e) {
  return x_0 - (x_sat - x_0) * std::expm1(-beta * e);
}

/// Rate form of Eqs. 2.17, 2.18: dx/d|eps_dev| = beta (x_sat - x). Its derivative with respect to x is -beta.
inline double approach_rate(double x_sat, double x, double beta) { return beta * (x_sat - x); }

}  // namespace grainlaw::model
