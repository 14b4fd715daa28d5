// What --explain runs of fast compressions, in fewer grains than the scene has: which stages, in which order,
// and with which grains. Seconds are for tests/bench/observers and docs/engine.md.
#include "grainlaw/dem/run/fast_trial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::dem {
namespace {

constexpr double time_enough = 1000;      // s
constexpr std::int64_t laid_out = 20001;  // grains, of which a trial makes copies

Scene scene_of(const std::string& preparation, const std::string& segments) {
  return Scene::read(
      Reader(parse_json(R"({"preparation": {"count": 20001, )" + preparation +
                            R"(}, "path": {"segments": [)" + segments + R"(]}, "measure": {"rows": 2}})",
                        "s.json"),
             "s.json"),
      "");
}

/// Its stages as they are planned.
std::vector<StageCost> planned(const Scene& scene) {
  const auto& packing = std::get<NewPacking>(scene.preparation);
  std::vector<StageCost> list;
  double nu = packing.nu_gas;
  for (const Stage& stage : plan_stages(scene, packing.nu, LongestSteps(scene, scene.material.r_min()))) {
    const StrainTensor& strain = stage.leg.strain;
    const double after = nu * std::exp(strain[0] + strain[1] + strain[2]);
    list.push_back({stage, {nu, after}, static_cast<double>(stage.passes())});
    nu = after;
  }
  return list;
}

TrialPacking gas_of(const Scene& scene) {
  return {scene.material, static_cast<std::size_t>(laid_out), std::get<NewPacking>(scene.preparation)};
}

std::vector<std::optional<LegCost>> tried(const Scene& scene, double budget = time_enough) {
  return try_fast_stages(gas_of(scene), scene.material, planned(scene), budget);
}

const std::string fast_gas = R"("rate": 0.1, "relax": {"tolerance": 1e-300, "duration": 0.1})";
const std::string fast_iso = R"({"mode": "iso", "controls": {"nu": 0.7}, "rate": 0.05})",
                  fast_d2 = R"({"mode": "d2", "amount": 0.01, "rate": 0.01})",
                  slow_iso = R"({"mode": "iso", "controls": {"nu": 0.66}, "rate": 1e-4})",
                  rest = R"({"mode": "relax", "duration": 0.5, "tolerance": 1e-300})";

TEST(FastTrial, OfWhatChangesTheDensityFast) {
  const std::vector<StageCost> stages =
      planned(scene_of(fast_gas, fast_iso + ", " + fast_d2 + ", " + slow_iso + ", " + rest +
                                     R"(, {"mode": "triaxial", "amount": 0.01, "rate": 0.05})"));
  const std::vector<bool> expected{true, false, true, false, false, false, false};
  ASSERT_EQ(stages.size(), expected.size());
  for (std::size_t k = 0; k < stages.size(); ++k)
    EXPECT_EQ(compresses_fast(stages[k].stage), expected[k]) << stages[k].stage.name;
  // 1e-5 of strain a step.
  Stage edge = stages[2].stage;
  edge.leg.strain = {0.001, 0, 0, 0, 0, 0};
  edge.stepping.steps = 101;
  EXPECT_FALSE(compresses_fast(edge));
  edge.stepping.steps = 99;
  EXPECT_TRUE(compresses_fast(edge));
}

/// From a fast compression until most of the time is spent at rest, or the energy is minimised.
TEST(FastTrial, GrainsMoveUntilTheyRest) {
  const std::string long_rest = R"({"mode": "relax", "duration": 300})",
                    minimised = R"({"mode": "relax", "residual": 1e-3})",
                    once_more = R"({"mode": "iso", "controls": {"nu": 0.72}, "rate": 0.05})";
  const std::vector<StageCost> stages = planned(scene_of(
      fast_gas, fast_d2 + ", " + rest + ", " + slow_iso + ", " + fast_d2 + ", " + rest + ", " + fast_iso +
                    ", " + minimised + ", " + rest + ", " + once_more + ", " + long_rest + ", " + rest));
  std::vector<bool> expected{true, true, true, true, true, true, true, true, true, false, true, false, false};
  EXPECT_EQ(still_moving(stages, 250), expected);  // us; the slow stage takes 103
  expected[4] = expected[5] = expected[6] = false;
  EXPECT_EQ(still_moving(stages, 100), expected);
  expected[4] = expected[5] = expected[6] = expected[11] = expected[12] = true;
  EXPECT_EQ(still_moving(stages, std::numeric_limits<double>::infinity()), expected);
}

TEST(FastTrial, TheBackgroundBringsGrainsToRest) {
  Material material;  // of Table 2.1: t_b = 83.78 us
  EXPECT_NEAR(time_to_rest(material), 7 * 83.78, 0.1);
  material.gamma_b = 0;
  EXPECT_TRUE(std::isinf(time_to_rest(material)));
}

/// Slow stages cost nothing until a fast one comes, however many they are.
TEST(FastTrial, SlowStagesTakeNoTime) {
  const std::string slow = R"({"mode": "iso", "controls": {"nu": 0.66}, "rate": 1e-4},
      {"mode": "iso", "controls": {"nu": 0.64}, "rate": 1e-4})";
  const Scene scene =
      scene_of(R"("rate": 1e-4)", R"({"repeat": 500, "segments": [)" + slow + "]}, " + fast_iso);
  const auto seconds = [](const Scene& of) {
    const double begin = thread_seconds();
    EXPECT_TRUE(tried(of).back());
    return thread_seconds() - begin;
  };
  // Otherwise a thousand compressions, each as much work as all of the one.
  const double one = seconds(scene_of(R"("rate": 1e-4)", fast_iso));
  EXPECT_LT(seconds(scene), 10 * one);
}

/// Every step of them is known, and the range is on either side.
TEST(FastTrial, TellsWhatMovesFast) {
  const Scene scene = scene_of(fast_gas, rest + ", " + fast_iso + ", " + fast_d2 + ", " + slow_iso);
  const auto told = tried(scene);
  const std::vector<StageCost> stages = planned(scene);
  for (std::size_t k = 0; k + 1 < stages.size(); ++k) {
    ASSERT_TRUE(told[k]) << stages[k].stage.name;
    EXPECT_EQ(told[k]->passes, stages[k].passes) << stages[k].stage.name;
    EXPECT_NEAR(told[k]->seconds / told[k]->least, std::exp(0.25), 1e-9);
    EXPECT_NEAR(told[k]->most / told[k]->seconds, std::exp(0.25), 1e-9);
  }
  EXPECT_FALSE(told.back());  // slow, and nothing fast comes after it
}

/// Slow stages are left to the trials at rest, also where fast ones follow; a rest after a slow one, too.
/// Then grains are as dense as there, and at rest: how soon they are again, to the step, tells.
TEST(FastTrial, LeavesSlowStagesAlone) {
  const Scene scene = scene_of(R"("rate": 1e-4)", rest + R"(, {"mode": "iso", "controls": {"nu": 0.7},
    "rate": 6e-4}, {"mode": "relax", "duration": 100, "tolerance": 0.01})");
  const auto told = tried(scene);
  ASSERT_EQ(told.size(), 5u);
  EXPECT_FALSE(told[0] || told[1] || told[2]);
  ASSERT_TRUE(told[3] && told[4]);
  TrialPacking few = gas_of(scene);
  few.compress_to(0.64);
  few.settle();
  const std::vector<StageCost> stages = planned(scene);
  few.run(stages[3].stage, time_enough);
  const auto by_hand = few.run(stages[4].stage, time_enough);
  EXPECT_EQ(told[4]->passes, by_hand->passes);
}

/// What a servo makes of the box is not known, so that nothing after it is.
TEST(FastTrial, EndsWhereAServoComes) {
  const auto told =
      tried(scene_of(fast_gas, R"({"mode": "constant_p", "amount": 0.01, "rate": 0.001}, )" + fast_iso));
  EXPECT_TRUE(told[0] && told[1]);
  EXPECT_FALSE(told[2] || told[3]);
}

/// A relaxation that comes to its end early does so sooner or later in other grains.
TEST(FastTrial, ARestThatEndsEarlyHasAWiderRange) {
  const Scene scene =
      scene_of(R"("nu": 0.68, "rate": 0.02, "relax": {"tolerance": 0.9, "duration": 100})", fast_d2);
  const auto told = tried(scene);
  ASSERT_TRUE(told[1]);
  EXPECT_LT(told[1]->passes, planned(scene)[1].passes);
  EXPECT_NEAR(told[1]->most / told[1]->seconds, std::exp(0.5), 1e-9);
}

/// Neither where there is none, nor of a stage that takes longer.
TEST(FastTrial, TellsNothingWithoutTime) {
  const Scene scene = scene_of(R"("rate": 0.01)", fast_iso);  // 2000 steps, of which 200 take longer
  for (const double budget : {1e-9, 1e-3})
    for (const auto& stage : tried(scene, budget)) EXPECT_FALSE(stage) << budget;
}

/// The grains are those that a run of fewer has, to the last bit: hot, with all that came before.
TEST(FastTrial, GrainsGoAsInARun) {
  const Scene scene = scene_of(fast_gas, fast_iso);
  TrialPacking few = gas_of(scene);
  NewPacking own = std::get<NewPacking>(scene.preparation);
  own.count = static_cast<std::int64_t>(few.base().count());
  Dynamics grains(scene.material, random_gas(scene.material, own));
  for (const StageCost& cost : planned(scene)) {
    const auto told = few.run(cost.stage, time_enough);
    ASSERT_TRUE(told && told->ended);
    drive(grains, cost.stage.leg, cost.stage.stepping);
    grains.begin_anew(grains.state());
    EXPECT_EQ(few.base().velocity, grains.state().velocity) << cost.stage.name;
  }
  EXPECT_NEAR(few.base().volume_fraction(), 0.7, 1e-9);
}

/// Also in a sheared box: copies lie along its edges, and have the same neighbours as the one.
TEST(TrialPacking, CopiesLieAlongTheEdgesOfTheBox) {
  const Scene scene = scene_of(fast_gas, R"({"mode": "simple_shear", "amount": 0.7, "rate": 0.05})");
  NewPacking own = std::get<NewPacking>(scene.preparation);
  own.count = 100;
  Dynamics grains(scene.material, random_gas(scene.material, own));
  for (const StageCost& cost : planned(scene)) drive(grains, cost.stage.leg, cost.stage.stepping);
  const Dynamics one(scene.material, grains.state()), many(scene.material, dem::laid_out(grains.state(), 2));
  EXPECT_GT(one.measure().contacts, 0u);
  EXPECT_EQ(many.measure().contacts, 8 * one.measure().contacts);
}

}  // namespace
}  // namespace grainlaw::dem
