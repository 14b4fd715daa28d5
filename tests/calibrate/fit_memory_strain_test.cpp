// The strain of the form with memory where no test tells it; what tests do tell is in
// base_campaign_test.cpp.
#include "grainlaw/calibrate/fit_memory_strain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;

TEST(FitMemoryStrain, IsAssumedWithTheReasonWhereNoTestTells) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  add_memory_strain(testing::TempDir(), set);
  const auto& strain = set.memory->eps_c;
  ASSERT_TRUE(strain.has_value());
  EXPECT_EQ(strain->source, "assumed");
  EXPECT_FALSE(strain->stderr_);
  EXPECT_THAT(set.memory->eps_c->note, HasSubstr("no D2 test tells ("));
}

TEST(FitMemoryStrain, IsLeftOutWhereTheFormLacksItsLaws) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  set.moduli.reset();
  add_memory_strain(testing::TempDir(), set);
  EXPECT_FALSE(set.memory->eps_c);
}

}  // namespace
}  // namespace grainlaw::calibrate
