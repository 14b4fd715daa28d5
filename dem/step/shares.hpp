// How several threads share one step, so that its result does not depend on how many they are.
#pragma once

#include <cstdint>
#include <vector>

#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/pairs.hpp"

namespace grainlaw::dem {

/// What one thread does: a run of grains, and all the forces on them. Pairs with a grain of another share are
/// computed on both sides, each for its own; so no two threads add to the same grain, and each grain's forces
/// are added in the order in which one thread alone would add them.
struct Share {
  std::uint32_t first = 0, last = 0;            ///< its grains
  std::size_t first_group = 0, last_group = 0;  ///< their groups in the list
  CrossingPairs halo;                           ///< pairs of earlier groups with partners in here
  CrossingPairs crossing;                       ///< those pairs that have a grain in here
  Quads force;                                  ///< of all grains, but right only for its own
};

/// Share `index` of `shares`, of `grains` grains, for loops that compute so many pairs at a time as `lanes`
/// (4 or 8): in what order they add forces depends on it.
void deal(const Pairs& pairs, std::size_t grains, std::size_t index, std::size_t shares, std::size_t lanes,
          Share& share);

}  // namespace grainlaw::dem
