// Lattices of unit grains, whose stiffness has a closed form.
#pragma once

#include <cmath>

#include "grainlaw/dem/numbers/matrix.hpp"
#include "grainlaw/dem/packing/state.hpp"

namespace grainlaw::dem::test {

/// At a distance d, d < 2, in cubes of edge a = sqrt(2) d.
inline State fcc(double d, int cubes) {
  State state;
  const double a = std::sqrt(2.0) * d;
  state.box = a * cubes * Mat3::identity();
  for (int x = 0; x < cubes; ++x)
    for (int y = 0; y < cubes; ++y)
      for (int z = 0; z < cubes; ++z)
        for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0}, Vec3{0.5, 0, 0.5}, Vec3{0, 0.5, 0.5}})
          state.position.push_back({a * (x + p[0]), a * (y + p[1]), a * (z + p[2])});
  state.velocity.resize(state.position.size());
  state.radius.assign(state.position.size(), 1.0);
  return state;
}

/// `edge` grains along each axis, at a distance d: d = 2 touches without a force, to the last bit.
inline State simple_cubic(double d, int edge) {
  State state;
  state.box = d * edge * Mat3::identity();
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z) state.position.push_back({d * x, d * y, d * z});
  state.velocity.resize(state.position.size());
  state.radius.assign(state.position.size(), 1.0);
  return state;
}

}  // namespace grainlaw::dem::test
