// Limits of a path that hold however it came about.
#pragma once

namespace grainlaw {

constexpr double longest_duration = 1e15;  ///< of a segment, us: beyond it steps cannot be counted

}  // namespace grainlaw
