// The law against tests it never saw: each record of role predict, in every form of the law, row by row.
#pragma once

#include <filesystem>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Relative L2 error of a predicted column over the rows of a test, sqrt(sum (x - y)^2 / sum y^2), y being
/// the record. Rows where either is undefined do not count; null where none is left or the record is zero
/// throughout.
Json relative_error(const std::vector<double>& predicted, const std::vector<double>& measured);

/// Predicts every record of role predict in `dir` (a campaign's output directory) along the path it ran, from
/// its volume fraction and the parameter set alone: no stress, no fabric and no fit of these records is used.
/// Writes predictions/TEST-sSEED.FORM.csv, with the rows of the record, and predictions.json, which is
/// returned. A path that the law refuses and an integration that fails are told in the entry's status; the
/// others go on.
Json predict_records(const std::filesystem::path& dir, const model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
