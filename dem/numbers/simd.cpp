#include "grainlaw/dem/numbers/simd.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "grainlaw/dem/numbers/simd_targets.hpp"
#include "grainlaw/element/error.hpp"
#include "hwy/highway.h"

namespace grainlaw::dem {

namespace {

std::string name_of(std::int64_t target) {
  if (target == HWY_AVX3) return "avx512";
  if (target == HWY_SCALAR || target == HWY_EMU128) return "baseline";
  std::string name = hwy::TargetName(target);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

/// Those that the kernels are compiled for and that may be chosen now; Highway gives better ones lower bits.
std::vector<std::int64_t> open_targets() {
  std::vector<std::int64_t> list;
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1)
    list.push_back(left & -left);
  return list;
}

/// Those of the machine, whatever is forced.
std::vector<std::int64_t> targets_of_machine() {
  const std::int64_t chosen = hwy::SupportedTargets();
  hwy::SetSupportedTargetsForTest(0);
  const std::vector<std::int64_t> all = open_targets();
  hwy::SetSupportedTargetsForTest(chosen);
  return all;
}

}  // namespace

std::string simd_target() { return name_of(open_targets().front()); }

std::vector<std::string> simd_targets_here() {
  std::vector<std::string> names;
  for (const std::int64_t target : targets_of_machine()) names.push_back(name_of(target));
  return names;
}

void force_simd_target(const std::string& name) {
  std::string known;
  for (const std::int64_t target : targets_of_machine()) {
    if (name_of(target) == name) return hwy::SetSupportedTargetsForTest(target);
    known += (known.empty() ? "" : ", ") + name_of(target);
  }
  throw Error("", "--simd", "must be one that this machine can run (" + known + "), got \"" + name + "\"");
}

}  // namespace grainlaw::dem
