// Reading JSON with errors that name file, key, value and range: each key is asked for once, and a key that
// nobody asked for is an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// Compiled once, in json.cpp, instead of by every file that includes this: a third of the compiler's time.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace grainlaw {

/// Keeps the order of keys, so that what we write can be read by people.
using Json = nlohmann::ordered_json;

/// Reads a JSON file. Throws Error for a missing file, a syntax error (with its line), a key given twice,
/// nesting deeper than 64.
Json load_json(const std::filesystem::path& file);
Json parse_json(std::string_view text, const std::string& file);

/// An interval of admissible numbers and how to say it.
struct Range {
  double low, high;
  bool low_open, high_open;
  std::string_view unit = {};     ///< said after the numbers
  bool contains(double x) const;  ///< false for NaN and infinities
  std::string text() const;       ///< ">= 1", "> 0 and < 1", ">= 0 and <= 1 of k*"
};
Range any_number();
Range at_least(double low);
Range above(double low);
Range between(double low, double high);      ///< both ends included
Range inside(double low, double high);       ///< both ends excluded
Range above_up_to(double low, double high);  ///< low excluded, high included

/// Reads one JSON object. Call finish() when all keys were asked for.
class Reader {
 public:
  /// `key` is the path of this object within the file ("path.segments[2]"), empty at the top.
  Reader(const Json& object, std::string file, std::string key = "");

  bool has(std::string_view key) const;
  double number(std::string_view key, Range range);                   ///< required
  double number(std::string_view key, Range range, double fallback);  ///< optional
  std::optional<double> maybe_number(std::string_view key, Range range);
  std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high);
  std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high, std::int64_t fallback);
  std::string text(std::string_view key);
  std::string text(std::string_view key, std::string fallback);
  /// A word out of a list, e.g. "fit" or "predict"; the error lists them.
  std::string word(std::string_view key, const std::vector<std::string>& allowed);
  std::string word(std::string_view key, const std::vector<std::string>& allowed, std::string fallback);
  bool flag(std::string_view key, bool fallback);
  std::vector<double> numbers(std::string_view key, Range range, std::size_t at_least_count = 1);
  Reader object(std::string_view key);                ///< required
  Reader object_or_empty(std::string_view key);       ///< {} where missing
  std::vector<Reader> objects(std::string_view key);  ///< required list of objects, not empty
  std::vector<Reader> objects_or_none(std::string_view key);
  const Json& raw(std::string_view key);  ///< required, any type; counts as asked for
  std::vector<std::string> keys() const;  ///< all keys present

  /// Makes keys known that were looked at only if present, so that finish() can suggest them.
  void optional(std::initializer_list<std::string_view> keys);
  /// Throws Error for the first key that was not asked for, naming the nearest known one.
  void finish() const;
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
  const std::string& file() const { return file_; }
  std::string path_of(std::string_view key) const;  ///< "material.w"

 private:
  const Json* find(std::string_view key);
  const Json& require(std::string_view key);
  std::shared_ptr<const Json> object_;
  std::string file_;
  std::string key_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace grainlaw
