// Words out of a list: which one was meant, and lists of them in JSON.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "grainlaw/element/json.hpp"

namespace grainlaw {

/// The word that `name` is probably meant to be; empty if none is near.
std::string nearest_word(std::string_view name, const std::vector<std::string>& words);

/// What to say of a word that is not allowed; empty: which one was probably meant.
using HintOnWord = std::function<std::string(const std::string&)>;

/// A list of different words out of `allowed`, perhaps empty; `fallback` where the key is missing. Throws
/// Error that lists what is allowed, and ends with a hint.
std::vector<std::string> read_words(Reader& reader, std::string_view key,
                                    const std::vector<std::string>& allowed,
                                    const std::vector<std::string>& fallback, const HintOnWord& hint = {});

}  // namespace grainlaw
