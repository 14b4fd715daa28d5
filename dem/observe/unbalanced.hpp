// How far the grains are from balance.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// The mean size of the net contact force on a grain, over grains with contacts, over the mean size of the
/// force of a contact.
struct Unbalanced {
  static constexpr std::string_view name = "unbalanced";
  static constexpr std::array<std::string_view, 1> columns{"unbalanced"};
  static constexpr std::size_t grain_bytes = sizeof(Vec3);
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  std::array<double, 1> values(const View& view) const;
};

}  // namespace grainlaw::dem::observe
