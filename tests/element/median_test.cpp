// The middle of odd and even counts, and of none.
#include "grainlaw/element/median.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw {
namespace {

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoThere) {
  EXPECT_EQ(median({5, -1, 2}), 2);
  EXPECT_EQ(median({5, -1, 2, 3}), 2.5);
  EXPECT_EQ(median({7}), 7);
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace grainlaw
