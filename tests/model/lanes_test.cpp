// Eight lanes at once: functions against those of the C library, one by one.
#include "grainlaw/model/light/lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace grainlaw::model {
namespace {

Lanes lanes_of(const std::array<double, 8>& x) { return Lanes::load(x.data()); }

/// Largest error over the size of the value, of many random arguments.
template <class Ours, class Theirs>
double worst(double low, double high, Ours ours, Theirs theirs) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> argument(low, high);
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    std::array<double, 8> x;
    for (double& value : x) value = argument(random);
    const Lanes y = ours(lanes_of(x));
    for (std::size_t lane = 0; lane < 8; ++lane)
      most = std::max(most, std::abs(y[lane] - theirs(x[lane])) / std::abs(theirs(x[lane])));
  }
  return most;
}

TEST(Lanes, FunctionsAreThoseOfTheLibrary) {
  const auto exp_ = [](const Lanes& x) { return exp(x); };
  const auto log_ = [](const Lanes& x) { return log(x); };
  for (const double size : {1e-9, 1.0, 600.0})
    EXPECT_LT(worst(-size, size, exp_, [](double x) { return std::exp(x); }), 5e-16) << size;
  for (const double size : {1e-200, 1.0, 3.0, 1e5, 1e200})
    EXPECT_LT(worst(0, size, log_, [](double x) { return std::log(x); }), 5e-16) << size;
  EXPECT_LT(worst(0.999, 1.001, log_, [](double x) { return std::log(x); }), 5e-16);
  const auto power = [](const Lanes& x) { return pow(x, 0.5769); };
  EXPECT_LT(worst(1e-12, 1, power, [](double x) { return std::pow(x, 0.5769); }), 5e-15);
}

TEST(Lanes, OutsideOfTheirRangeTheyAreTheLibraryItself) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Lanes x = lanes_of({-800, 800, 0, 1, -infinity, infinity, 710, -745});
  const Lanes y = exp(x), z = log(lanes_of({0, 1, infinity, 1e308, 5e-324, 2, 3, -1}));
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(y[i], std::exp(x[i])) << i;
  EXPECT_EQ(z[0], -infinity);
  EXPECT_EQ(z[4], std::log(5e-324));
  EXPECT_TRUE(std::isnan(z[7]));
  EXPECT_EQ(pow(lanes_of({0, 1, 2, 3, 4, 5, 6, 7}), 0.5)[0], 0);
}

TEST(Lanes, ComparisonsHoldWhereTheyHoldInEveryLane) {
  const Lanes x = lanes_of({1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_TRUE(x > 0.5);
  EXPECT_FALSE(x > 1.5);
  EXPECT_FALSE(x < 1.5);
  EXPECT_TRUE(x == x);
  EXPECT_FALSE(Lanes(std::nan("")) > 0.0);
  EXPECT_TRUE(vanishes(Lanes(0.0)));
  EXPECT_FALSE(vanishes(lanes_of({0, 0, 0, 0, 0, 0, 0, 1e-300})));
}

TEST(Lanes, SignAndSize) {
  const Lanes x = lanes_of({-2, -0.0, 0, 3, -1e-300, 1e300, -1, 1});
  const double signs[] = {-1, 0, 0, 1, -1, 1, -1, 1};
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(sign(x)[i], signs[i]);
    EXPECT_EQ(abs(x)[i], std::abs(x[i]));
  }
}

}  // namespace
}  // namespace grainlaw::model
