// The strains of the form with memory where no test tells them; what tests do tell is in
// base_campaign_test.cpp.
#include "grainlaw/calibrate/fit_memory_strains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;

TEST(FitMemoryStrains, AreAssumedWithTheReasonWhereNoTestTells) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  add_memory_strains(testing::TempDir(), {}, set);
  for (const auto* strain : {&set.memory->eps_c, &set.memory->eps_r}) {
    ASSERT_TRUE(strain->has_value());
    EXPECT_EQ((*strain)->source, "assumed");
    EXPECT_FALSE((*strain)->stderr_);
  }
  EXPECT_THAT(set.memory->eps_c->note, HasSubstr("no D2 test tells ("));
  EXPECT_THAT(set.memory->eps_r->note, HasSubstr("no D2 test is reversed"));
}

TEST(FitMemoryStrains, AreLeftOutWhereTheFormLacksItsLaws) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  set.moduli.reset();
  add_memory_strains(testing::TempDir(), {}, set);
  EXPECT_FALSE(set.memory->eps_c);
  EXPECT_FALSE(set.memory->eps_r);
}

}  // namespace
}  // namespace grainlaw::calibrate
