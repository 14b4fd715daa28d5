#include "table.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace grainlaw::tests {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line + ",");
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

}  // namespace

std::vector<Row> read_table(const std::string& name) {
  std::ifstream stream(std::string(GRAINLAW_DATA_DIR) + "/thesis/tables/" + name + ".csv");
  std::string line;
  if (!std::getline(stream, line)) throw std::runtime_error(name + ".csv: cannot be read");
  const auto header = split(line);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const auto fields = split(line);
    if (fields.size() != header.size())
      throw std::runtime_error(name + ".csv: wrong number of fields in " + line);
    Row row;
    for (std::size_t i = 0; i < fields.size(); ++i) row[header[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

Row row_where(const std::vector<Row>& rows, const Row& cells) {
  std::vector<Row> found;
  for (const Row& row : rows)
    if (std::all_of(cells.begin(), cells.end(),
                    [&](const auto& cell) { return row.at(cell.first) == cell.second; }))
      found.push_back(row);
  if (found.size() != 1)
    throw std::runtime_error(std::to_string(found.size()) + " rows for " + cells.begin()->second);
  return found.front();
}

double number(const Row& row, const std::string& column) {
  const std::string& text = row.at(column);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || text.empty())
    throw std::runtime_error(column + " is not a number: " + text);
  return value;
}

}  // namespace grainlaw::tests
