#include "grainlaw/apps/report/seed_scatter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw::report {
namespace {

Record column(const std::vector<double>& values) {
  Record record({"P"});
  for (const double value : values) record.append({value});
  return record;
}

TEST(ReportSeedScatter, IsTheRelativeDistanceOfAPair) {
  const Record a = column({3, 4}), b = column({3, 5});
  EXPECT_DOUBLE_EQ(*seed_scatter({&a, &b}, "P"), std::sqrt(1 / (0.5 * (25 + 34))));
  EXPECT_DOUBLE_EQ(*seed_scatter({&b, &a}, "P"), *seed_scatter({&a, &b}, "P"));
  EXPECT_EQ(*seed_scatter({&a, &a}, "P"), 0);
}

TEST(ReportSeedScatter, IsTheMeanOverPairs) {
  const Record a = column({1}), b = column({-1});  // apart by twice their size
  EXPECT_DOUBLE_EQ(*seed_scatter({&a, &a, &b}, "P"), (0 + 2 + 2) / 3.0);
}

TEST(ReportSeedScatter, LeavesOutWhatCannotBeCompared) {
  const double nan = std::nan("");
  const Record a = column({3, 4, nan}), b = column({3, 5, 7}), shorter = column({1}), zero = column({0});
  EXPECT_DOUBLE_EQ(*seed_scatter({&a, &b, &shorter}, "P"), std::sqrt(1 / 29.5));
  EXPECT_FALSE(seed_scatter({&a}, "P"));
  EXPECT_FALSE(seed_scatter({&a, &shorter}, "P"));
  EXPECT_FALSE(seed_scatter({&zero, &zero}, "P"));
}

}  // namespace
}  // namespace grainlaw::report
