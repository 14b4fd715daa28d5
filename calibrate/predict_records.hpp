// Predictions of the tests that no fit has read, beside their records: how good is the law?
// The law follows the path that the test ran, from the volume fraction it started at, in every form.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// For each record of role predict in `dir` (see read_records) and each form of the law, the coupled one also
/// with the terms past the thesis that the set has numbers for: writes
/// predictions/TEST-sSEED.FORM.csv, with one row per row of the record, and at the end predictions.json,
/// which is also returned (docs/fits.md lists its keys). The start is the record's volume fraction; every
/// other start value comes from `parameters`. A form that the set or the path does not allow is listed with
/// status "refused" and the reason. Throws Error for records that cannot be read.
Json predict_records(const std::filesystem::path& dir, const model::ParameterSet& parameters);

/// Relative L2 distance over the rows where both are defined: sqrt(sum (a - b)^2 / sum b^2), b the measured
/// one. NaN where there is no such row or b vanishes.
double relative_distance(const std::vector<double>& predicted, const std::vector<double>& measured);

/// Rows that such a distance takes, and rows where only one of the two is defined (one that is shorter, or
/// missing, is undefined there).
struct RowCount {
  std::size_t compared = 0, missed = 0;
};
RowCount count_rows(const std::vector<double>& predicted, const std::vector<double>& measured);

}  // namespace grainlaw::calibrate
