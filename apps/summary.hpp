// What the terminal shows of a calibration at its end: parameters beside the thesis's, errors of the
// predictions.
#pragma once

#include <string>

#include "grainlaw/element/json.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::apps {

/// The fitted parameters, one line each: value, standard error, the thesis's value.
std::string parameter_table(const model::ParameterSet& parameters);
/// What could not be determined and why, and which checks hold (fits.json).
std::string fit_remarks(const Json& fits);
/// Relative errors of the predictions, mean over seeds, one line per test and form (predictions.json).
std::string prediction_table(const Json& predictions);

}  // namespace grainlaw::apps
