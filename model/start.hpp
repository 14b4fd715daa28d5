// The state in which a path starts: what the path gives, what the parameter set fills in, and where each
// value is from.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

template <class T>
struct BasicStartState {
  BasicLaw<T> law;  ///< at the jamming density of this start
  BasicState<T> state;
  Json echo;  ///< {"nu": {"value": 0.711, "from": "given"}, ...} for nu, P, sigma_dev, F_dev, phi_J
  std::vector<std::string> warnings;
};
using StartState = BasicStartState<double>;

/// A value that the path gives ("nu", "P", ...) as a number of type T.
template <class T>
using StartReading = std::function<T(const char* key, double value)>;

/// Fills in `path.start`. Throws Error naming file and key for values that are missing or contradict one
/// another.
StartState start_of(const ParameterSet& parameters, const Path& path, const Choice& choice);
inline StartState start_of(const ParameterSet& parameters, const Path& path, Form form) {
  return start_of(parameters, path, {form, {}});
}

/// The same for numbers that `read` and `given` make; instantiated for double, Slopes and FewSlopes.
template <class T>
BasicStartState<T> start_of(const ParameterSet& parameters, const Path& path, const Choice& choice,
                            const Reading<T>& read, const StartReading<T>& given);

}  // namespace grainlaw::model
