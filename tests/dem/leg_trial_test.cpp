// What --explain runs of a leg whose work is known only when the grains have run. Times are for
// tests/bench/observers to compare; here, which legs are tried at all, and that grains are left alone.
#include "grainlaw/dem/run/leg_trial.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

constexpr double nu = 0.75;

/// The first stage of a path with this segment, from 200 grains.
Stage stage_of(const std::string& segment) {
  const Scene scene =
      Scene::read(Reader(parse_json(R"({"preparation": {"count": 200, "nu": 0.75}, "path": {"segments": [)" +
                                        segment + R"(]}, "measure": {"rows": 10}})",
                                    "s.json"),
                         "s.json"),
                  "");
  const std::vector<Stage> stages = plan_stages(scene, nu, LongestSteps(scene, scene.material.r_min()));
  return stages.back();
}

State balanced(const Material& material, double at_nu) {
  StaticPacking packing(material, test::squeezed(material, 200, 3, at_nu));
  EXPECT_TRUE(minimise(packing).converged());
  return packing.state();
}

std::optional<LegCost> tried(const std::string& segment, double at_nu, Likeness like) {
  const Material material;
  return try_leg(material, balanced(material, at_nu), stage_of(segment), like);
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

TEST(LegTrial, AWholeLegOrNone) {
  EXPECT_TRUE(tried(R"({"mode": "d2", "amount": 1e-4, "profile": "steered"})", nu, Likeness::all));
  EXPECT_FALSE(tried(R"({"mode": "biaxial", "amount": 0.5, "rate": 1e-8})", nu, Likeness::all));
}

/// A leg of one increment is told whatever it takes, and by how many passes.
TEST(LegTrial, OneIncrementIsAWholeLeg) {
  const Material material;
  const Stage stage = stage_of(R"({"mode": "relax", "residual": 1e-9})");
  ASSERT_EQ(stage.stepping.steps, 1u);
  const auto cost = try_leg(material, test::squeezed(material, 200, 3, nu), stage, Likeness::all);
  ASSERT_TRUE(cost);
  EXPECT_GT(cost->passes, 100);
  EXPECT_GT(cost->seconds, 0);
}

/// One that takes longer than a trial may is left in its midst.
TEST(LegTrial, AnIncrementThatTakesTooLongIsLeft) {
  const Material material;
  const Stage stage = stage_of(R"({"mode": "relax", "residual": 1e-12})");
  EXPECT_FALSE(try_leg(material, test::squeezed(material, 20000, 3, 0.66), stage, Likeness::density));
}

}  // namespace
}  // namespace grainlaw::dem
