// The tables of documents to accept and to refuse, in tests/data/documents.
#pragma once

#include <filesystem>

#include "grainlaw/element/json.hpp"

namespace grainlaw::tests {

/// The base document of a table with the changes of a case, JSON Pointers to set and to remove.
inline Json edited(Json document, const Json& change) {
  if (change.contains("remove"))
    for (const auto& pointer : change["remove"]) {
      const Json::json_pointer at(pointer.get<std::string>());
      document.at(at.parent_pointer()).erase(at.back());
    }
  if (change.contains("set"))
    for (const auto& [pointer, value] : change["set"].items()) document[Json::json_pointer(pointer)] = value;
  return document;
}

/// The base of a table: written there, or an example below data/.
inline Json base_of(const Json& table, const std::filesystem::path& data) {
  return table["base"].is_string() ? load_json(data / table["base"].get<std::string>()) : table["base"];
}

}  // namespace grainlaw::tests
