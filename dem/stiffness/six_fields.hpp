// Six fields of one vector per grain, side by side, so that one sweep over a network serves six systems.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grainlaw::dem {

/// Component c of field a on a grain stands in q[c][a]; the last two of eight are padding and stay 0. Three
/// lines of 64 bytes.
struct alignas(64) SixVectors {
  std::array<std::array<double, 8>, 3> q{};
};
using SixFields = std::vector<SixVectors>;

/// A number for each of the six fields, and two that stand for the padding.
using SixNumbers = std::array<double, 8>;

}  // namespace grainlaw::dem
