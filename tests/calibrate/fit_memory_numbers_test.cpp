// The numbers of the form with memory: those of reversals come back from cycles that the law itself has
// written, and are assumed where no test tells them. What grains tell is in base_campaign_test.cpp.
#include "grainlaw/calibrate/fit_memory_numbers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;

model::ParameterSet thesis() {
  return model::ParameterSet::load(GRAINLAW_DATA_DIR "/thesis/parameters.json");
}

TEST(FitMemoryNumbers, AreAssumedWithTheReasonWhereNoTestTells) {
  auto set = thesis();
  EXPECT_THAT(add_memory_numbers({}, {}, set), testing::ElementsAre("memory.alpha_P", "memory.eps0_P"));
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
  EXPECT_THAT(memory.phi_pack->note, HasSubstr("no D2 test is reversed"));
  EXPECT_THAT(memory.pack_rate->note, HasSubstr("no test is asked for it"));
  EXPECT_THAT(set.memory->hold->note, HasSubstr("no D2 test is reversed"));
}

TEST(FitMemoryNumbers, AreLeftOutWhereTheFormLacksItsLaws) {
  auto set = thesis();
  set.moduli.reset();
  add_memory_numbers({}, {}, set);
  EXPECT_FALSE(set.memory->alpha_P);
  EXPECT_FALSE(set.memory->eps_r);
  EXPECT_FALSE(set.memory->hold);
}

/// D2 between +-0.1 as the law of `set` has it.
TestRecord cycles(const model::ParameterSet& set, double nu) {
  TestRecord test;
  test.name = test.test = "d2-" + to_text(nu);
  test.mode = "d2";
  test.material = set.material;
  test.path = Path::read(Reader(parse_json(R"({"start": {"nu": )" + to_text(nu) + R"(}, "segments": [
      {"mode": "d2", "controls": {"eps_dev": 0.1}}, {"mode": "d2", "controls": {"eps_dev": -0.1}},
      {"mode": "d2", "controls": {"eps_dev": 0.1}}, {"mode": "d2", "controls": {"eps_dev": -0.1}}]})",
                                           "path"),
                                "path"));
  test.nu_start = nu;
  test.legs = test.path.legs(nu);
  model::PredictOptions options;
  options.form = model::Form::memory;
  test.rows = model::predict(set, test.path, options).record;
  return test;
}

/// A set whose exponent and strain of Eq. 5.3 are those that are assumed where no test tells.
model::ParameterSet with_reversals(double eps0_R, double eps_r, double phi_pack, double hold) {
  auto set = thesis();
  add_memory_numbers({}, {}, set);
  set.memory->eps0_R_P->value = eps0_R;
  set.memory->eps_r->value = eps_r;
  set.memory->phi_pack->value = phi_pack;
  set.memory->hold->value = hold;
  return set;
}

TEST(FitMemoryNumbers, OfReversalsComeBackFromTheLawsOwnCycles) {
  const auto truth = with_reversals(0.2, 0.1, 0.6674, 0.35);
  RecordFolder reversals;
  for (const double nu : {0.685, 0.711}) reversals.tests.push_back(cycles(truth, nu));
  auto set = thesis();
  add_memory_numbers({}, reversals, set);
  for (const auto& [number, value, error] : {std::tuple{&set.memory->eps0_R_P, 0.2, 1e-4},
                                             {&set.memory->eps_r, 0.1, 1e-4},
                                             {&set.memory->phi_pack, 0.6674, 1e-6},
                                             {&set.memory->hold, 0.35, 1e-4}}) {
    EXPECT_NEAR((*number)->value, value, error);
    EXPECT_EQ((*number)->source, "fit");
    EXPECT_TRUE((*number)->stderr_);
  }
  EXPECT_EQ(set.memory->pack_rate->source, "assumed");
  EXPECT_EQ(set.memory->eps0_P->source, "assumed");  // of first loadings: none is in the other folder
}

TEST(FitMemoryNumbers, OfReversalsReadTheRecordsThemselvesWhereNoneAreNamed) {
  const auto truth = with_reversals(0.2, 0.1, 0.6674, 0.35);
  RecordFolder records;
  for (const double nu : {0.685, 0.711}) records.tests.push_back(cycles(truth, nu));
  for (TestRecord& test : records.tests) test.role = Role::predict;
  auto set = thesis();
  add_memory_numbers(records, {}, set);
  EXPECT_EQ(set.memory->eps_r->source, "assumed");  // no parameter depends on tests of that role
  for (TestRecord& test : records.tests) test.role = Role::fit;
  add_memory_numbers(records, {}, set);
  EXPECT_EQ(set.memory->eps_r->source, "fit");
  EXPECT_NEAR(set.memory->eps_r->value, 0.1, 1e-3);
}

}  // namespace
}  // namespace grainlaw::calibrate
