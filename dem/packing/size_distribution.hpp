// Radii of a packing: uniform on [2/(w+1), 2w/(w+1)] times the mean radius (section 3.2.1).
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// `count` radii in random order, mm. They are the mid-quantiles r_min + (r_max - r_min)(i + 1/2)/count, so
/// that every packing has the exact mean radius and, to O(1/count^2), the exact moments: seeds differ in
/// arrangement only, and the volume fraction of 1000 grains carries no scatter of their sizes.
std::vector<double> draw_radii(const Material& material, std::size_t count, Random& random);

}  // namespace grainlaw::dem
