// Where two JSON values differ, in words for their reader.
#pragma once

#include <string>

#include "grainlaw/element/json.hpp"

namespace grainlaw {

/// The first difference ("rows: 100 there, 200 here"), below `key`; the order of keys does not count. Empty
/// if they are the same.
std::string first_difference(const Json& there, const Json& here, const std::string& key = "");

}  // namespace grainlaw
