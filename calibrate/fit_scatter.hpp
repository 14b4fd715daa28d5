// What each seed says alone, and the mean of that: every packing jams at a volume fraction of its own, so
// that a law laid through the rows of all of them would smear the approach to jamming; and the rows of one do
// not tell how packings differ. Internal to the fits.
#pragma once

#include <cstddef>
#include <optional>
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

/// The mean of what the groups say, each weighted by 1/(its own error^2 + s^2), s being the scatter between
/// groups (Paule and Mandel), so that a packing that says little counts little.
struct GroupMean {
  std::vector<double> values, errors;  ///< of all parameters; held ones as they are
  std::size_t groups = 0;
  std::string left_out;  ///< groups whose own fit does not converge within its bounds: they have no estimate
  double rms = 0;        ///< of the residuals, each group's from its own fit
  double n_effective = 0;  ///< summed
  double condition = 0;    ///< the worst
};

/// Fits the parameters `free` to each group alone, from `best` on. None unless three groups of rows have a
/// fit that converges within its bounds.
std::optional<GroupMean> mean_over_groups(const FitProblem& problem, const std::vector<std::size_t>& free,
                                          const std::vector<double>& best);

}  // namespace grainlaw::calibrate
