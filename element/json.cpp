#include "grainlaw/element/json.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/words.hpp"

template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace grainlaw {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int deepest_nesting = 64;

/// Line (from 1) of a byte offset, for syntax errors.
std::size_t line_of(std::string_view text, std::size_t byte) {
  return 1 +
         static_cast<std::size_t>(std::count(text.begin(), text.begin() + std::min(byte, text.size()), '\n'));
}

/// Said of a syntax error at a number that JSON does not have, as other programs write it.
std::string hint_at(std::string_view text, std::size_t byte) {
  constexpr std::array<std::string_view, 6> none{"NaN", "nan", "-Infinity", "-inf", "Infinity", "inf"};
  for (const std::string_view word : none)
    for (std::size_t back = 1; back <= 2 && back <= byte; ++back)
      if (text.substr(std::min(byte - back, text.size())).starts_with(word))
        return ": a number must be finite, got " + std::string(word);
  return "";
}

/// Finds where reading ends that cannot go on; keeps nothing of what it read.
class Failure : public nlohmann::json_sax<Json> {
 public:
  std::size_t byte = 0;
  std::string token;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t at, const std::string& last, const Json::exception&) override {
    byte = at;
    token = last;
    return false;
  }
};

std::string shortened(const std::string& text) {
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// A value as it stands in the file, shortened for a message.
std::string shown(const Json& value) {
  return shortened(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// What a number should have been: "> 0", or "a number > 0" where the value is none.
std::string wanted(const Json& value, const Range& range) {
  const bool bare = value.is_number() || range.text().starts_with("a ");
  return std::string(bare ? "" : "a number ") + range.text();
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace

Json parse_json(std::string_view text, const std::string& file) {
  std::vector<std::set<std::string>> seen;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > deepest_nesting)
      throw Error(file, "", "is nested deeper than " + std::to_string(deepest_nesting) + " levels");
    if (event == Json::parse_event_t::object_start) seen.emplace_back();
    if (event == Json::parse_event_t::object_end) seen.pop_back();
    if (event == Json::parse_event_t::key && !seen.back().insert(parsed.get<std::string>()).second)
      throw Error(file, parsed.get<std::string>(), "is given twice in one object");
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::parse_error& error) {
    throw Error(file, "",
                "line " + std::to_string(line_of(text, error.byte)) + " is not valid JSON" +
                    hint_at(text, error.byte));
  } catch (const Json::out_of_range&) {  // of a number
    Failure failure;
    Json::sax_parse(text, &failure);
    throw Error(file, "",
                "line " + std::to_string(line_of(text, failure.byte)) + ": a number must be finite, got " +
                    shortened(failure.token));
  } catch (const Json::exception& error) {
    throw Error(file, "", std::string("is not valid JSON: ") + error.what());
  }
}

Json load_json(const std::filesystem::path& file) { return parse_json(read_file(file), file.string()); }

bool Range::contains(double x) const {
  return std::isfinite(x) && (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
}

std::string Range::text() const {
  std::string text;
  if (low != -infinity) text += std::string(low_open ? "> " : ">= ") + to_text(low);
  if (high != infinity)
    text += std::string(text.empty() ? "" : " and ") + (high_open ? "< " : "<= ") + to_text(high);
  if (text.empty()) text = "a finite number";
  return unit.empty() ? text : text + " " + std::string(unit);
}

Range any_number() { return {-infinity, infinity, true, true}; }
Range at_least(double low) { return {low, infinity, false, true}; }
Range above(double low) { return {low, infinity, true, true}; }
Range between(double low, double high) { return {low, high, false, false}; }
Range inside(double low, double high) { return {low, high, true, true}; }
Range above_up_to(double low, double high) { return {low, high, true, false}; }

Reader::Reader(const Json& object, std::string file, std::string key)
    : object_(std::make_shared<Json>(object)), file_(std::move(file)), key_(std::move(key)) {
  if (!object_->is_object()) throw Error(file_, key_, "must be an object {...}, got " + shown(*object_));
}

std::string Reader::path_of(std::string_view key) const {
  if (key.empty()) return key_;
  return key_.empty() ? std::string(key) : key_ + "." + std::string(key);
}

void Reader::fail(std::string_view key, const std::string& message) const {
  throw Error(file_, path_of(key), message);
}

bool Reader::has(std::string_view key) const { return object_->contains(key); }

const Json* Reader::find(std::string_view key) {
  known_.emplace(key);
  const auto found = object_->find(key);
  return found == object_->end() ? nullptr : &*found;
}

const Json& Reader::require(std::string_view key) {
  const Json* value = find(key);
  if (value == nullptr) fail(key, "is missing");
  return *value;
}

const Json& Reader::raw(std::string_view key) { return require(key); }

double Reader::number(std::string_view key, Range range) {
  const Json& value = require(key);
  if (!value.is_number() || !range.contains(value.get<double>()))
    fail(key, "must be " + wanted(value, range) + ", got " + shown(value));
  return value.get<double>();
}

double Reader::number(std::string_view key, Range range, double fallback) {
  return find(key) == nullptr ? fallback : number(key, range);
}

std::optional<double> Reader::maybe_number(std::string_view key, Range range) {
  if (find(key) == nullptr) return std::nullopt;
  return number(key, range);
}

std::int64_t Reader::integer(std::string_view key, std::int64_t low, std::int64_t high) {
  const Json& value = require(key);
  const bool whole = value.is_number() && std::nearbyint(value.get<double>()) == value.get<double>();
  const double x = whole ? value.get<double>() : 0;
  if (!whole || x < static_cast<double>(low) || x > static_cast<double>(high))
    fail(key, "must be a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
                  ", got " + shown(value));
  return value.is_number_integer() ? value.get<std::int64_t>() : static_cast<std::int64_t>(x);
}

std::int64_t Reader::integer(std::string_view key, std::int64_t low, std::int64_t high,
                             std::int64_t fallback) {
  return find(key) == nullptr ? fallback : integer(key, low, high);
}

std::string Reader::text(std::string_view key) {
  const Json& value = require(key);
  if (!value.is_string()) fail(key, "must be a text, got " + shown(value));
  return value.get<std::string>();
}

std::string Reader::text(std::string_view key, std::string fallback) {
  return find(key) == nullptr ? fallback : text(key);
}

std::string Reader::word(std::string_view key, const std::vector<std::string>& allowed) {
  const Json& value = require(key);
  if (!value.is_string() ||
      std::find(allowed.begin(), allowed.end(), value.get<std::string>()) == allowed.end())
    fail(key, "must be one of " + listed(allowed) + ", got " + shown(value));
  return value.get<std::string>();
}

std::string Reader::word(std::string_view key, const std::vector<std::string>& allowed,
                         std::string fallback) {
  return find(key) == nullptr ? fallback : word(key, allowed);
}

bool Reader::flag(std::string_view key, bool fallback) {
  const Json* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_boolean()) fail(key, "must be true or false, got " + shown(*value));
  return value->get<bool>();
}

std::vector<double> Reader::numbers(std::string_view key, Range range, std::size_t at_least_count) {
  const Json& list = require(key);
  if (!list.is_array()) fail(key, "must be a list of numbers, got " + shown(list));
  if (list.size() < at_least_count)
    fail(key, "must have at least " + std::to_string(at_least_count) + " numbers, got " +
                  std::to_string(list.size()));
  std::vector<double> values;
  for (const Json& item : list) {
    if (!item.is_number() || !range.contains(item.get<double>()))
      fail(std::string(key) + "[" + std::to_string(values.size()) + "]",
           "must be " + wanted(item, range) + ", got " + shown(item));
    values.push_back(item.get<double>());
  }
  return values;
}

Reader Reader::object(std::string_view key) { return Reader(require(key), file_, path_of(key)); }

Reader Reader::object_or_empty(std::string_view key) {
  const Json* value = find(key);
  return Reader(value == nullptr ? Json::object() : *value, file_, path_of(key));
}

std::vector<Reader> Reader::objects_or_none(std::string_view key) {
  const Json* list = find(key);
  if (list == nullptr) return {};
  if (!list->is_array()) fail(key, "must be a list of objects, got " + shown(*list));
  std::vector<Reader> readers;
  for (const Json& item : *list)
    readers.emplace_back(item, file_, path_of(key) + "[" + std::to_string(readers.size()) + "]");
  return readers;
}

std::vector<Reader> Reader::objects(std::string_view key) {
  require(key);
  auto readers = objects_or_none(key);
  if (readers.empty()) fail(key, "must have at least one entry, got []");
  return readers;
}

std::vector<std::string> Reader::keys() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : object_->items()) names.push_back(name);
  return names;
}

void Reader::optional(std::initializer_list<std::string_view> keys) {
  for (const auto key : keys) known_.emplace(key);
}

void Reader::finish() const {
  for (const auto& [name, value] : object_->items()) {
    if (known_.contains(name)) continue;
    const std::string nearest = nearest_word(name, {known_.begin(), known_.end()});
    if (!nearest.empty()) fail(name, "unknown key, did you mean " + nearest + "?");
    fail(name, known_.empty() ? "unknown key, none is expected here"
                              : "unknown key, known are " + listed({known_.begin(), known_.end()}));
  }
}

}  // namespace grainlaw
