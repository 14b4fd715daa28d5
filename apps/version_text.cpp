#include "grainlaw/apps/version_text.hpp"

#include <fmt/format.h>

#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/element/version.hpp"
#include "grainlaw_dependencies.hpp"

namespace grainlaw::apps {

std::string version_text() {
  std::string text = fmt::format("grainlaw {}\n  commit {}\n  compiler {}\n  simd {}\n", version(), commit(),
                                 dem::compiler_name(), dem::simd_target());
  for (const auto& [name, number] : dependencies) text += fmt::format("  {} {}\n", name, number);
  return text;
}

}  // namespace grainlaw::apps
