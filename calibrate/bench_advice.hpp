// What a bench recommends, in words.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/bench_errors.hpp"

namespace grainlaw::calibrate {

/// For one test and for means over many: of each knob the cheapest value for each of the wanted errors, what
/// it takes, and the largest error that was excused. Lines, without one at the end.
std::string bench_advice(const std::vector<BenchError>& errors);

}  // namespace grainlaw::calibrate
