// The CSV tables of data/thesis/tables as text, cell by cell: no field of theirs holds a comma or a quote.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace grainlaw::tests {

using Row = std::map<std::string, std::string>;

/// All rows of data/thesis/tables/NAME.csv. Throws std::runtime_error where a line has too few or too many
/// fields.
std::vector<Row> read_table(const std::string& name);

/// The one row whose cells are these. Throws std::runtime_error unless there is exactly one.
Row row_where(const std::vector<Row>& rows, const Row& cells);

/// A cell as a number. Throws std::runtime_error unless all of it is one.
double number(const Row& row, const std::string& column);

}  // namespace grainlaw::tests
