// Random numbers, radii and the initial gas.
#include "grainlaw/dem/scene/preparation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

TEST(Random, ReferenceSequence) {
  // xoshiro256** seeded by splitmix64(1): first numbers of the published C code.
  Random random(1);
  EXPECT_EQ(random.bits(), 12966619160104079557ull);
  EXPECT_EQ(random.bits(), 9600361134598540522ull);
  EXPECT_EQ(random.bits(), 10590380919521690900ull);
}

TEST(Random, Moments) {
  Random random(7);
  const int n = 200000;
  double u1 = 0, u2 = 0, g1 = 0, g2 = 0, g4 = 0;
  std::vector<int> faces(6);
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(), g = random.normal();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    u1 += u, u2 += u * u, g1 += g, g2 += g * g, g4 += g * g * g * g;
    ++faces[random.below(6)];
  }
  // five standard errors each
  EXPECT_NEAR(u1 / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(u2 / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
  EXPECT_NEAR(g1 / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(g2 / n, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(g4 / n, 3, 5 * std::sqrt(96.0 / n));
  for (const int count : faces) EXPECT_NEAR(count, n / 6.0, 5 * std::sqrt(n * 5.0 / 36));
}

TEST(SizeDistribution, MomentsOfTheUniformDistribution) {
  for (const double w : {1.0, 1.5, 3.0, 10.0}) {
    Material m;
    m.w = w;
    m.r_mean = 2;
    Random random(3);
    const auto radii = draw_radii(m, 1000, random);
    const double a = 4 / (w + 1), b = 4 * w / (w + 1);
    for (int p = 1; p <= 5; ++p) {
      double mean = 0;
      for (const double r : radii) mean += std::pow(r, p) / 1000;
      const double exact =
          w == 1 ? std::pow(2, p) : (std::pow(b, p + 1) - std::pow(a, p + 1)) / ((p + 1) * (b - a));
      EXPECT_NEAR(mean / exact, 1, p == 1 ? 1e-13 : 2e-6) << "w = " << w << ", moment " << p;
    }
    for (const double r : radii) {
      EXPECT_GE(r, a * (1 - 1e-14));
      EXPECT_LE(r, b * (1 + 1e-14));
    }
  }
}

TEST(SizeDistribution, OrderIsRandom) {
  // Rank and place are uncorrelated, to five standard errors.
  Random random(3);
  const auto radii = draw_radii(Material{}, 1000, random);
  double correlation = 0;
  for (std::size_t i = 0; i < 1000; ++i)
    correlation +=
        (radii[i] - 1) * (static_cast<double>(i) - 499.5) / (0.5 / std::sqrt(3) * 1000 / std::sqrt(12));
  EXPECT_LT(std::abs(correlation / 1000), 5 / std::sqrt(1000));
}

class Gas : public testing::TestWithParam<double> {};

TEST_P(Gas, HasNoOverlapNoMomentumAndTheSpeedAskedFor) {
  Material m;
  NewPacking packing;
  packing.nu_gas = GetParam();
  packing.speed = 0.05;
  const State gas = random_gas(m, packing);
  EXPECT_EQ(gas.count(), 1000u);
  EXPECT_NEAR(gas.volume_fraction(), packing.nu_gas, 1e-12);
  EXPECT_EQ(Dynamics(m, gas).measure().contacts, 0u);
  double squares = 0, heavy = 0;
  Vec3 momentum{};
  for (std::size_t i = 0; i < gas.count(); ++i) {
    const double mass = m.rho * sphere_volume(gas.radius[i]);
    heavy += mass;
    for (std::size_t c = 0; c < 3; ++c) {
      squares += gas.velocity[i][c] * gas.velocity[i][c];
      momentum[c] += mass * gas.velocity[i][c];
      EXPECT_GE(gas.position[i][c], 0);
      EXPECT_LT(gas.position[i][c], gas.box(c, c));
    }
  }
  EXPECT_NEAR(std::sqrt(squares / 1000), 0.05, 1e-12);
  EXPECT_LT(norm(momentum), 1e-12 * heavy);
}

INSTANTIATE_TEST_SUITE_P(Density, Gas, testing::Values(0.05, 0.3, 0.45));

TEST(Gas, DependsOnTheSeedAndOnNothingElse) {
  Material m;
  NewPacking packing;
  packing.count = 100;
  const State first = random_gas(m, packing), again = random_gas(m, packing);
  EXPECT_EQ(first, again);
  packing.seed = 2;
  const State other = random_gas(m, packing);
  EXPECT_NE(first.position[0][0], other.position[0][0]);
}

}  // namespace
}  // namespace grainlaw::dem
