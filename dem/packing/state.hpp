// The state of a packing as it is exchanged: between engine and snapshot file, and between one test and the
// next. The engine keeps its own layout for speed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/numbers/matrix.hpp"

namespace grainlaw::dem {

/// N grains in a periodic box. All three vectors have N entries; entry i of each belongs to the same grain.
struct State {
  Mat3 box;  ///< edges in its columns, mm; determinant > 0. Diagonal: an orthorhombic box
  double time_us = 0;
  std::uint64_t step = 0;
  std::vector<std::array<double, 3>>
      position;  ///< mm; may lie outside the box: a periodic image counts as the grain
  /// mm/us; the fluctuation, that is, the velocity beyond the affine motion of the box.
  std::vector<std::array<double, 3>> velocity;
  std::vector<double> radius;  ///< mm; > 0

  std::size_t count() const { return radius.size(); }
  /// nu = sum of grain volumes over the volume of the box (overlaps are not subtracted).
  double volume_fraction() const;

  bool operator==(const State&) const = default;
};

}  // namespace grainlaw::dem
