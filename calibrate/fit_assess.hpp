// One fit with a fixed set of free parameters: minimum, standard errors, condition, and what is not
// determined. Internal to the fits.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// Series after series.
std::vector<FitPoint> all_points(const FitProblem& problem);

/// True where `value` rests on a bound, to a tiny fraction of their distance.
bool at_low(const FitParameter& p, double value);
bool at_high(const FitParameter& p, double value);

/// The parameters that are not held.
std::vector<std::size_t> free_parameters(const FitProblem& problem);

/// Fits the free parameters from their initial values. Needs more points than free parameters.
FitResult assess(const FitProblem& problem);

}  // namespace grainlaw::calibrate
