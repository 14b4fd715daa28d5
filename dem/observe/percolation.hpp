// The network of strong forces: in which directions it runs through the periodic box (section 5.F).
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// Of the contacts with f >= 2.2 <f>, <f> the mean over all contacts, the largest cluster by grains. x, y, z
/// are the edges of H as the path has deformed them, which are never chosen anew: in an orthorhombic box the
/// axes; in simple shear the first and the third still are, and the second is what began as y and leans by
/// gamma. The cluster percolates along an edge, percolates_* = 1, where it connects a grain to an image of
/// that grain displaced by this edge (and perhaps by others, too), that is, to one beyond the two faces of
/// the other edges: in simple shear, for y and z, exactly one displaced along that axis. xi_* is 1 there,
/// elsewhere the extent of its centres, unwrapped, in parts of that edge, at most 1: it is 1 as well where a
/// cluster reaches as far as the box and misses itself. `percolating`: the sum of percolates_*, 0 unjammed, 1
/// or 2 fragile, 3 jammed.
struct Percolation {
  static constexpr std::string_view name = "percolation";
  static constexpr std::array<std::string_view, 7> columns{
      "xi_x", "xi_y", "xi_z", "percolating", "percolates_x", "percolates_y", "percolates_z"};
  static constexpr std::size_t later_columns = 3;  ///< an earlier version wrote the first four alone
  static constexpr std::size_t grain_bytes = 72;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  static constexpr double strong = 2.2;
  std::array<double, 7> values(const View& view) const;
};

}  // namespace grainlaw::dem::observe
