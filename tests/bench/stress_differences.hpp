// The 36 derivatives of a packing's stress by strains that are applied, each back in balance: what linear
// response is held against.
#pragma once

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/linear_response.hpp"
#include "grainlaw/dem/minimise.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

/// To what rounding leaves.
inline void balance_fully(StaticPacking& packing) {
  MinimiseOptions options;
  options.residual = 1e-13;
  options.most_passes = 1'000'000;
  const MinimiseResult result = minimise(packing, options);
  if (result.outcome == Outcome::gave_up || result.outcome == Outcome::unjammed)
    throw Error("the packing is " + result.text());
}

inline Sym6 stress_at(const StaticPacking& start, std::size_t component, double size) {
  Sym6 strain{};
  strain[component] = component < 3 ? size : 0.5 * size;
  StaticPacking packing = start;
  packing.deform((Mat3::identity() + -1.0 * matrix_of(strain)) * packing.cell().edges());
  balance_fully(packing);
  return packing.measure().stress;
}

/// The largest difference of `stress` from central differences with strains of +-h, over the largest of them.
inline double error_at(const StaticPacking& packing, const Stiffness& stress, double h) {
  double error = 0, largest = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    const Sym6 plus = stress_at(packing, b, h), minus = stress_at(packing, b, -h);
    for (std::size_t a = 0; a < 6; ++a) {
      error = std::max(error, std::abs((plus[a] - minus[a]) / (2 * h) - stress[a][b]));
      largest = std::max(largest, std::abs(stress[a][b]));
    }
  }
  return error / largest;
}

}  // namespace grainlaw::dem
