#include "grainlaw/element/record.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw {

namespace {

/// Without the blanks around it.
std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto at = line.find(separator);
    parts.push_back(trimmed(line.substr(0, at)));
    if (at == std::string_view::npos) return parts;
    line.remove_prefix(at + 1);
  }
}

/// Spreadsheets mark a file as UTF-8 by these bytes at its start.
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

struct ColumnRange {
  std::string_view column;
  Range range;
};

/// What no packing and no law can exceed. The pressure of a gas may be slightly negative: contacts pull
/// before parting.
const std::vector<ColumnRange>& column_ranges() {
  static const std::vector<ColumnRange> ranges{{"nu", inside(0, 1)},
                                               {"P", between(-1e3, 1e3)},
                                               {"sigma_dev", between(-1e3, 1e3)},
                                               {"F_v", at_least(0)},
                                               {"C", at_least(0)},
                                               {"C_star", at_least(0)},
                                               {"f_NR", between(0, 1)},
                                               {"phi_J", inside(0, 1)},
                                               {"Ek_over_Ep", at_least(0)},
                                               {"C_r", at_least(0)},
                                               {"phi_r", between(0, 1)},
                                               {"E_k", at_least(0)},
                                               {"E_p", at_least(0)},
                                               {"overlap", at_least(0)},
                                               {"xi_x", between(0, 1)},
                                               {"xi_y", between(0, 1)},
                                               {"xi_z", between(0, 1)},
                                               {"percolating", between(0, 3)},
                                               {"percolates_x", between(0, 1)},
                                               {"percolates_y", between(0, 1)},
                                               {"percolates_z", between(0, 1)},
                                               {"unbalanced", at_least(0)},
                                               {"D2_min", at_least(0)}};
  return ranges;
}

void check_range(double value, std::size_t line, const std::string& file, const std::string& column) {
  if (std::isnan(value)) return;
  for (const auto& [name, range] : column_ranges())
    if (name == column && !range.contains(value))
      throw Error(file, column,
                  "line " + std::to_string(line) + ": must be " + range.text() + ", got " + to_text(value));
}

/// A field of a record: a finite number, or empty for an undefined value.
double parse_field(std::string_view field, const std::string& file, std::size_t line,
                   const std::string& column) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
    throw Error(file, column,
                "line " + std::to_string(line) + ": must be a finite number or empty, got \"" +
                    std::string(field.substr(0, 40)) + "\"");
  return value;
}

/// A spreadsheet of another country parts columns otherwise, and has a comma in its numbers.
void check_separator(std::string_view header, const std::string& file) {
  for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}})
    if (header.find(separator) != std::string_view::npos && header.find(',') == std::string_view::npos)
      throw Error(
          file, "",
          std::string("line 1: columns must be separated by commas (and numbers have a decimal point), "
                      "got ") +
              name);
}

Error missing(const std::string& file, const std::string& column) {
  const std::string group = group_of_column(column);
  return {file, column,
          "column is missing" +
              (group.empty() ? ""
                             : "; a record of simulate has it where measure.standard of its scene names \"" +
                                   group + "\"")};
}

void check_header(const Record& record, const std::string& file, const std::vector<std::string>& required) {
  const auto& names = record.columns();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) throw Error(file, "", "line 1: column " + std::to_string(i + 1) + " has no name");
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      throw Error(file, names[i], "line 1: column is given twice");
  }
  for (const auto& column : required)
    if (!record.has(column)) throw missing(file, column);
}

}  // namespace

const std::vector<std::string>& prediction_columns() {
  static const std::vector<std::string> names{"segment",   "eps_vol", "eps_dev", "nu",    "P",
                                              "sigma_dev", "s_dev",   "F_v",     "F_dev", "C",
                                              "C_star",    "f_NR",    "phi_J"};
  return names;
}

const std::vector<std::string>& record_columns() {
  static const std::vector<std::string> names = [] {
    auto all = prediction_columns();
    all.insert(all.end(), {"t", "Ek_over_Ep"});
    for (const ComponentNames& columns : {stress_columns, fabric_columns})
      all.insert(all.end(), columns.begin(), columns.end());
    return all;
  }();
  return names;
}

Record::Record(std::vector<std::string> columns) : names_(std::move(columns)), data_(names_.size()) {}

std::size_t Record::index(std::string_view column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) throw missing("", std::string(column));
  return static_cast<std::size_t>(found - names_.begin());
}

bool Record::has(std::string_view column) const {
  return std::find(names_.begin(), names_.end(), column) != names_.end();
}

const std::vector<double>& Record::operator[](std::string_view column) const { return data_[index(column)]; }
std::vector<double>& Record::operator[](std::string_view column) { return data_[index(column)]; }

void Record::append(const std::vector<double>& row) {
  if (row.size() != names_.size())
    throw Error("a record row must have " + std::to_string(names_.size()) + " values, got " +
                std::to_string(row.size()));
  for (std::size_t i = 0; i < row.size(); ++i) data_[i].push_back(row[i]);
  ++rows_;
}

Record Record::read_csv(const std::filesystem::path& path, const std::vector<std::string>& required) {
  const std::string file = path.string();
  const std::string text = read_file(path);
  std::string_view rest = text;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  std::size_t line = 0;
  const auto next = [&](std::string_view& out) {
    if (rest.empty()) return false;
    const auto at = rest.find('\n');
    out = rest.substr(0, at);
    rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + 1);
    if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
    ++line;
    return true;
  };
  if (!text.empty() && text.back() != '\n')
    throw Error(
        file, "",
        "is cut short: its last line does not end with a newline");  // half a number reads as a whole one
  std::string_view current;
  if (!next(current)) throw Error(file, "", "is empty; a record starts with a header line");
  check_separator(current, file);
  std::vector<std::string> names;
  for (const auto name : split(current, ',')) names.emplace_back(name);
  Record record(std::move(names));
  check_header(record, file, required);
  std::vector<double> row(record.names_.size());
  while (next(current)) {
    const auto fields = split(current, ',');
    if (fields.size() != row.size())
      throw Error(file, "",
                  "line " + std::to_string(line) + ": must have " + std::to_string(row.size()) +
                      " fields, got " + std::to_string(fields.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = parse_field(fields[i], file, line, record.names_[i]);
      check_range(row[i], line, file, record.names_[i]);
    }
    record.append(row);
  }
  if (record.rows() == 0) throw Error(file, "", "has a header but no rows");
  return record;
}

std::string Record::to_csv() const {
  std::string text;
  for (std::size_t i = 0; i < names_.size(); ++i) text += (i == 0 ? "" : ",") + names_[i];
  text += '\n';
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const double value = data_[i][row];
      if (std::isinf(value))
        throw Error("", names_[i], "row " + std::to_string(row) + " of the record is infinite");
      if (i != 0) text += ',';
      if (!std::isnan(value)) text += to_text(value);
    }
    text += '\n';
  }
  return text;
}

void Record::write_csv(const std::filesystem::path& file) const { write_file(file, to_csv()); }

}  // namespace grainlaw
