// What observers say of grains, and the contacts that brute force finds.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "grainlaw/dem/observe/observers.hpp"

namespace grainlaw::dem::test {

using observe::Observers;

inline Material elastic() {
  Material m;
  m.gamma = 0;
  return m;
}

/// A path that shears in D2: x extends, y compresses.
inline SignConvention d2_signs() {
  Leg leg{};
  leg.mode = Mode::d2;
  leg.strain = {-0.1, 0.1, 0};
  return SignConvention({leg});
}

/// What `observers` say of grains, by column; nothing is measured for them but what they say they read.
inline std::map<std::string, double> see(Observers& observers, const Material& m, const Dynamics& dynamics) {
  const auto values = observers.observe(dynamics, dynamics.velocities(), dynamics.measure(observers.reads()),
                                        m, d2_signs(), 0, 0);
  EXPECT_EQ(values.size(), observers.columns().size());
  std::map<std::string, double> by_column;
  for (std::size_t k = 0; k < values.size(); ++k) by_column[observers.columns()[k]] = values[k];
  return by_column;
}

inline std::map<std::string, double> see(Observers& observers, const Material& m, const State& state) {
  return see(observers, m, Dynamics(m, state));
}

inline std::map<std::string, double> see(const Material& m, const State& state) {
  Observers all(observe::names());
  return see(all, m, state);
}

/// A contact, found by trying images up to two edges H away: of i with the image of j moved by `image`.
struct Met {
  std::size_t i, j;
  std::array<int, 3> image;
  Vec3 branch;
  double overlap;
};

inline std::vector<Met> contacts_of(const State& state) {
  std::vector<Met> list;
  const double furthest = 2 * *std::max_element(state.radius.begin(), state.radius.end());
  for (int n = 0; n < 125; ++n) {
    const std::array<int, 3> image{n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2};
    const Vec3 away = state.box * Vec3{1.0 * image[0], 1.0 * image[1], 1.0 * image[2]};
    for (std::size_t i = 0; i < state.count(); ++i) {
      const auto& [x, y, z] = state.position[i];
      for (std::size_t j = i + 1; j < state.count(); ++j) {
        const auto& other = state.position[j];
        const double dx = x - other[0] - away[0];
        if (std::abs(dx) > furthest) continue;
        const Vec3 branch{dx, y - other[1] - away[1], z - other[2] - away[2]};
        const double overlap = state.radius[i] + state.radius[j] - norm(branch);
        if (overlap >= 0) list.push_back({i, j, image, branch, overlap});
      }
    }
  }
  return list;
}

}  // namespace grainlaw::dem::test
