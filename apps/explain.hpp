// What a scene turns on and what that costs, in words: grainlaw simulate --explain.
#pragma once

#include <string>

#include "grainlaw/dem/run/cost.hpp"

namespace grainlaw::apps {

std::string explanation(const dem::Scene& scene, const dem::SceneCost& cost);

}  // namespace grainlaw::apps
