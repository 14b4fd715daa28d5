#include "grainlaw/dem/simd.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "grainlaw/dem/simd_targets.hpp"
#include "hwy/highway.h"

namespace grainlaw::dem {

std::string simd_target() {
  const std::int64_t here = hwy::SupportedTargets() & HWY_TARGETS;
  const std::int64_t best = here & -here;  // Highway gives better targets lower bits
  if (best == HWY_AVX3) return "avx512";
  if (best == HWY_SCALAR || best == HWY_EMU128) return "baseline";
  std::string name = hwy::TargetName(best);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

}  // namespace grainlaw::dem
