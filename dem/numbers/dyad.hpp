// Sums of a (x) a: what stress and fabric are made of.
#pragma once

#include "grainlaw/dem/numbers/vec.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

/// sum += factor a (x) a; also a (x) b for parallel a and b, with the ratio in `factor`.
inline void add_dyad(Sym6& sum, double factor, const Vec3& a) {
  sum[0] += factor * a[0] * a[0];
  sum[1] += factor * a[1] * a[1];
  sum[2] += factor * a[2] * a[2];
  sum[3] += factor * a[1] * a[2];
  sum[4] += factor * a[0] * a[2];
  sum[5] += factor * a[0] * a[1];
}

inline Sym6 times(double factor, Sym6 q) {
  for (double& component : q) component *= factor;
  return q;
}

}  // namespace grainlaw::dem
