// One fit with a fixed set of free parameters: minimum, standard errors, condition, and what is not
// determined. Internal to the fits.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// The parameters that are not held.
std::vector<std::size_t> free_parameters(const FitProblem& problem);

/// Fits the free parameters from their initial values. Needs more points than free parameters.
FitResult assess(const FitProblem& problem);

}  // namespace grainlaw::calibrate
