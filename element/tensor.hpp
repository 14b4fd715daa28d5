// Symmetric second-order tensors as six numbers, in the order xx, yy, zz, yz, xz, xy, and their deviatoric
// magnitude.
#pragma once

#include <array>
#include <cmath>

namespace grainlaw {

/// xx, yy, zz, yz, xz, xy; no factor 2 on the shear components.
using Sym6 = std::array<double, 6>;

inline double trace(const Sym6& q) { return q[0] + q[1] + q[2]; }

/// Q_dev = sqrt(3 J2), Eqs. 2.4, 2.8, 2.10, 4.7: always >= 0; the mode gives the sign.
inline double deviator_magnitude(const Sym6& q) {
  const double a = q[0] - q[1], b = q[1] - q[2], c = q[2] - q[0];
  const double shear = q[3] * q[3] + q[4] * q[4] + q[5] * q[5];
  return std::sqrt(0.5 * (a * a + b * b + c * c + 6.0 * shear));
}

}  // namespace grainlaw
