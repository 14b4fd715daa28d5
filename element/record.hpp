// The record of an element test: a table with named columns, the same for a DEM run and a prediction.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainlaw {

/// Columns a prediction may write, in order; a DEM record has record_columns().
const std::vector<std::string>& prediction_columns();
const std::vector<std::string>& record_columns();

/// A table of numbers with named columns. An undefined value is NaN in memory and an empty field on disk.
class Record {
 public:
  Record() = default;
  explicit Record(std::vector<std::string> columns);

  std::size_t rows() const { return rows_; }
  const std::vector<std::string>& columns() const { return names_; }
  bool has(std::string_view column) const;
  /// Throws Error naming the column if it is missing.
  const std::vector<double>& operator[](std::string_view column) const;
  std::vector<double>& operator[](std::string_view column);
  /// Appends a row; its size must be the number of columns.
  void append(const std::vector<double>& row);

  /// Reads a CSV file. Throws Error (file, line, column) for nan, inf, text, a short or long line, a repeated
  /// or missing column, a value that none can have (nu outside (0, 1)), an empty file. `required` lists
  /// columns that must be there. Blanks around a field, line ends of DOS and a byte order mark do not matter.
  static Record read_csv(const std::filesystem::path& file, const std::vector<std::string>& required = {});
  /// Writes aside, then renames; throws Error when the disk is full. Infinite values are refused.
  void write_csv(const std::filesystem::path& file) const;
  std::string to_csv() const;

 private:
  std::size_t index(std::string_view column) const;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> data_;
  std::size_t rows_ = 0;
};

}  // namespace grainlaw
