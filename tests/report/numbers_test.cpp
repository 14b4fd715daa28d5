#include "grainlaw/apps/report/numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainlaw::report {
namespace {

TEST(ReportNumbers, KeepSoManySignificantDigits) {
  EXPECT_EQ(number(8.27204), "8.272");
  EXPECT_EQ(number(0.5), "0.5");
  EXPECT_EQ(number(-0.0123456, 3), "−0.0123");
  EXPECT_EQ(number(23719.3, 3), "23700");
  EXPECT_EQ(number(9.9996), "10");
  EXPECT_EQ(number(0.0), "0");
  EXPECT_EQ(number(-0.0), "0");
}

TEST(ReportNumbers, WriteLargeAndSmallOnesAsPowersOfTen) {
  EXPECT_EQ(number(237193, 3), "2.37×10⁵");
  EXPECT_EQ(number(-4.5e-12), "−4.5×10⁻¹²");
  EXPECT_EQ(number(1e308), "1×10³⁰⁸");
}

TEST(ReportNumbers, AreNeverNanOrInfinite) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double x : {nan, infinity, -infinity}) {
    EXPECT_EQ(number(x), "—");
    EXPECT_EQ(with_error(x, 1.0), "—");
    EXPECT_EQ(signed_number(x), "—");
    EXPECT_EQ(seconds(x), "—");
    EXPECT_EQ(percent(x), "—");
  }
  EXPECT_EQ(number(std::nullopt), "—");
  EXPECT_EQ(with_error(2.5, infinity), "2.5");
}

TEST(ReportNumbers, GiveAnErrorTwoDigitsAndTheValueTheSameDecimals) {
  EXPECT_EQ(with_error(8.27204, 0.0534), "8.272 ± 0.053");
  EXPECT_EQ(with_error(0.66491, 0.00052), "0.66491 ± 0.00052");
  EXPECT_EQ(with_error(15.895, 1.27), "15.9 ± 1.3");
  EXPECT_EQ(with_error(86, 33), "86 ± 33");
  EXPECT_EQ(with_error(0.001, 0.0997), "0.00 ± 0.10");
  EXPECT_EQ(with_error(-3.5e-7, 2.1e-8), "(−3.50 ± 0.21)×10⁻⁷");
  EXPECT_EQ(with_error(5.0e7, 1.2e6), "(5.00 ± 0.12)×10⁷");
}

TEST(ReportNumbers, LeaveTheErrorOutWhereThereIsNone) {
  EXPECT_EQ(with_error(6, std::nullopt), "6");
  EXPECT_EQ(with_error(0.6653, 0.0), "0.6653");
  EXPECT_EQ(with_error(std::nullopt, 0.1), "—");
}

TEST(ReportNumbers, SignDifferences) {
  EXPECT_EQ(signed_number(0.84), "+0.8");
  EXPECT_EQ(signed_number(-2.06), "−2.1");
  EXPECT_EQ(signed_number(0.01), "0.0");
  EXPECT_EQ(signed_number(12345), "+12000");
}

TEST(ReportNumbers, SayTimesAsPeopleDo) {
  EXPECT_EQ(seconds(0.0483), "48 ms");
  EXPECT_EQ(seconds(7.34), "7.3 s");
  EXPECT_EQ(seconds(59.96), "60 s");
  EXPECT_EQ(seconds(245), "4 min 05 s");
  EXPECT_EQ(seconds(7845), "2 h 10 min");
  EXPECT_EQ(seconds(-1.0), "—");
}

TEST(ReportNumbers, SayErrorsInPercent) {
  EXPECT_EQ(percent(0.0341), "3.4 %");
  EXPECT_EQ(percent(1.234), "123 %");
}

TEST(ReportNumbers, GroupThousands) {
  EXPECT_EQ(count(201), "201");
  EXPECT_EQ(count(1234567), "1\u202f234\u202f567");
}

TEST(ReportNumbers, ReadJsonWithoutTrustingIt) {
  const Json json = Json::parse(R"({"a": 1.5, "b": "x", "c": null, "d": [1, null, "y"]})");
  EXPECT_EQ(number_in(json, "a"), 1.5);
  EXPECT_EQ(number_in(json, "b"), std::nullopt);
  EXPECT_EQ(number_in(json, "c"), std::nullopt);
  EXPECT_EQ(number_in(Json::array({1, 2}), "a"), std::nullopt);
  EXPECT_EQ(text_in(json, "a"), "");
  EXPECT_TRUE(value_in(Json(3), "a").is_null());
  const auto list = numbers_in(json, "d");
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0], 1);
  EXPECT_TRUE(std::isnan(list[1]));
  EXPECT_TRUE(std::isnan(list[2]));
}

}  // namespace
}  // namespace grainlaw::report
