// Documents that differ from good ones in one place, and what the readers say of each: check_schemas.py asks
// the schemas the same.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"

namespace grainlaw::tests {

/// Throws Error for a document it refuses.
using Read = std::function<void(Reader)>;

/// For every value in the good documents: it left out, replaced by a value of each kind; in every object: a
/// key that nobody knows. A change that two documents share is made once. Returns
/// {"bases": [...], "mutants": [{"base": i, "set" or "remove": as in documents/, "said": "" where
/// accepted}]}.
Json mutants(const std::vector<Json>& good, const std::string& file, const Read& read);

}  // namespace grainlaw::tests
