// Fields of one vector per grain (displacements, forces), the fourth number 0, and sums over them, always in
// the same order.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/dem/numbers/vec.hpp"

namespace grainlaw::dem {

using Field = Quads;

inline double dot(const Field& a, const Field& b) {
  Quad sum;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum.x += a[i].x * b[i].x;
    sum.y += a[i].y * b[i].y;
    sum.z += a[i].z * b[i].z;
    sum.w += a[i].w * b[i].w;
  }
  return sum.x + sum.y + sum.z;
}

/// y += a x
inline void add(double a, const Field& x, Field& y) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i].x += a * x[i].x;
    y[i].y += a * x[i].y;
    y[i].z += a * x[i].z;
    y[i].w += a * x[i].w;
  }
}

/// y = x + a y
inline void add_to_scaled(const Field& x, double a, Field& y) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i].x = x[i].x + a * y[i].x;
    y[i].y = x[i].y + a * y[i].y;
    y[i].z = x[i].z + a * y[i].z;
    y[i].w = x[i].w + a * y[i].w;
  }
}

/// y = a y + b x
inline void scale_and_add(double a, Field& y, double b, const Field& x) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i].x = a * y[i].x + b * x[i].x;
    y[i].y = a * y[i].y + b * x[i].y;
    y[i].z = a * y[i].z + b * x[i].z;
    y[i].w = a * y[i].w + b * x[i].w;
  }
}

/// The largest |x|^2 of a grain.
inline double largest_square(const Field& x) {
  double largest = 0;
  for (const Quad& q : x) {
    const double square = q.x * q.x + q.y * q.y + q.z * q.z;
    largest = square > largest ? square : largest;
  }
  return largest;
}

}  // namespace grainlaw::dem
