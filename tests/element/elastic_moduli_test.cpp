// Young's moduli and Poisson's ratios against closed forms.
#include "grainlaw/element/elastic_moduli.hpp"

#include <gtest/gtest.h>

#include "elastic_solids.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw {
namespace {

TEST(ElasticModuli, IsotropicSolidIsTheSameInEveryDirection) {
  const double bulk = 3, shear = 0.5;
  const ElasticModuli moduli(test::isotropic(bulk, shear));
  for (const Direction& n : {Direction{1, 0, 0}, Direction{1, 2, 3}})
    EXPECT_NEAR(moduli.young(n), 9 * bulk * shear / (3 * bulk + shear), 1e-13);
  const double expected = (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear));
  EXPECT_NEAR(moduli.poisson({1, 0, 0}, {0, 1, 0}), expected, 1e-14);
  EXPECT_NEAR(moduli.poisson({1, 1, 0}, {1, -1, 1}), expected, 1e-14);
}

/// 1/E = s11 - 2 (s11 - s12 - s44/2)(n1^2 n2^2 + n2^2 n3^2 + n3^2 n1^2), Nye.
TEST(ElasticModuli, CubicSolidHasItsClosedForm) {
  const double c11 = 5, c12 = 2, c44 = 1.2;
  const ElasticModuli moduli(test::cubic(c11, c12, c44));
  const double whole = (c11 - c12) * (c11 + 2 * c12), s11 = (c11 + c12) / whole, s12 = -c12 / whole,
               s44 = 1 / c44;
  EXPECT_NEAR(1 / moduli.young({0, 0, 2}), s11, 1e-14);
  EXPECT_NEAR(1 / moduli.young({1, 1, 0}), s11 - 0.5 * (s11 - s12 - 0.5 * s44), 1e-14);
  EXPECT_NEAR(1 / moduli.young({1, 1, 1}), s11 - 2.0 / 3 * (s11 - s12 - 0.5 * s44), 1e-14);
  EXPECT_NEAR(moduli.poisson({1, 0, 0}, {0, 0, 1}), -s12 / s11, 1e-14);
}

TEST(ElasticModuli, PoissonsRatiosOfTransverselyIsotropicSolid) {
  const Stiffness c = test::transversely_isotropic();
  const ElasticModuli moduli(c);
  // Along the axis: with x and y free, sigma_z = E e_z, e_x = -(c13/(c11 + c12)) e_z.
  const double sideways = c[0][2] / (c[0][0] + c[0][1]);
  EXPECT_NEAR(moduli.poisson({0, 0, 1}, {1, 0, 0}), sideways, 1e-14);
  EXPECT_NEAR(moduli.young({0, 0, 1}), c[2][2] - 2 * sideways * c[0][2], 1e-13);
  EXPECT_NEAR(moduli.poisson({0, 0, 1}, {1, 0, 0}) / moduli.young({0, 0, 1}),
              moduli.poisson({1, 0, 0}, {0, 0, 1}) / moduli.young({1, 0, 0}), 1e-14);
}

TEST(ElasticModuli, TurnWithTheSolid) {
  const Rotation turn = test::turned(0.3, -0.7, 1.9);
  Stiffness c = test::triclinic();
  c[0][4] += 0.3;  // prestress leaves no symmetry
  const ElasticModuli before(c), after(rotated(c, turn));
  const auto seen = [&](const Direction& n) {
    Direction other{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) other[i] += turn[i][j] * n[j];
    return other;
  };
  EXPECT_NEAR(after.young(seen({1, 2, 3})), before.young({1, 2, 3}), 1e-13);
  EXPECT_NEAR(after.poisson(seen({1, 2, 3}), seen({2, -1, 0})), before.poisson({1, 2, 3}, {2, -1, 0}), 1e-13);
}

TEST(ElasticModuli, BadInput) {
  EXPECT_THROW(ElasticModuli(test::cubic(1, 0, 0)), Error);
  const ElasticModuli moduli(test::isotropic(3, 0.5));
  EXPECT_THROW(moduli.young({0, 0, 0}), Error);
  EXPECT_THROW(moduli.poisson({1, 0, 0}, {1, 1, 0}), Error);
}

}  // namespace
}  // namespace grainlaw
