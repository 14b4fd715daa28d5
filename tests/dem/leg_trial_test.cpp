// What --explain runs of a leg whose work is known only when the grains have run. Times are for
// tests/bench/observers to compare; here, which legs are tried at all, and that grains are left alone.
#include "grainlaw/dem/run/leg_trial.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "packings.hpp"
#include "planned_stage.hpp"

namespace grainlaw::dem {
namespace {

constexpr double nu = 0.75;

Stage stage_of(const std::string& segment) { return test::planned_stage(segment, nu, 10); }

State balanced(const Material& material, double at_nu) {
  StaticPacking packing(material, test::squeezed(material, 200, 3, at_nu));
  EXPECT_TRUE(minimise(packing).converged());
  return packing.state();
}

std::optional<LegCost> tried(const std::string& segment, double at_nu, Likeness like,
                             std::optional<double> budget = {}) {
  const Material material;
  return try_leg(material, balanced(material, at_nu), stage_of(segment), like,
                 budget.value_or(usual_trial(like)));
}

TEST(LegTrial, OnlyWhatDependsOnTheGrainsNeedsOne) {
  EXPECT_FALSE(needs_trial(stage_of(R"({"mode": "d2", "amount": 0.01})")));
  EXPECT_FALSE(needs_trial(stage_of(R"({"mode": "relax"})")));
  EXPECT_TRUE(needs_trial(stage_of(R"({"mode": "relax", "residual": 1e-6})")));
  EXPECT_TRUE(needs_trial(stage_of(R"({"mode": "d2", "amount": 0.01, "profile": "steered"})")));
  EXPECT_TRUE(needs_trial(stage_of(R"({"mode": "biaxial", "amount": 0.01})")));
}

TEST(LegTrial, LegsThatStrainCostTimeAndMinimisersMemory) {
  const auto biaxial = tried(R"({"mode": "biaxial", "amount": 0.5})", nu, Likeness::density);
  ASSERT_TRUE(biaxial);
  EXPECT_GT(biaxial->seconds, 0.5);  // more than the part that is run
  EXPECT_EQ(biaxial->bytes, 0);
  const auto increments =
      tried(R"({"mode": "d2", "amount": 0.001, "profile": "quasistatic"})", nu, Likeness::density);
  ASSERT_TRUE(increments);
  EXPECT_GT(increments->seconds, 0);
  if (std::isnan(heap_bytes())) {
    EXPECT_TRUE(std::isnan(increments->bytes)) << increments->bytes;
  } else {
    EXPECT_GT(increments->bytes, 200 * 100);  // grains and their network once more
  }
}

/// Another pressure than that of the grains tried: the way there is left out, or it would never end.
TEST(LegTrial, StressTargetsAreThoseAtTheStartUnlessTheGrainsAreTheScenes) {
  const std::string far = R"({"mode": "constant_p", "P": 1e-6, "amount": 0.001, "servo": {"wait": 1}})";
  EXPECT_TRUE(tried(far, nu, Likeness::density));
  EXPECT_FALSE(tried(far, nu, Likeness::all));
}

TEST(LegTrial, NothingIsToldWhereALegWaitsOrGrainsBearNothing) {
  EXPECT_FALSE(tried(R"({"mode": "isotropic_stress", "P": 0.05})", nu, Likeness::density));
  EXPECT_FALSE(tried(R"({"mode": "biaxial", "amount": 0.01})", 0.3, Likeness::density));
}

/// From the grains that it begins with, a leg is told by its part where it does not end within its time.
TEST(LegTrial, AWholeLegOrByItsPart) {
  const auto whole = tried(R"({"mode": "d2", "amount": 1e-4, "profile": "steered"})", nu, Likeness::all);
  ASSERT_TRUE(whole && whole->ended);
  EXPECT_EQ(whole->least, whole->seconds);
  EXPECT_EQ(whole->most, whole->seconds);
  const auto part = tried(R"({"mode": "biaxial", "amount": 0.5})", nu, Likeness::all, 0.1);
  ASSERT_TRUE(part);
  EXPECT_FALSE(part->ended);
  EXPECT_GT(part->seconds, 0.1);
  EXPECT_LT(part->least, part->seconds);
  EXPECT_GT(part->most, part->seconds);
}

/// What more time buys: the same leg, of which a part was told, as a whole.
TEST(LegTrial, WithMoreTimeALegIsTriedAsAWhole) {
  const std::string segment = R"({"mode": "biaxial", "amount": 0.02})";
  const auto part = tried(segment, nu, Likeness::all, 0.02);
  const auto whole = tried(segment, nu, Likeness::all, 1000);
  ASSERT_TRUE(part && whole);
  EXPECT_FALSE(part->ended);
  ASSERT_TRUE(whole->ended);
  EXPECT_GT(part->most, part->least);
  EXPECT_EQ(whole->most, whole->least);
}

std::vector<LegMark> even(double share, double passes) {
  std::vector<LegMark> seen;
  for (int k = 1; k <= 100; ++k) seen.push_back({share * k / 100, passes * k / 100});
  return seen;
}

/// Where the grains do as planned, so does the rest; the plan counts as a tenth of the leg.
TEST(LegTrial, PartsAreExtrapolatedTowardsThePlan) {
  const LegPasses as_planned = passes_of(even(0.5, 500), 1000, Likeness::all);
  const double e = 0.2 / std::sqrt(0.6);
  EXPECT_NEAR(as_planned.all, 1000, 1e-9);
  EXPECT_NEAR(as_planned.least, 500 + 500 * std::exp(-e), 1e-6);
  EXPECT_NEAR(as_planned.most, 500 + 500 * std::exp(e), 1e-6);
  EXPECT_NEAR(passes_of(even(0.1, 300), 1000, Likeness::all).all, 300 + 0.9 * (300 + 100) / 0.2, 1e-9);
  const LegPasses as_dense = passes_of(even(0.5, 500), 1000, Likeness::density);
  EXPECT_NEAR(as_dense.most / as_dense.all, std::exp(std::hypot(0.5 * e, 0.6)), 1e-9);
  EXPECT_NEAR(as_dense.all / as_dense.least, as_dense.most / as_dense.all, 1e-9);
}

/// Cost that comes in bursts widens the range, and independent bursts stay in it.
TEST(LegTrial, RangesHoldForIndependentBursts) {
  int held = 0, widened = 0;
  constexpr int legs = 400;
  Random random(5);
  for (int leg = 0; leg < legs; ++leg) {
    std::vector<LegMark> marks;
    double passes = 0;
    for (int k = 1; k <= 100; ++k) {
      passes += random.uniform() < 0.1 ? 60 : 4;  // 9.6 in the mean
      marks.push_back({0.01 * k, passes});
    }
    const LegPasses told = passes_of({marks.begin(), marks.begin() + 30}, 960, Likeness::all);
    held += told.least <= passes && passes <= told.most ? 1 : 0;
    const LegPasses smooth = passes_of(even(0.3, marks[29].passes), 960, Likeness::all);
    EXPECT_GE(told.most, smooth.most);
    widened += told.most > 1.1 * smooth.most ? 1 : 0;
  }
  EXPECT_GT(widened, legs / 2);
  EXPECT_GT(held, 0.9 * legs);
}

/// A leg of one increment is told whatever it takes, and by how many passes.
TEST(LegTrial, OneIncrementIsAWholeLeg) {
  const Material material;
  const Stage stage = stage_of(R"({"mode": "relax", "residual": 1e-9})");
  ASSERT_EQ(stage.stepping.steps, 1u);
  const auto cost = try_leg(material, test::squeezed(material, 200, 3, nu), stage, Likeness::all, 1.5);
  ASSERT_TRUE(cost);
  EXPECT_GT(cost->passes, 100);
  EXPECT_GT(cost->seconds, 0);
}

/// One that takes longer than a trial may is left in its midst.
TEST(LegTrial, AnIncrementThatTakesTooLongIsLeft) {
  const Material material;
  const Stage stage = stage_of(R"({"mode": "relax", "residual": 1e-12})");
  EXPECT_FALSE(try_leg(material, test::squeezed(material, 20000, 3, 0.66), stage, Likeness::density, 0.5));
}

}  // namespace
}  // namespace grainlaw::dem
