// Which grainlaw this is: the version of the project and the commit it was built from.
#pragma once

#include <string>

namespace grainlaw {

/// "0.1.0"
std::string version();
/// Short hash of the commit, with "-dirty" where git was there to see that files had been changed; "unknown"
/// without a git history.
std::string commit();

}  // namespace grainlaw
