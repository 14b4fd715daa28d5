// The columns of a prediction as functions of the state.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "grainlaw/model/forms/law.hpp"

namespace grainlaw::model {

/// Of prediction_columns() all but `segment`; NaN where it has no value (s_dev and C_star of an unjammed
/// point). Throws Error for another column.
double column_value(std::string_view column, const Law& law, const State& state);

/// A row of prediction_columns().
std::vector<double> row_of(const Contacts& contacts, const State& state, std::size_t segment);
std::vector<double> row_of(const Law& law, const State& state, std::size_t segment);

}  // namespace grainlaw::model
