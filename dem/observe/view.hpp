// What an observer sees of a packing: the state, the standard measurement, and the network of its contacts.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "grainlaw/dem/dynamics.hpp"
#include "grainlaw/dem/measure.hpp"
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

  static Network gather(const Dynamics& dynamics, const std::vector<Quad>& velocity);
};

struct View {
  const Material& material;
  const Dynamics& dynamics;
  const std::vector<Quad>& velocity;  ///< fluctuation velocity, in the order of the grains
  const Measurement& measured;
  const SignConvention& sign;
  std::size_t segment;
  const Network& network;  ///< empty unless an observer asked for walks the contacts

  const Grains& grains() const { return dynamics.grains(); }
  const Cell& cell() const { return dynamics.cell(); }
};

/// sum += factor a (x) a
inline void add_dyad(Sym6& sum, double factor, const Vec3& a) {
  sum[0] += factor * a[0] * a[0];
  sum[1] += factor * a[1] * a[1];
  sum[2] += factor * a[2] * a[2];
  sum[3] += factor * a[1] * a[2];
  sum[4] += factor * a[0] * a[2];
  sum[5] += factor * a[0] * a[1];
}

inline Sym6 times(double factor, Sym6 q) {
  for (double& component : q) component *= factor;
  return q;
}

}  // namespace grainlaw::dem::observe
