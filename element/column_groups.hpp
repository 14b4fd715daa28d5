// The groups of columns that a DEM record has where its scene asks for them, under measure.standard.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainlaw {

/// "stress", "fabric", "coordination", "energy_ratio": all words, in the order of their columns.
const std::vector<std::string>& column_groups();
/// The columns of a DEM record whose scene asks for `groups`, in the order of record_columns(); those of no
/// group are always there.
std::vector<std::string> record_columns_with(const std::vector<std::string>& groups);
/// The group that `column` is in; empty where it is in none.
std::string group_of_column(std::string_view column);

}  // namespace grainlaw
