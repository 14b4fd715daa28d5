// What `grainlaw bench dem` found, as a page and as pictures: cost against error.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/bench_errors.hpp"

namespace grainlaw::apps {

/// The page. `advice` is text, a line each.
std::string bench_page(const calibrate::Bench& bench, const std::vector<calibrate::BenchError>& errors,
                       const std::string& advice);

/// What errors are drawn over. Methods can be compared in seconds only: a pass of a minimiser is not a step.
enum class BenchCost { core_seconds, particle_steps };

/// A picture alone, an SVG file with its legend.
std::string bench_picture(const calibrate::Bench& bench, const std::vector<calibrate::BenchError>& errors,
                          BenchCost cost);

}  // namespace grainlaw::apps
