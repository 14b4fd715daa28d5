// The grains as the engine holds them: one 32-byte line per grain and field, sorted in space.
#pragma once

#include <cstdint>
#include <vector>

#include "grainlaw/dem/numbers/vec.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/state.hpp"

namespace grainlaw::dem {

/// Entry i of every vector belongs to the same grain; `id` tells which one of the State it is. Positions are
/// wrapped into the box only when the neighbour list sorts the grains, and move freely in between, so that
/// the image by which two neighbours meet stays the same.
struct Grains {
  Quads place;         ///< x, y, z | radius, mm
  Quads motion;        ///< fluctuation velocity that the contact forces see, mm/us
  Quads half;          ///< fluctuation velocity half a step before, mm/us
  Quads force;         ///< contact force, ug mm/us^2
  Quads acceleration;  ///< of the step before, mm/us^2 | 1/mass, 1/ug
  std::vector<std::uint32_t> id;

  Grains() = default;
  /// `rho` in ug/mm^3.
  Grains(const State& state, double rho);

  std::size_t count() const { return place.size(); }
  double largest_radius() const;
  double smallest_radius() const;
  /// What is exchanged, in the order of the State they came from; `velocity` in the order here. Positions are
  /// wrapped into the box; time and step are left at 0.
  State state(const Cell& cell, const Quads& velocity) const;
  /// Grain `order[i]` becomes grain i.
  void reorder(const std::vector<std::uint32_t>& order);

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.place, self.motion, self.half, self.force, self.acceleration, self.id);
  }
};

}  // namespace grainlaw::dem
