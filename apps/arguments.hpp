// Arguments of the command line that are numbers, read with the same care as those in files.
#pragma once

#include <string>

#include "grainlaw/element/json.hpp"

namespace grainlaw::apps {

/// The number in `text`. Throws Error naming the option, the value and what would be right.
double read_number(const std::string& option, const std::string& text, const Range& range);
long read_whole_number(const std::string& option, const std::string& text, long low, long high);

}  // namespace grainlaw::apps
