// Where along a path a prediction has its rows.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::model {

/// The legs of a path from volume fraction nu. Throws Error where a strain is no finite number, or where a
/// leg does not keep the axes of the first that shears: the law carries one direction of shear.
std::vector<Leg> legs_of(const Path& path, double nu);

/// The start, and rows evenly spaced on every leg; of a relaxation its end.
std::vector<Sample> even_samples(const std::vector<Leg>& legs, int rows_per_leg);

/// Throws Error unless they are points of that many legs, in order.
void check_samples(const std::vector<Sample>& samples, std::size_t legs);

}  // namespace grainlaw::model
