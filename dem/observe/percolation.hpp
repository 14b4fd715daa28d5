// The network of strong forces: in which directions it runs through the periodic box (section 5.F).
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// Of the contacts with f >= 2.2 <f>, <f> the mean over all contacts, the largest cluster by grains. It
/// percolates along an axis where it connects a grain to an image of that grain displaced along this axis; xi
/// is 1 there, elsewhere the extent of its centres, unwrapped, over the edge of the box, at most 1.
/// `percolating`: the number of axes, 0 unjammed, 1 or 2 fragile, 3 jammed.
struct Percolation {
  static constexpr std::string_view name = "percolation";
  static constexpr std::array<std::string_view, 4> columns{"xi_x", "xi_y", "xi_z", "percolating"};
  static constexpr std::size_t grain_bytes = 72;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  static constexpr double strong = 2.2;
  std::array<double, 4> values(const View& view) const;
};

}  // namespace grainlaw::dem::observe
