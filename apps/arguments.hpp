// Arguments of the command line, read with the same care as values in files.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"

namespace grainlaw::apps {

/// The number in `text`. Throws Error naming the option, the value and what would be right.
double read_number(const std::string& option, const std::string& text, const Range& range);
long read_whole_number(const std::string& option, const std::string& text, long low, long high);

/// Throws Error where a command would write over what it reads, or into a folder that does not exist.
void check_output(const std::string& option, const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs);

/// A word as a shell reads it back.
std::string quoted(const std::string& word);

/// How a simulation is run; nothing of it is part of its scene.
struct RunArguments {
  std::string simd, checkpoint;
  bool resume = false;

  /// Declares --simd, --checkpoint and --resume.
  void add_to(CLI::App& command, const std::string& resume_help);
  /// Makes the kernels run on what --simd says. Throws Error if the machine cannot.
  void force_simd() const;
  double checkpoint_every() const;  ///< s
  /// What of it goes into the command that goes on after an interruption, with a blank before each word.
  std::string words() const;
};

}  // namespace grainlaw::apps
