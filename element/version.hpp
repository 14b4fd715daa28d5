// Which grainlaw this is: the version of the project, the commit it was built from, and how.
#pragma once

#include <string>

namespace grainlaw {

/// "0.1.0"
std::string version();
/// Short hash of the commit, with "-dirty" where git was there to see that files had been changed; "unknown"
/// without a git history.
std::string commit();
/// The options that the compiler was given, "Release -O3 -DNDEBUG"; with a hash of what had been changed
/// in the sources since the commit, where git was there to see it. Two builds of one commit may round
/// differently.
std::string build_options();

}  // namespace grainlaw
