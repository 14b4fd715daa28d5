// Small packings for tests, and the contacts of a state by brute force.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <vector>

#include "grainlaw/dem/cell.hpp"
#include "grainlaw/dem/dynamics.hpp"
#include "grainlaw/dem/preparation.hpp"
#include "grainlaw/dem/random.hpp"
#include "grainlaw/dem/state.hpp"

namespace grainlaw::dem::test {

/// A random gas squeezed affinely to volume fraction nu: overlapping, out of balance, no two contacts alike.
inline State squeezed(const Material& material, std::int64_t count, std::uint64_t seed, double nu,
                      double speed = 0.02) {
  NewPacking packing;
  packing.count = count;
  packing.seed = seed;
  packing.nu_gas = 0.4;
  packing.speed = speed;
  State state = random_gas(material, packing);
  const double factor = std::cbrt(state.volume_fraction() / nu);
  for (double& edge : state.box) edge *= factor;
  for (auto& x : state.position)
    for (double& component : x) component *= factor;
  return state;
}

/// Overlap and the two grains, of every contact through every image, sorted.
using ContactList = std::vector<std::tuple<std::uint32_t, std::uint32_t, double>>;

inline ContactList brute_force(const State& state) {
  ContactList list;
  for (std::uint32_t i = 0; i < state.count(); ++i)
    for (std::uint32_t j = i + 1; j < state.count(); ++j)
      for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b)
          for (int c = -2; c <= 2; ++c) {
            const Vec3 d{state.position[i][0] - state.position[j][0] - a * state.box[0],
                         state.position[i][1] - state.position[j][1] - b * state.box[1],
                         state.position[i][2] - state.position[j][2] - c * state.box[2]};
            const double overlap = state.radius[i] + state.radius[j] - norm(d);
            if (overlap >= 0) list.emplace_back(i, j, overlap);
          }
  std::sort(list.begin(), list.end());
  return list;
}

inline ContactList listed(const Dynamics& dynamics) {
  ContactList list;
  const Grains& grains = dynamics.grains();
  for_each_contact(dynamics.neighbours().pairs(), grains, dynamics.cell(), [&](const Contact& c) {
    const auto [low, high] = std::minmax(grains.id[c.i], grains.id[c.j]);
    list.emplace_back(low, high, c.overlap);
  });
  std::sort(list.begin(), list.end());
  return list;
}

/// Two grains on a diagonal of a large box, just touching (they overlap by 1e-12, or rounding
/// would decide), approaching each other at relative velocity
/// `closing`.
inline State two_grains(double r1, double r2, double closing) {
  const double s = 1 / std::sqrt(3.0);
  State state;
  state.box = {20, 20, 20};
  state.radius = {r1, r2};
  const double half = 0.5 * (r1 + r2 - 1e-12) * s, v = 0.5 * closing * s;
  state.position = {{10 - half, 10 - half, 10 - half}, {10 + half, 10 + half, 10 + half}};
  state.velocity = {{v, v, v}, {-v, -v, -v}};
  return state;
}

/// 32 unit grains on a face-centred cubic lattice, twelve contacts of overlap 2 (1 - tightness) each, with
/// random velocities.
inline State crystal(double tightness, double speed) {
  const double a = 2 * std::numbers::sqrt2 * tightness;
  State state;
  state.box = {2 * a, 2 * a, 2 * a};
  Random random(9);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k)
        if ((i + j + k) % 2 == 0) {
          state.position.push_back({i * a / 2, j * a / 2, k * a / 2});
          state.velocity.push_back(
              {speed * random.normal(), speed * random.normal(), speed * random.normal()});
          state.radius.push_back(1);
        }
  return state;
}

}  // namespace grainlaw::dem::test
