// Where the program finds the files it comes with.
#pragma once

#include <filesystem>
#include <string>

namespace grainlaw::apps {

/// A file of data/ ("campaigns/quick.json"): in ./data, in the data/ of the source tree that the program was
/// built in, or where it was installed. Throws Error naming ./data/... if it is nowhere.
std::filesystem::path find_data(const std::string& name);

}  // namespace grainlaw::apps
