// Projections onto classes of symmetry: solids of a class, in any frame, and what is left of others.
#include "grainlaw/element/symmetry_class.hpp"

#include <gtest/gtest.h>

#include "elastic_solids.hpp"

namespace grainlaw {
namespace {

constexpr double root = 0.7071067811865476;

Stiffness difference(Stiffness a, const Stiffness& b) {
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = 0; c < 6; ++c) a[r][c] -= b[r][c];
  return a;
}

TEST(SymmetryClass, SolidsOfAClassAreTheirOwnPart) {
  const SymmetryClass isotropic = symmetry_class(test::isotropic(3, 0.5));
  EXPECT_NEAR(isotropic.isotropic, 1, 1e-14);
  EXPECT_NEAR(isotropic.transversely_isotropic[0], 1, 1e-14);
  EXPECT_NEAR(isotropic.orthotropic, 1, 1e-14);
  const SymmetryClass along_z = symmetry_class(test::transversely_isotropic());
  EXPECT_LT(along_z.isotropic, 0.99);
  EXPECT_NEAR(along_z.transversely_isotropic[2], 1, 1e-14);
  EXPECT_LT(along_z.transversely_isotropic[0], 0.99);
  EXPECT_NEAR(along_z.best_axis[2], 1, 1e-10);
  const SymmetryClass three = symmetry_class(test::orthotropic());
  EXPECT_NEAR(three.orthotropic, 1, 1e-14);
  EXPECT_LT(three.best_transversely_isotropic, 0.999);
}

/// c11 - c12 - 2 c44 = a measures what is not isotropic: |C - part|^2 = (6/5) a^2, |C|^2 = sum of squares of
/// the eigenvalues.
TEST(SymmetryClass, CubicSolidHasItsClosedForm) {
  const double c11 = 5, c12 = 2, c44 = 1.2, a = c11 - c12 - 2 * c44;
  const Stiffness c = test::cubic(c11, c12, c44);
  const double square = 3 * 4 * c44 * c44 + 2 * (c11 - c12) * (c11 - c12) + (c11 + 2 * c12) * (c11 + 2 * c12);
  EXPECT_NEAR(1 - symmetry_class(c).isotropic, 1.2 * a * a / square, 1e-14);
  EXPECT_NEAR(symmetry_class(c).orthotropic, 1, 1e-14);
}

TEST(SymmetryClass, PartsAreOrthogonalProjections) {
  const Stiffness c = test::triclinic();
  const Rotation frame = test::turned(0.3, -0.7, 1.9);
  for (const Stiffness& part :
       {isotropic_part(c), transversely_isotropic_part(c, {1, 2, 3}), orthotropic_part(c, frame)}) {
    const double rest = norm(difference(c, part)) / norm(c);
    EXPECT_NEAR(share(part, c) + rest * rest, 1, 1e-13);
  }
  EXPECT_LT(norm(difference(transversely_isotropic_part(transversely_isotropic_part(c, {1, 2, 3}), {1, 2, 3}),
                            transversely_isotropic_part(c, {1, 2, 3}))),
            1e-13);
  EXPECT_GE(share(transversely_isotropic_part(c, {1, 2, 3}), c), share(isotropic_part(c), c));
}

TEST(SymmetryClass, BestSharesAndAxesTurnWithTheSolid) {
  const Rotation turn = test::turned(0.3, -0.7, 1.9);
  const SymmetryClass tilted = symmetry_class(rotated(test::transversely_isotropic(), turn));
  EXPECT_LT(tilted.transversely_isotropic[2], 0.999);
  EXPECT_NEAR(tilted.best_transversely_isotropic, 1, 1e-11);
  const double along =
      tilted.best_axis[0] * turn[0][2] + tilted.best_axis[1] * turn[1][2] + tilted.best_axis[2] * turn[2][2];
  EXPECT_NEAR(std::abs(along), 1, 1e-11);
  EXPECT_NEAR(symmetry_class(rotated(test::orthotropic(), turn)).best_orthotropic, 1, 1e-11);
  const Stiffness c = test::triclinic();
  const SymmetryClass before = symmetry_class(c), after = symmetry_class(rotated(c, turn));
  EXPECT_NEAR(after.isotropic, before.isotropic, 1e-14);
  EXPECT_NEAR(after.best_transversely_isotropic, before.best_transversely_isotropic, 1e-10);
  EXPECT_NEAR(after.best_orthotropic, before.best_orthotropic, 1e-10);
}

/// Along (1, 1, 0) as about z: the mean over all turns about an axis.
TEST(SymmetryClass, PartAboutAnyAxisIsThatAboutZInItsFrame) {
  const Stiffness c = test::triclinic();
  const Rotation frame{{{0, 0, 1}, {root, -root, 0}, {root, root, 0}}};
  EXPECT_NEAR(share(transversely_isotropic_part(c, {1, 1, 0}), c),
              share(transversely_isotropic_part(rotated(c, frame), {0, 0, 1}), c), 1e-14);
  Stiffness mean{};
  constexpr int turns = 8;
  for (int n = 0; n < turns; ++n) {
    const Stiffness one = rotated(c, test::turned(0, 0, 2 * 3.14159265358979323846 * n / turns));
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) mean[a][b] += one[a][b] / turns;
  }
  EXPECT_LT(norm(difference(mean, transversely_isotropic_part(c, {0, 0, 1}))), 1e-13);
}

}  // namespace
}  // namespace grainlaw
