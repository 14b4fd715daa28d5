// Standard errors from the scatter of what each seed alone says: they hold the difference from packing to
// packing, which the rows of one do not tell. Internal to the fits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// Standard errors from the estimates that each group alone gives.
struct Scatter {
  std::vector<double> errors;  ///< of the mean of these estimates, of all parameters; empty: no scatter
  std::size_t groups = 0;
  std::string clipped;  ///< "C1 of seed 2, alpha of seed 3": estimates that rest on a bound, else empty
};

/// Fits the parameters `free` to each group alone, from `best` on. None unless there are three groups of
/// rows, each with enough points for a fit that converges.
Scatter scatter_over_groups(const FitProblem& problem, const std::vector<std::size_t>& free,
                            const std::vector<double>& best);

}  // namespace grainlaw::calibrate
