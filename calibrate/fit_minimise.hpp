// The minimum of a weighted sum of squares within bounds, from several starts (Ceres, Levenberg-Marquardt).
// Internal to the fits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

struct Minimum {
  std::vector<double> values;  ///< of every parameter, held ones included
  double cost = 0;             ///< half the weighted sum of squares
  bool converged = false;
  std::string exit;  ///< in words
  int starts = 0;
  int best_found = 0;  ///< starts that ended at this cost
};

/// Minimises sum_i weight_i^2 (f(x_i; p) - y_i)^2 over the parameters listed in `free` (others stay at
/// `start`); `weights` has one number per point, series after series. The first start is `start`, further
/// ones form a Latin hypercube between the bounds (logarithmic where a parameter is positive over more than a
/// decade), from the problem's seed.
Minimum minimise(const FitProblem& problem, const std::vector<std::size_t>& free,
                 const std::vector<double>& weights, const std::vector<double>& start);

/// `count` points of a Latin hypercube in [0, 1)^dimensions, reproducible from `seed` on every machine.
std::vector<std::vector<double>> latin_hypercube(int count, std::size_t dimensions, std::uint64_t seed);

}  // namespace grainlaw::calibrate
