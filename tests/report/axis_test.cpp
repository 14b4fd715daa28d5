#include "grainlaw/apps/report/axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grainlaw::report {
namespace {

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> all;
  for (const Tic& tic : axis.tics) all.push_back(tic.label);
  return all;
}

TEST(ReportAxis, PutsTicsAtRoundNumbers) {
  EXPECT_EQ(labels(make_axis({-0.42, 0.42}, 5)),
            (std::vector<std::string>{"−0.4", "−0.2", "0.0", "0.2", "0.4"}));
  EXPECT_EQ(labels(make_axis({0.66, 0.83}, 4)), (std::vector<std::string>{"0.70", "0.75", "0.80"}));
}

TEST(ReportAxis, TakesPowersOfTenOutOfLongLabels) {
  const Axis small = make_axis({-4.4e-6, 4.4e-6}, 5);
  EXPECT_EQ(small.power, -6);
  EXPECT_EQ(labels(small), (std::vector<std::string>{"−4", "−2", "0", "2", "4"}));
  EXPECT_NEAR(small.tics[1].at, -2e-6, 1e-15);
  const Axis large = make_axis({0, 0.1}, 5, 5e7);
  EXPECT_EQ(large.power, 6);
  EXPECT_EQ(labels(large), (std::vector<std::string>{"0", "1", "2", "3", "4", "5"}));
  EXPECT_NEAR(large.tics[5].at, 0.1, 1e-12);
}

TEST(ReportAxis, LabelsNeverRepeatAndStayInside) {
  for (const double low : {-1e-9, 0.0, 0.6649, -3.7, 1e7}) {
    for (const double span : {1e-7, 0.003, 0.7, 42.0, 3e8}) {
      if (span < 1e-9 * std::abs(low)) continue;  // padded_range() gives none of these
      const Axis axis = make_axis({low, low + span}, 5);
      const auto all = labels(axis);
      EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size()) << low << " " << span;
      EXPECT_GE(all.size(), 2u) << low << " " << span;
      EXPECT_LE(all.size(), 6u) << low << " " << span;
      for (const Tic& tic : axis.tics) {
        EXPECT_GE(tic.at, low - 1e-6 * span);
        EXPECT_LE(tic.at, low + span + 1e-6 * span);
      }
    }
  }
}

TEST(ReportAxis, LogarithmicTicsStandAtPowersOfTen) {
  const Axis axis = make_log_axis({-2.2, 1.1}, 5);
  EXPECT_EQ(labels(axis), (std::vector<std::string>{"10^{−2}", "10^{−1}", "10^{0}", "10^{1}"}));
  EXPECT_EQ(axis.tics[0].at, -2);
  EXPECT_LE(make_log_axis({0, 40}, 5).tics.size(), 6u);
  const Axis within_a_decade = make_log_axis({0.2, 0.7}, 5);
  EXPECT_EQ(labels(within_a_decade), (std::vector<std::string>{"10^{0}", "10^{1}"}));
  EXPECT_EQ(within_a_decade.low, 0);
  EXPECT_EQ(within_a_decade.high, 1);
}

TEST(ReportAxis, HasAtLeastThreeTicsWhereAsked) {
  EXPECT_EQ(make_axis({-0.02, 6.3}, 3).tics.size(), 2u);
  for (double high = 1; high < 10; high += 0.13) {
    for (const double unit : {1.0, 5e7}) {
      const Axis axis = make_axis({-0.02, high}, 6, unit, 3);
      EXPECT_GE(axis.tics.size(), 3u) << high << " " << unit;
      EXPECT_LE(axis.tics.size(), 12u) << high << " " << unit;
    }
  }
}

TEST(ReportAxis, PadsRangesAndCopesWithNoneAndOne) {
  const auto padded = padded_range({0.0, std::nan(""), 1.0, INFINITY});
  EXPECT_DOUBLE_EQ(padded[0], -0.05);
  EXPECT_DOUBLE_EQ(padded[1], 1.05);
  EXPECT_LT(padded_range({})[0], padded_range({})[1]);
  EXPECT_LT(padded_range({0.711})[0], 0.711);
  EXPECT_GT(padded_range({0.711})[1], 0.711);
  EXPECT_LT(padded_range({0.0})[0], padded_range({0.0})[1]);
}

TEST(ReportAxis, NamesThePowerInTheUnit) {
  EXPECT_EQ(with_power("pressure (–)", -3), "pressure (10^{−3})");
  EXPECT_EQ(with_power("P (kPa)", 6), "P (10^{6} kPa)");
  EXPECT_EQ(with_power("P (kPa)", 0), "P (kPa)");
  EXPECT_EQ(with_power("x", 3), "x (10^{3})");
}

}  // namespace
}  // namespace grainlaw::report
