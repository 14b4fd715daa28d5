// Limits of a path that hold however it came about.
#pragma once

namespace grainlaw {

constexpr double longest_duration = 1e15;  ///< of a segment, us: beyond it steps cannot be counted
constexpr double largest_strain = 100;     ///< logarithmic, of a segment or from the path's start
/// Over k*, and of fabric: far beyond any law, so that nothing overflows.
constexpr double largest_stress = 1000;

}  // namespace grainlaw
