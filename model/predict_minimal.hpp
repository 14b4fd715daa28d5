// A prediction by the thesis's minimal model (section 5.H, model/forms/minimal.hpp), which is evaluated, not
// integrated.
#pragma once

#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/model/forms/minimal.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::model {

/// Its name beside those of the forms that are integrated.
inline constexpr const char* minimal_name = "minimal";

/// Throws Error naming the row or group that the set lacks. Without memory.phi_cr it is 1: every reversal,
/// at any nu, takes phi_J back to what over-compression has left.
MinimalLaws minimal_laws(const ParameterSet& parameters);

/// As predict(): one row for the start, then `rows_per_leg` per leg. Throws Error for a path that is not
/// given by its strain or does not keep its axes, and for a start that is not isotropic.
Prediction predict_minimal(const ParameterSet& parameters, const Path& path, int rows_per_leg = 100);
/// The same with one row per sample.
Prediction predict_minimal(const ParameterSet& parameters, const Path& path,
                           const std::vector<Sample>& samples);

}  // namespace grainlaw::model
