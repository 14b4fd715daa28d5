// What whole paths say about each parameter: standard errors, correlations, profiles of the likelihood.
// Internal to the fits (needs Eigen).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grainlaw/calibrate/path_problem.hpp"

namespace grainlaw::calibrate {

/// Parameters that the paths cannot tell, with the reason, by number: those they do not depend on, and one
/// after the other those that take most part in a direction along which nothing changes (singular value below
/// 1e-6 of the largest).
struct Blind {
  std::set<std::size_t> numbers;
  std::vector<std::string> reasons;  ///< of all parameters; empty where it is not one of them
};
Blind blind_parameters(const PathProblem& problem, const Eigen::MatrixXd& jacobian);

/// At a minimum; of all parameters, 0 or NaN for those that are `fixed`.
struct PathErrors {
  std::vector<double> errors;  ///< standard errors, residuals correlated along each run of rows
  Eigen::MatrixXd correlations;
  std::vector<double> inflation;  ///< error over that of independent residuals
  double variance = 1;            ///< of a residual, from their sum of squares
  double n_effective = 0;
};
PathErrors path_errors(const PathProblem& problem, const PathResiduals& at,
                       const std::set<std::size_t>& fixed);

/// The least cost over all other parameters, one held at `values`.
struct Profile {
  std::vector<double> values;
  /// Rise of -2 ln(likelihood) over its minimum, the residuals' correlation taken into account; NaN where the
  /// law did not come along the paths. (value - best)^2/error^2 where the law is linear.
  std::vector<double> rises;
  std::optional<double> low, high;  ///< where it rises by 3.84 (95 %); none: within 3 errors it does not
};
Profile profile_of(const PathProblem& problem, const PathMinimum& best, const PathErrors& errors,
                   const ColumnWeights& weights, const std::set<std::size_t>& fixed, std::size_t k);

}  // namespace grainlaw::calibrate
