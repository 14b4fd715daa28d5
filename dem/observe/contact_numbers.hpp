// Numbers of contacts beside the standard C, C* and f_NR (section 2.3.1).
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// C^r = M/N; C*_p = (M - 2 (M1 + M2 + M3))/N4, with M_n the contacts of the grains that have n: a contact
/// with a rattler is left out for both; phi_r = 1 - N4/N.
struct ContactNumbers {
  static constexpr std::string_view name = "contacts";
  static constexpr std::array<std::string_view, 3> columns{"C_r", "C_star_p", "phi_r"};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  std::array<double, 3> values(const View& view) const;
};

}  // namespace grainlaw::dem::observe
