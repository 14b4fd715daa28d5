// The account of a fit of whole paths: numbers for plots, sentences for people. Internal to the fits (needs
// Eigen).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "grainlaw/calibrate/path_errors.hpp"
#include "grainlaw/calibrate/path_problem.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Root mean square of (prediction - measured)/error over all rows: P and sigma_dev together, and F_dev. NaN
/// where the law does not come along, or nothing of the kind is compared.
struct Misfits {
  double stress = 0, fabric = 0;
};
Misfits misfits_of(const PathProblem& problem, const std::vector<double>& values);

/// One weighting of fabric against stress.
struct TradeOff {
  double part_of_fabric = 0;  ///< of the cost
  PathMinimum at;
  Misfits misfits;
};

struct PathFit {
  Blind blind;
  PathMinimum best;
  PathErrors errors;
  std::vector<TradeOff> trade_off;
  std::vector<Profile> profiles;  ///< of all parameters, or none
};

/// docs/fits.md lists the keys. A number that is not known is null.
Json account_of(const PathProblem& problem, const PathFit& fit, const std::vector<LeftOut>& left_out);

/// Relative L2 error of each column of every record of role predict, with the one set and the other.
Json held_out(const RecordFolder& folder, const model::ParameterSet& before, const model::ParameterSet& after,
              const model::Choice& form);

}  // namespace grainlaw::calibrate
