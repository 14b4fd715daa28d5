// What a prediction tells of contacts that are lost and found again.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/model/state.hpp"
#include "grainlaw/model/status.hpp"
#include "grainlaw/model/walk/walk.hpp"

namespace grainlaw::model {

/// Adds a warning for each, up to ten, and one for all beyond.
void tell_events(const std::vector<Event>& events, std::vector<std::string>& warnings);

/// Of a path that was walked so far; where that is its end, whether that carries stress.
Status end_status(const Status& status, const State& end);

/// A point of a path, for a sentence.
std::string where(double nu, double eps_dev);

}  // namespace grainlaw::model
