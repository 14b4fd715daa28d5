// The other definition of fabric, in which every contact counts the same.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// F0 = (1/Nc) sum_c n (x) n, of trace 1, and its signed deviator.
struct ContactFabric {
  static constexpr std::string_view name = "contact_fabric";
  static constexpr std::array<std::string_view, 7> columns{"F0_dev", "F0xx", "F0yy", "F0zz",
                                                           "F0yz",   "F0xz", "F0xy"};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  std::array<double, 7> values(const View& view) const;
};

}  // namespace grainlaw::dem::observe
