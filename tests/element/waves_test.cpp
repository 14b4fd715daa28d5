// Wave speeds against closed forms; with prestress against the lattice sums of a crystal under pressure.
#include "grainlaw/element/waves.hpp"

#include <gtest/gtest.h>

#include "elastic_solids.hpp"

namespace grainlaw {
namespace {

TEST(Waves, IsotropicSolid) {
  const double bulk = 3, shear = 0.5, density = 2;
  const auto w = waves(test::isotropic(bulk, shear), {}, density, {1, 2, -3});
  EXPECT_NEAR(w[0].speed, std::sqrt(shear / density), 1e-14);
  EXPECT_NEAR(w[1].speed, std::sqrt(shear / density), 1e-14);
  EXPECT_NEAR(w[2].speed, std::sqrt((bulk + 4.0 / 3 * shear) / density), 1e-14);
  EXPECT_NEAR(std::abs(w[2].polarisation[0]), 1 / std::sqrt(14.0), 1e-12);
}

TEST(Waves, CubicSolidAlongItsDiagonals) {
  const double c11 = 5, c12 = 2, c44 = 1.2;
  const Stiffness c = test::cubic(c11, c12, c44);
  const auto across = waves(c, {}, 1, {1, 1, 0});
  EXPECT_NEAR(across[0].speed, std::sqrt(c44), 1e-14);
  EXPECT_NEAR(across[1].speed, std::sqrt(0.5 * (c11 - c12)), 1e-14);
  EXPECT_NEAR(across[2].speed, std::sqrt(0.5 * (c11 + c12 + 2 * c44)), 1e-14);
  EXPECT_NEAR(waves(c, {}, 1, {1, 1, 1})[2].speed, std::sqrt((c11 + 2 * c12 + 4 * c44) / 3), 1e-14);
}

/// A lattice of one grain per cell moves affinely, so its long waves are known from sums over the contacts:
/// Q = (1/V) sum K (n . l)^2 with K = k nn - (f/d)(1 - nn). Twelve neighbours of fcc, whose forces differ
/// with their direction so that the prestress is a tensor of its own.
TEST(Waves, PrestressedLatticeHasItsDynamicalMatrix) {
  const double d = 1.9, k = 3, volume = 1.7;
  const double s = d / std::sqrt(2.0);
  Stiffness energy{};
  Sym6 prestress{}, expected{};
  Direction n{1, 2, -3};
  for (double& component : n) component /= std::sqrt(14.0);
  const std::array<Direction, 6> branches{
      {{0, s, s}, {0, s, -s}, {s, 0, s}, {s, 0, -s}, {s, s, 0}, {s, -s, 0}}};
  for (std::size_t c = 0; c < 6; ++c) {
    const Direction& l = branches[c];
    const double f = 0.2 + 0.1 * static_cast<double>(c), along = n[0] * l[0] + n[1] * l[1] + n[2] * l[2];
    const auto block = [&](std::size_t i, std::size_t j) {
      return (k + f / d) * l[i] * l[j] / (d * d) - (i == j ? f / d : 0);
    };
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j) {
        prestress[component(i, j)] += f / d * l[i] * l[j] / volume;
        expected[component(i, j)] += block(i, j) * along * along / volume;
      }
    // E_ab : w_a . K w_b with w the branch strained, symmetric in both pairs of indices
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b)
        for (std::size_t e = 0; e < 3; ++e)
          for (std::size_t g = e; g < 3; ++g)
            energy[component(a, b)][component(e, g)] +=
                0.25 / volume *
                (block(a, e) * l[b] * l[g] + block(a, g) * l[b] * l[e] + block(b, e) * l[a] * l[g] +
                 block(b, g) * l[a] * l[e]);
  }
  const Sym6 q = acoustic_tensor(energy, prestress, n);
  for (std::size_t a = 0; a < 6; ++a) EXPECT_NEAR(q[a], expected[a], 1e-13) << a;
}

TEST(Waves, TurnWithTheSolid) {
  const Rotation turn = test::turned(0.3, -0.7, 1.9);
  const Direction n{1, 2, 3};
  Direction seen{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) seen[i] += turn[i][j] * n[j];
  const Stiffness c = test::triclinic();
  const auto before = waves(c, {}, 1, n), after = waves(rotated(c, turn), {}, 1, seen);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(after[k].speed, before[k].speed, 1e-13);
}

/// Under more pressure than its shear modulus resists, a solid has no wave across.
TEST(Waves, NoneWhereTheSolidIsUnstable) {
  const auto w = waves(test::isotropic(3, 0.5), {2, 2, 2, 0, 0, 0}, 1, {1, 0, 0});
  EXPECT_TRUE(std::isnan(w[0].speed));
  EXPECT_GT(w[2].speed, 0);
}

}  // namespace
}  // namespace grainlaw
