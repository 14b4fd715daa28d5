// What a scene can ask for by name under measure.observe, and the columns and tables that it gets.
#pragma once

#include <string>
#include <vector>

namespace grainlaw::dem::observe {

/// All names, in the order of their columns.
const std::vector<std::string>& names();
/// The columns that `asked` adds to record.csv, in the order of names().
std::vector<std::string> columns(const std::vector<std::string>& asked);
/// Of these, what every version wrote: a record that was made earlier may lack the others.
std::vector<std::string> lasting_columns(const std::vector<std::string>& asked);
/// The files beside record.csv that `asked` makes.
std::vector<std::string> tables(const std::vector<std::string>& asked);

}  // namespace grainlaw::dem::observe
