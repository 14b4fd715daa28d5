// What an observer sees of a packing: the state, what was measured of it, and the network of its contacts.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "grainlaw/dem/numbers/dyad.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/step/measure.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem::observe {

inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
/// Grains with fewer contacts are rattlers.
inline constexpr std::uint32_t bearing_contacts = 4;

/// A contact with its force.
struct Touch {
  std::uint32_t i, j;
  Vec3 branch;      ///< from the centre of j (its image) to the centre of i, mm
  double distance;  ///< mm
  double overlap;   ///< mm, >= 0
  double force;     ///< ug mm/us^2, elastic and viscous; repulsive where positive
};

/// Every contact, gathered once for all observers that walk them.
struct Network {
  std::vector<Touch> contacts;
  std::vector<std::uint32_t> contacts_of;  ///< per grain
  double mean_force = undefined;           ///< over all contacts; undefined without any
  double mean_overlap = undefined;

  /// Replaces what was gathered before, in the same memory.
  void gather(const Dynamics& dynamics, const Quads& velocity);
};

struct View {
  const Material& material;
  const Dynamics& dynamics;
  const Quads& velocity;        ///< fluctuation velocity, in the order of the grains; empty where no contact
                                ///< is walked and none of what is measured needs it
  const Measurement& measured;  ///< nu, and what the observers read
  const SignConvention& sign;
  std::size_t segment;
  const Network& network;  ///< empty unless an observer asked for walks the contacts

  const Grains& grains() const { return dynamics.grains(); }
  const Cell& cell() const { return dynamics.cell(); }
};

}  // namespace grainlaw::dem::observe
