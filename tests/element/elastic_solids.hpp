// Stiffnesses with a closed form, for tests.
#pragma once

#include <cmath>

#include "grainlaw/element/stiffness.hpp"

namespace grainlaw::test {

/// Cubic: c11, c12, c44.
inline Stiffness cubic(double c11, double c12, double c44) {
  Stiffness c{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) c[a][b] = a == b ? c11 : c12;
    c[a + 3][a + 3] = c44;
  }
  return c;
}

inline Stiffness isotropic(double bulk, double shear) {
  return cubic(bulk + 4.0 / 3 * shear, bulk - 2.0 / 3 * shear, shear);
}

/// About z, no two of its five constants related.
inline Stiffness transversely_isotropic() {
  Stiffness c = cubic(5, 2, 1.2);
  c[2][2] = 7;
  c[0][2] = c[2][0] = c[1][2] = c[2][1] = 1.5;
  c[5][5] = 0.5 * (c[0][0] - c[0][1]);
  return c;
}

inline Stiffness orthotropic() {
  Stiffness c = transversely_isotropic();
  c[0][0] = 4;
  c[0][1] = c[1][0] = 1.1;
  c[3][3] = 0.7;
  return c;
}

/// 21 constants, positive definite.
inline Stiffness triclinic() {
  Stiffness c = orthotropic();
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < a; ++b)
      c[a][b] = c[b][a] =
          c[a][b] + 0.1 * std::sin(1.0 + 3.0 * static_cast<double>(a) + static_cast<double>(b * b));
  return c;
}

/// Turned about x, then y, then z.
inline Rotation turned(double x, double y, double z) {
  const double a = std::cos(x), b = std::sin(x), c = std::cos(y), d = std::sin(y), e = std::cos(z),
               f = std::sin(z);
  return {{{c * e, c * f, -d},
           {b * d * e - a * f, b * d * f + a * e, b * c},
           {a * d * e + b * f, a * d * f - b * e, a * c}}};
}

}  // namespace grainlaw::test
