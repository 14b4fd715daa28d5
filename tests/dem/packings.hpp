// Small packings for tests, and the contacts of a state by brute force.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/dem/step/dynamics.hpp"

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
  state.box = factor * state.box;
  for (auto& x : state.position)
    for (double& component : x) component *= factor;
  return state;
}

/// Numbers in [-size, size).
inline Mat3 random_matrix(Random& random, double size) {
  Mat3 a;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) a(r, c) = size * (2 * random.uniform() - 1);
  return a;
}

/// By `angle` about this axis (Rodrigues).
inline Mat3 rotation(const Vec3& axis, double angle) {
  const double n = norm(axis), x = axis[0] / n, y = axis[1] / n, z = axis[2] / n;
  const Mat3 cross{{0, -z, y}, {z, 0, -x}, {-y, x, 0}};
  return Mat3::identity() + std::sin(angle) * cross + (1 - std::cos(angle)) * (cross * cross);
}

/// The packing in a frame turned so; also after any other homogeneous deformation.
inline State turned(State state, const Mat3& turn) {
  state.box = turn * state.box;
  for (auto& x : state.position) x = turn * x;
  for (auto& v : state.velocity) v = turn * v;
  return state;
}

inline Sym6 turned(const Sym6& q, const Mat3& turn) {
  const Mat3 a = turn * matrix_of(q) * transposed(turn);
  return {a(0, 0), a(1, 1), a(2, 2), a(1, 2), a(0, 2), a(0, 1)};
}

/// exp(G t): the deformation of a flow with a constant velocity gradient.
inline Mat3 deformation(const Mat3& gradient, double t) {
  Mat3 sum = Mat3::identity(), term = Mat3::identity();
  for (int k = 1; k < 30; ++k) {
    term = t / k * (gradient * term);
    sum = sum + term;
  }
  return sum;
}

/// 0 ... count - 1 in random order.
inline std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  Random(seed).shuffle(order);
  return order;
}

/// Grain `order[i]` becomes grain i.
inline State permuted(const State& state, const std::vector<std::size_t>& order) {
  State other = state;
  for (std::size_t i = 0; i < order.size(); ++i) {
    other.position[i] = state.position[order[i]];
    other.velocity[i] = state.velocity[order[i]];
    other.radius[i] = state.radius[order[i]];
  }
  return other;
}

/// Overlap and the two grains, of every contact through every image, sorted.
using ContactList = std::vector<std::tuple<std::uint32_t, std::uint32_t, double>>;

/// `most` edges of the box away at most.
inline ContactList brute_force(const State& state, int most = 2) {
  ContactList list;
  for (std::uint32_t i = 0; i < state.count(); ++i)
    for (std::uint32_t j = i + 1; j < state.count(); ++j)
      for (int a = -most; a <= most; ++a)
        for (int b = -most; b <= most; ++b)
          for (int c = -most; c <= most; ++c) {
            Vec3 d;
            for (std::size_t k = 0; k < 3; ++k)
              d[k] = state.position[i][k] - state.position[j][k] - a * state.box(k, 0) - b * state.box(k, 1) -
                     c * state.box(k, 2);
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
  state.box = Mat3::diagonal({20, 20, 20});
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
  state.box = Mat3::diagonal({2 * a, 2 * a, 2 * a});
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
