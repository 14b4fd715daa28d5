// The 36 derivatives of a packing's stress by strains that are applied, each back in balance: what linear
// response is held against.
#pragma once

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/stiffness/linear_response.hpp"
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

/// The 36 derivatives of the stress by central differences with strains of +-h.
inline Stiffness differences_at(const StaticPacking& packing, double h) {
  Stiffness slopes{};
  for (std::size_t b = 0; b < 6; ++b) {
    const Sym6 plus = stress_at(packing, b, h), minus = stress_at(packing, b, -h);
    for (std::size_t a = 0; a < 6; ++a) slopes[a][b] = (plus[a] - minus[a]) / (2 * h);
  }
  return slopes;
}

/// How far `measured` lies from `exact`.
struct Distance {
  double of_largest = 0;  ///< the largest difference, over the largest constant
  double of_each = 0;     ///< the largest difference over the constant that it belongs to
  double there = 0;       ///< that constant, over the largest
};

inline Distance distance(const Stiffness& measured, const Stiffness& exact) {
  Distance found;
  double largest = 0;
  for (const Sym6& row : exact)
    for (const double c : row) largest = std::max(largest, std::abs(c));
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      const double size = std::abs(exact[a][b]), error = std::abs(measured[a][b] - exact[a][b]);
      found.of_largest = std::max(found.of_largest, error / largest);
      if (error > found.of_each * size) found.of_each = error / size, found.there = size / largest;
    }
  return found;
}

}  // namespace grainlaw::dem
