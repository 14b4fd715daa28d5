// How much the DEM itself differs from packing to packing: the noise that every prediction error contains.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/record.hpp"

namespace grainlaw::report {

/// Relative L2 distance √(Σ(a − b)² / ½Σ(a² + b²)) between the records of one test with different seeds, mean
/// over all pairs. Row i of each stands at the same strain; rows where either is undefined do not count, nor
/// do pairs of unequal length or without a value that is not zero. Nothing where no pair is left.
std::optional<double> seed_scatter(const std::vector<const Record*>& records, const std::string& column);

}  // namespace grainlaw::report
