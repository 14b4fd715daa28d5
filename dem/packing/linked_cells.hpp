// A grid of cells over the box: sorts grains in space and lists the pairs within a range, through all images.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/packing/cell.hpp"

namespace grainlaw::dem {

/// All pairs within a range, grain by grain.
struct NearPairs {
  std::vector<std::uint32_t> begin{0};  ///< grain i's: partner[begin[i]] ... partner[begin[i+1]-1]
  std::vector<std::uint32_t> partner;
  struct Crossing {
    std::uint32_t i, j, image;
  };
  std::uint32_t reach = 0;         ///< partner - i is at most so much
  std::vector<Crossing> crossing;  ///< those that meet through a face of the box

  std::size_t count() const { return partner.size() + crossing.size(); }
};

class LinkedCells {
 public:
  /// `place` must lie within the (reduced) box, whose faces must be at least `range` apart: the grid's cells
  /// are cut along the box's edges and their faces are as far apart as that, so that two grains in range lie
  /// in neighbouring ones. A grid may be one or two cells wide, because each of the 27 neighbours of a cell
  /// is looked up together with the image it belongs to.
  LinkedCells(const Quads& place, const Cell& cell, double range);

  /// Grains cell by cell (z fastest), in each cell as they came.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// All pairs closer than r_i + r_j + skin <= range, each once; `place` in the order of order().
  /// Throws Error if two grains lie at the same point.
  void list_pairs(const Quads& place, const Cell& cell, double skin, NearPairs& pairs) const;

 private:
  std::array<int, 3> count_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> begin_;  ///< first grain of each cell, in the new order
};

}  // namespace grainlaw::dem
