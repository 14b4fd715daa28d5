// Symmetric second-order tensors as six numbers, in the order xx, yy, zz, yz, xz, xy, and their deviatoric
// magnitude.
#pragma once

#include <array>
#include <cmath>

namespace grainlaw {

/// xx, yy, zz, yz, xz, xy; no factor 2 on the shear components.
using Sym6 = std::array<double, 6>;

/// Size of the largest component.
inline double largest_component(const Sym6& q) {
  double most = 0;
  for (const double component : q) most = std::abs(component) > most ? std::abs(component) : most;
  return most;
}

inline double trace(const Sym6& q) { return q[0] + q[1] + q[2]; }

/// Q_dev = sqrt(3 J2), Eqs. 2.4, 2.8, 2.10, 4.7: always >= 0; the mode gives the sign.
inline double deviator_magnitude(const Sym6& q) {
  const double a = q[0] - q[1], b = q[1] - q[2], c = q[2] - q[0];
  const double shear = q[3] * q[3] + q[4] * q[4] + q[5] * q[5];
  return std::sqrt(0.5 * (a * a + b * b + c * c + 6.0 * shear));
}

/// What of Q lies along the deviator n, in the measure of Q_dev: (3/2) n : Q/n_dev. It is Q_dev with its sign
/// where the two are coaxial, and linear in Q everywhere. n must have a deviator.
inline double deviator_along(const Sym6& q, const Sym6& n) {
  const double mean = trace(n) / 3;
  const double product = (n[0] - mean) * q[0] + (n[1] - mean) * q[1] + (n[2] - mean) * q[2] +
                         2 * (n[3] * q[3] + n[4] * q[4] + n[5] * q[5]);
  return 1.5 * product / deviator_magnitude(n);
}

}  // namespace grainlaw
