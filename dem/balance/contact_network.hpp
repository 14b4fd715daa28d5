// The contacts of a packing as a network: who touches whom, along which normal, with what elastic force and
// stiffness. What minimisers and the stiffness matrix are built from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"

namespace grainlaw::dem {

/// Entry c of every vector belongs to the same contact, in the order of the list of pairs. The vectors may be
/// longer than `count`: they are kept from one build to the next, so that building allocates only where
/// contacts are more than ever before.
struct ContactNetwork {
  struct Pair {
    std::uint32_t i, j;
  };
  std::size_t count = 0;
  std::vector<Pair> pairs;
  Quads normal;                   ///< from j to i | distance of the centres, mm
  std::vector<double> force;      ///< elastic, repulsive where positive, ug mm/us^2
  std::vector<double> stiffness;  ///< d(force)/d(overlap), ug/us^2
  double energy = 0;              ///< elastic, ug mm^2/us^2
  double largest_overlap = 0;     ///< mm

  /// Takes the contacts (overlap >= 0) of the places as they are, and fills grains.force with the net elastic
  /// forces.
  void build(const ContactLaw& law, const Pairs& list, const Cell& cell, Grains& grains);
};

}  // namespace grainlaw::dem
