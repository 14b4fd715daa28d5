// The stress that grains carry by their motion; the standard columns hold the static one alone.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// (1/V) sum m v (x) v of the fluctuation velocity, over k*.
struct KineticStress {
  static constexpr std::string_view name = "kinetic_stress";
  static constexpr std::array<std::string_view, 6> columns{"kxx", "kyy", "kzz", "kyz", "kxz", "kxy"};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = false;
  static constexpr Wanted reads{.kinetic_stress = true};
  std::array<double, 6> values(const View& view) const {
    return times(1 / view.material.stress_unit(), view.measured.kinetic_stress);
  }
};

}  // namespace grainlaw::dem::observe
