// What --version prints: which grainlaw this is, and what it is built with.
#pragma once

#include <string>

namespace grainlaw::apps {

std::string version_text();

}  // namespace grainlaw::apps
