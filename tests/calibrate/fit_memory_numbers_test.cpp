// The numbers of the form with memory where no test tells them; what tests do tell is in
// base_campaign_test.cpp.
#include "grainlaw/calibrate/fit_memory_numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;

TEST(FitMemoryNumbers, AreAssumedWithTheReasonWhereNoTestTells) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  add_memory_numbers(testing::TempDir(), {}, set);
  for (const auto* number : {&set.memory->eps_c, &set.memory->hold}) {
    ASSERT_TRUE(number->has_value());
    EXPECT_EQ((*number)->source, "assumed");
    EXPECT_FALSE((*number)->stderr_);
  }
  EXPECT_THAT(set.memory->eps_c->note, HasSubstr("no D2 test tells ("));
  EXPECT_THAT(set.memory->hold->note, HasSubstr("no D2 test is reversed"));
}

TEST(FitMemoryNumbers, AreLeftOutWhereTheFormLacksItsLaws) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  set.moduli.reset();
  add_memory_numbers(testing::TempDir(), {}, set);
  EXPECT_FALSE(set.memory->eps_c);
  EXPECT_FALSE(set.memory->hold);
}

}  // namespace
}  // namespace grainlaw::calibrate
