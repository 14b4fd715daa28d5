#include "grainlaw/element/json_difference.hpp"

#include <algorithm>

namespace grainlaw {

std::string first_difference(const Json& there, const Json& here, const std::string& key) {
  if (there == here) return "";
  if (there.is_object() && here.is_object()) {
    for (const auto& [name, value] : there.items()) {
      const std::string inner = key.empty() ? name : key + "." + name;
      if (!here.contains(name)) return inner + ": there, not here";
      if (const auto text = first_difference(value, here.at(name), inner); !text.empty()) return text;
    }
    for (const auto& [name, value] : here.items())
      if (!there.contains(name)) return (key.empty() ? name : key + "." + name) + ": here, not there";
    return "";  // only the order of keys differs
  }
  if (there.is_array() && here.is_array()) {
    for (std::size_t i = 0; i < std::min(there.size(), here.size()); ++i)
      if (const auto text = first_difference(there[i], here[i], key + "[" + std::to_string(i) + "]");
          !text.empty())
        return text;
    if (there.size() == here.size()) return "";
    return key + ": " + std::to_string(there.size()) + " entries there, " + std::to_string(here.size()) +
           " here";
  }
  return key + ": " + there.dump() + " there, " + here.dump() + " here";
}

}  // namespace grainlaw
