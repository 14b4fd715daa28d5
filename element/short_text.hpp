// Numbers in sentences: as many digits as a reader needs.
#pragma once

#include <string>

namespace grainlaw {

/// `x` to so many significant digits, without trailing zeros: "0.0312", "2e-05". To read back to the last bit
/// there is to_text (error.hpp).
std::string short_text(double x, int digits);

}  // namespace grainlaw
