#include "grainlaw/apps/arguments.hpp"

#include <charconv>
#include <system_error>

#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/dem/run/watch.hpp"
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

std::string quoted(const std::string& word) {
  if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./+,:@%=") ==
      std::string::npos)
    return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

void RunArguments::add_to(CLI::App& command, const std::string& resume_help) {
  command.add_flag("--resume", resume, resume_help);
  command
      .add_option("--checkpoint", checkpoint,
                  "seconds from one checkpoint of a test to the next (default: 60)")
      ->type_name("SECONDS");
  command
      .add_option("--simd", simd,
                  "instruction set to run on: avx512, avx2 or baseline (default: the best of this machine)")
      ->type_name("NAME");
}

void RunArguments::force_simd() const {
  if (!simd.empty()) dem::force_simd_target(simd);
}

double RunArguments::checkpoint_every() const {
  return checkpoint.empty() ? dem::RunHooks{}.checkpoint_every
                            : read_number("--checkpoint", checkpoint, between(0, 1e9));
}

std::string RunArguments::words() const {
  return (checkpoint.empty() ? "" : " --checkpoint " + quoted(checkpoint)) +
         (simd.empty() ? "" : " --simd " + quoted(simd));
}

}  // namespace grainlaw::apps
