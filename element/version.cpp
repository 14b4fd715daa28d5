#include "grainlaw/element/version.hpp"

#include "grainlaw_build_info.hpp"

namespace grainlaw {

std::string version() { return build_info::version; }

std::string commit() { return build_info::commit; }

std::string build_options() {
  const std::string changes = build_info::changes;
  return GRAINLAW_BUILD_OPTIONS + (changes.empty() ? "" : ", changes " + changes);
}

}  // namespace grainlaw
