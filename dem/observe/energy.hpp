// Kinetic and elastic energy per grain.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// E_k of the fluctuation velocity and E_p of the contacts, each over N k <r>^2.
struct Energy {
  static constexpr std::string_view name = "energy";
  static constexpr std::array<std::string_view, 2> columns{"E_k", "E_p"};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = false;
  static constexpr Wanted reads{.energies = true};
  std::array<double, 2> values(const View& view) const {
    const double per_unit = 1 / (static_cast<double>(view.grains().count()) * view.material.k *
                                 view.material.r_mean * view.material.r_mean);
    return {view.measured.kinetic * per_unit, view.measured.elastic * per_unit};
  }
};

}  // namespace grainlaw::dem::observe
