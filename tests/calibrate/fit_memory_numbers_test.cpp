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
  const auto& memory = *set.memory;
  for (const auto* number : {&memory.alpha_P, &memory.eps0_P, &memory.eps0_R_P, &memory.eps_r, &memory.hold,
                             &memory.pack_rate, &memory.phi_pack}) {
    ASSERT_TRUE(number->has_value());
    EXPECT_EQ((*number)->source, "assumed");
    EXPECT_FALSE((*number)->stderr_);
  }
  EXPECT_THAT(memory.alpha_P->note, HasSubstr("no D2 test tells ("));
  EXPECT_THAT(memory.eps0_P->note, HasSubstr("no D2 test tells ("));
  EXPECT_THAT(memory.eps_r->note, HasSubstr("no D2 test is reversed"));
  EXPECT_THAT(memory.phi_pack->note, HasSubstr("no test is asked for it"));
  EXPECT_THAT(set.memory->hold->note, HasSubstr("no D2 test is reversed"));
}

TEST(FitMemoryNumbers, AreLeftOutWhereTheFormLacksItsLaws) {
  auto set = model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
  set.moduli.reset();
  add_memory_numbers(testing::TempDir(), {}, set);
  EXPECT_FALSE(set.memory->alpha_P);
  EXPECT_FALSE(set.memory->eps_r);
  EXPECT_FALSE(set.memory->hold);
}

}  // namespace
}  // namespace grainlaw::calibrate
