#include "grainlaw/apps/arguments.hpp"

#include <charconv>
#include <system_error>

#include "grainlaw/element/error.hpp"

namespace grainlaw::apps {

namespace {

/// Reads all of `text` as a T; false if any of it is something else.
template <class T>
bool parse(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

}  // namespace

double read_number(const std::string& option, const std::string& text, const Range& range) {
  double value = 0;
  if (!parse(text, value) || !range.contains(value))
    throw Error("", option, "must be a number " + range.text() + ", got " + text);
  return value;
}

long read_whole_number(const std::string& option, const std::string& text, long low, long high) {
  long value = 0;
  if (!parse(text, value) || value < low || value > high)
    throw Error("", option,
                "must be a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
                    ", got " + text);
  return value;
}

void check_output(const std::string& option, const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs) {
  namespace fs = std::filesystem;
  std::error_code code;
  const fs::path folder = fs::absolute(output).parent_path();
  if (!fs::is_directory(folder, code))
    throw Error("", option, "must lie in a directory that exists, got " + output.string());
  if (fs::is_directory(output, code))
    throw Error("", option, "must be a file, but " + output.string() + " is a directory");
  for (const fs::path& input : inputs)
    if (fs::equivalent(output, input, code))
      throw Error("", option, "must not be " + input.string() + ", which this command reads");
}

}  // namespace grainlaw::apps
