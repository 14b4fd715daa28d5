// Eigenvalues, rotation and inverse of a stiffness against closed forms.
#include "grainlaw/element/stiffness.hpp"

#include <gtest/gtest.h>

#include "elastic_solids.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw {
namespace {

void expect_near(const Stiffness& a, const Stiffness& b, double error) {
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(a[r][c], b[r][c], error) << r << c;
}

void expect_near(const Sym6& a, const Sym6& b, double error) {
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(a[k], b[k], error) << k;
}

TEST(Stiffness, EigenvaluesOfIsotropicAndCubicSolids) {
  expect_near(eigenvalues(test::isotropic(3, 0.5)), {1, 1, 1, 1, 1, 9}, 1e-14);
  // 2 c44 three times, c11 - c12 twice, c11 + 2 c12
  expect_near(eigenvalues(test::cubic(5, 2, 1.2)), {2.4, 2.4, 2.4, 3, 3, 9}, 1e-14);
}

TEST(Stiffness, EigenvaluesAndNormBelongToNoFrame) {
  const Stiffness c = test::triclinic(), other = rotated(c, test::turned(0.3, -0.7, 1.9));
  EXPECT_GT(std::abs(other[0][0] - c[0][0]), 0.1);
  expect_near(eigenvalues(other), eigenvalues(c), 1e-13);
  EXPECT_NEAR(norm(other), norm(c), 1e-13);
  double sum = 0;
  for (const double value : eigenvalues(c)) sum += value * value;
  EXPECT_NEAR(std::sqrt(sum), norm(c), 1e-13);
}

TEST(Stiffness, IsotropicSolidsAreTheSameFromEverywhere) {
  const Stiffness c = test::isotropic(3, 0.5);
  expect_near(rotated(c, test::turned(0.3, -0.7, 1.9)), c, 1e-14);
}

/// A permutation of the axes moves components, and turning twice is turning once by the product.
TEST(Stiffness, Turns) {
  const Stiffness c = test::triclinic();
  const Stiffness permuted = rotated(c, {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}});  // x' = y, y' = z, z' = x
  EXPECT_NEAR(permuted[0][0], c[1][1], 1e-15);
  EXPECT_NEAR(permuted[0][3], c[1][4], 1e-15);  // y'z' = zx
  EXPECT_NEAR(permuted[5][4], c[3][5], 1e-15);  // x'y' = yz, x'z' = yx
  expect_near(rotated(rotated(c, test::turned(0, 0, 0.4)), test::turned(0, 0, 0.5)),
              rotated(c, test::turned(0, 0, 0.9)), 1e-14);
}

TEST(Stiffness, InverseOfIsotropicSolidAndOfAnyWithoutSymmetry) {
  const double bulk = 3, shear = 0.5, young = 9 * bulk * shear / (3 * bulk + shear);
  const Stiffness s = inverse(test::isotropic(bulk, shear));
  EXPECT_NEAR(s[0][0], 1 / young, 1e-14);
  EXPECT_NEAR(s[3][3], 1 / shear, 1e-14);
  Stiffness c = test::triclinic(), product{}, one{};
  c[0][4] += 0.3;
  for (std::size_t a = 0; a < 6; ++a) {
    one[a][a] = 1;
    for (std::size_t b = 0; b < 6; ++b)
      for (std::size_t k = 0; k < 6; ++k) product[a][b] += inverse(c)[a][k] * c[k][b];
  }
  expect_near(product, one, 1e-13);
}

TEST(Stiffness, SingularHasNoInverse) { EXPECT_THROW(inverse(test::cubic(1, 0, 0)), Error); }

}  // namespace
}  // namespace grainlaw
