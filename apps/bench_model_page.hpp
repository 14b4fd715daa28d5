// What `grainlaw bench model` found, as one picture: cost against error.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/apps/bench_model.hpp"

namespace grainlaw::apps {

/// An SVG file with its legend: a panel per path, one of increments, one of batches.
std::string bench_model_picture(const std::vector<ModelTiming>& timings);

}  // namespace grainlaw::apps
