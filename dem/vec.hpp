// Small vectors: three numbers to compute with, four to store (one 32-byte line per grain and field).
#pragma once

#include <array>
#include <cmath>

namespace grainlaw::dem {

using Vec3 = std::array<double, 3>;

/// Four doubles in one aligned line; what the fourth one is, the owner says.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
};

inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

}  // namespace grainlaw::dem
