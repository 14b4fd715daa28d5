// The state in which a path starts: what the path gives, what the parameter set fills in, and where each
// value is from.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/law.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

struct StartState {
  Law law;  ///< at the jamming density of this start
  State state;
  Json echo;  ///< {"nu": {"value": 0.711, "from": "given"}, ...} for nu, P, sigma_dev, F_dev, phi_J
  std::vector<std::string> warnings;
};

/// Fills in `path.start`. Throws Error naming file and key for values that are missing or contradict one
/// another.
StartState start_of(const ParameterSet& parameters, const Path& path, const Choice& choice);
inline StartState start_of(const ParameterSet& parameters, const Path& path, Form form) {
  return start_of(parameters, path, {form, {}});
}

}  // namespace grainlaw::model
