// Plain text with names of the files in it ("nu_c(ISO) > nu_c(D2)") as readable mathematics.
#pragma once

#include <string_view>

#include "grainlaw/apps/report/html.hpp"

namespace grainlaw::report {

/// The text, escaped, with every known name as its symbol, "x_i" as a letter with an index, "^x" as a
/// superscript, and " - ", ">=", "<=" as the signs they stand for. Names that mean different things in
/// different groups are taken from `group`, else from the isotropic laws.
Markup prose(std::string_view plain, std::string_view group = "");

}  // namespace grainlaw::report
