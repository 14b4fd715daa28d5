// As many digits as asked for, and no more.
#include "grainlaw/element/short_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace grainlaw {
namespace {

TEST(ShortText, HasSoManyDigits) {
  EXPECT_EQ(short_text(1.0 / 3, 4), "0.3333");
  EXPECT_EQ(short_text(1.0 / 3, 3), "0.333");
  EXPECT_EQ(short_text(0.5, 4), "0.5");
  EXPECT_EQ(short_text(-2e-5, 6), "-2e-05");
  EXPECT_EQ(short_text(67108864, 2), "6.7e+07");
  EXPECT_EQ(short_text(-std::numeric_limits<double>::max(), 17), "-1.7976931348623157e+308");
}

}  // namespace
}  // namespace grainlaw
