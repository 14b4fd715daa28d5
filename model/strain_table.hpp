// A table of measured strains as a path of the law: from row to row the strain is straight.
#pragma once

#include <optional>
#include <string>

#include "grainlaw/model/predict.hpp"

namespace grainlaw::model {

/// Columns eps_vol = ln(nu/nu_start) and eps_dev, signed; strains count from the first row. `nu` and `P` of
/// the start are given, or those of the first row where the table has such columns. Other columns are not
/// looked at. Rows that repeat the one before change nothing.
///
/// Throws Error naming file, line and column for a value that is missing or out of range, and for a start
/// that is said twice.
MeasuredPath strain_path(const Record& table, const std::string& file, std::optional<double> nu,
                         std::optional<double> P);

}  // namespace grainlaw::model
