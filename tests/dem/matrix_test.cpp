// Small matrices against what defines them.
#include "grainlaw/dem/numbers/matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "packings.hpp"

namespace grainlaw::dem {
namespace {

void expect_near(const Mat3& is, const Mat3& should, double tolerance) {
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(is(r, c), should(r, c), tolerance) << r << ' ' << c;
}

TEST(Mat3, InverseAndDeterminant) {
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Mat3 a = test::random_matrix(random, 1) + Mat3::diagonal({2, 2, 2});
    const Mat3 b = test::random_matrix(random, 1) + Mat3::diagonal({2, 2, 2});
    expect_near(a * inverse(a), Mat3::identity(), 1e-12);
    EXPECT_NEAR(determinant(a * b), determinant(a) * determinant(b),
                1e-12 * std::abs(determinant(a * b)) + 1e-12);
  }
  const Mat3 ordered{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  EXPECT_EQ(determinant(ordered), -3);
  EXPECT_EQ(ordered * Vec3({1, 0, 2}), Vec3({7, 16, 27}));
  EXPECT_EQ((ordered * transposed(ordered))(0, 1), 32);
}

TEST(Mat3, SquareRoot) {
  Random random(2);
  for (int k = 0; k < 100; ++k) {
    const Mat3 f = test::random_matrix(random, 0.2) + Mat3::identity();
    const Mat3 root = square_root(f);
    expect_near(root * root, f, 1e-14);
  }
  expect_near(square_root(Mat3::diagonal({1.21, 0.81, 1})), Mat3::diagonal({1.1, 0.9, 1}), 1e-15);
}

TEST(Mat3, SpectrumOfASymmetricMatrix) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const Mat3 any = test::random_matrix(random, 1);
    const Mat3 a = any + transposed(any);
    const Spectrum s = spectrum(a);
    expect_near(apply(s, [](double value) { return value; }), a, 1e-14);
    expect_near(apply(s, [](double) { return 1.0; }), Mat3::identity(), 1e-14);
  }
  const Mat3 equal_pair{{1, 0.5, 0.5}, {0.5, 1, 0.5}, {0.5, 0.5, 1}};  // 2, 1/2, 1/2
  expect_near(apply(spectrum(equal_pair), [](double value) { return value * value; }),
              equal_pair * equal_pair, 1e-14);
}

/// The sum of its series; of a diagonal matrix exp of each value, to the last bit.
TEST(Mat3, ExponentialOfASymmetricMatrix) {
  Random random(4);
  for (int k = 0; k < 100; ++k) {
    const Mat3 any = test::random_matrix(random, 0.5);
    const Mat3 a = any + transposed(any);
    Mat3 sum = Mat3::identity(), term = Mat3::identity();
    for (int n = 1; n < 40; ++n) {
      term = (1.0 / n) * (term * a);
      sum = sum + term;
    }
    expect_near(exponential(a), sum, 1e-13);
  }
  EXPECT_EQ(exponential(Mat3::diagonal({0.1, -0.2, 0})), Mat3::diagonal({std::exp(0.1), std::exp(-0.2), 1}));
}

}  // namespace
}  // namespace grainlaw::dem
