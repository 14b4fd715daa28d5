// Limits of a path that hold however it came about.
#pragma once

#include "grainlaw/element/json.hpp"

namespace grainlaw {

constexpr double longest_duration = 1e15;  ///< of a segment, us: beyond it steps cannot be counted
constexpr double largest_strain = 100;     ///< logarithmic, of a segment or from the path's start
constexpr double least_strain = 1e-12;  ///< that a segment must prescribe, if any: less is lost in rounding
/// Of grains: by how much the principal strains of one segment may differ. Edges of the box then differ by
/// exp(18) = 6.6e7, about 2^26, and the shortest distance in it keeps half of the 53 bits of its numbers. No
/// box that stays orthorhombic and wide enough for its grains comes there: it would need as many of them.
constexpr double largest_spread = 18;
/// Over k*: grains would overlap by more than their size. A larger number is one of Pa or kPa.
constexpr double largest_stress = 1;
/// Of fabric, of a ratio of stresses, and of any column where a path stops: far beyond any law, so that
/// nothing overflows.
constexpr double largest_ratio = 1000;

/// The range of a stress, whose message says of what it is a multiple.
inline Range of_k_star(Range range) {
  range.unit = "of k* = k/(2<r>)";
  return range;
}

}  // namespace grainlaw
