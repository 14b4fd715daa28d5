// Arguments of the command line, read with the same care as values in files.
#pragma once

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

}  // namespace grainlaw::apps
