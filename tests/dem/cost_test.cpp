// What --explain says of a scene: planned steps, rows and bytes against a run of it. That the times are right
// is for tests/bench/observers to show: a test machine is too busy.
#include "grainlaw/dem/run/cost.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/record.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;

Scene scene_of(const std::string& json) {
  return Scene::read(Reader(parse_json(json, "s.json"), "s.json"), "");
}

TEST(Cost, OfASceneAgainstItsRun) {
  // Relaxations that cannot end early, so that the planned steps are those taken.
  const Scene scene = scene_of(R"({
    "preparation": {"count": 64, "rate": 2e-3, "relax": {"tolerance": 1e-300, "duration": 5}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-3}, {"mode": "d2", "amount": 0.01, "rate": 1e-3}]},
    "measure": {"rows": 7, "snapshots": [{"segment": 1}], "observe": ["percolation", "radius"]}})");
  const SceneCost cost = cost_of(scene);
  const fs::path dir = fs::temp_directory_path() / ("grainlaw-cost-test-" + std::to_string(::getpid()));
  const RunSummary run = run_element_test(scene, dir);
  EXPECT_DOUBLE_EQ(cost.particle_steps(), static_cast<double>(run.particle_steps));
  EXPECT_EQ(cost.rows, Record::read_csv(dir / "record.csv").rows());
  EXPECT_EQ(cost.snapshots, 1u);
  fs::remove_all(dir);
  ASSERT_EQ(cost.stages.size(), 4u);
  EXPECT_DOUBLE_EQ(cost.stages[0].nu[0], 0.3);
  EXPECT_NEAR(cost.stages[0].nu[1], 0.64, 1e-12);
  EXPECT_NEAR(cost.stages[2].nu[1], 0.7, 1e-12);
  for (const StageCost& stage : cost.stages) EXPECT_GT(stage.seconds, 0) << stage.stage.name;
  ASSERT_EQ(cost.observers.size(), 2u);
  EXPECT_EQ(cost.observers[0].name, "percolation");
  for (const ObserverCost& observer : cost.observers) {
    EXPECT_GT(observer.seconds_per_row, 0);
    EXPECT_GT(observer.bytes, 0);
  }
  // A table is kept in memory until it is written: row, and five columns, of 20 bins.
  EXPECT_GE(cost.observers[1].bytes, 15 * 20 * 6 * 8);
  double fields = 0, held = 0;
  for (const FieldCost& field : cost.fields) {
    fields += field.bytes_per_grain;
    held += field.passing ? 0 : field.bytes_per_grain;
  }
  if (std::isnan(heap_bytes())) {
    EXPECT_TRUE(std::isnan(cost.bytes())) << cost.bytes();
  } else {
    // Both walk the contacts, gathered once; percolation's clusters are gone when radius looks.
    const auto& [percolation, radius] = std::tie(cost.observers[0], cost.observers[1]);
    EXPECT_GT(percolation.network_bytes, 0);
    EXPECT_EQ(percolation.network_bytes, radius.network_bytes);
    const double network = percolation.network_bytes;
    EXPECT_NEAR(
        cost.bytes(),
        64 * held + radius.kept_bytes + network + std::max(64 * (fields - held), percolation.bytes - network),
        1e-6);
  }
}

TEST(Cost, NothingObservedCostsNothing) {
  const SceneCost cost = cost_of(scene_of(R"({"preparation": {"count": 64, "nu": 0.7},
    "path": {"segments": [{"mode": "d2", "amount": 0.01}]}})"));
  EXPECT_TRUE(cost.observers.empty());
  EXPECT_GT(cost.row_seconds, 0);
}

/// A row of no standard columns takes an eighth of one of all; half of it leaves room for a busy machine.
TEST(Cost, OfARowIsThatOfTheColumnsAskedFor) {
  const auto row = [](const std::string& standard) {
    return cost_of(
               scene_of(R"({"preparation": {"count": 2000, "nu": 0.7, "rate": 2e-2, "relax": {"duration": 5}},
      "path": {"segments": [{"mode": "d2", "amount": 1e-4}]}, "measure": {"rows": 1)" +
                        standard + "}}"),
               {1, 60, 1e-6})
        .row_seconds;
  };
  EXPECT_LT(row(R"(, "standard": [])"), 0.2 * row(""));  // 0.04; half of it where contacts are walked through
}

/// A state takes much longer than a row; what it does not ask for, nothing.
TEST(Cost, ModuliCountWithTheRest) {
  const std::string head = R"({"preparation": {"count": 64, "nu": 0.7},
    "path": {"segments": [{"mode": "d2", "amount": 0.01}]}, "measure": {"rows": 1)";
  const SceneCost with =
      cost_of(scene_of(head + R"(, "moduli": [{"segment": 0, "eps_dev": 0.005}, {"segment": 0}]}})"));
  EXPECT_EQ(with.moduli, 2u);
  EXPECT_GT(with.moduli_seconds, with.row_seconds);
  SceneCost less = with;
  less.moduli = 0;
  EXPECT_NEAR(with.seconds() - less.seconds(), 2 * with.moduli_seconds, 1e-9 * with.seconds());
  const SceneCost without = cost_of(scene_of(head + "}}"));
  EXPECT_EQ(without.moduli, 0u);
  EXPECT_EQ(without.moduli_seconds, 0);
}

/// A trial has more steps than such a leg, and must not strain the box on and on.
TEST(Cost, OfAFastLegInASmallBox) {
  const SceneCost cost = cost_of(scene_of(R"({"preparation": {"count": 64, "nu": 0.7},
    "path": {"segments": [{"mode": "components", "strain": [0.02, 0, 0, 0, 0, 0.02], "rate": 0.01}]}})"));
  EXPECT_GT(cost.seconds(), 0);
}

/// Grains once more for each thread, and what lies in their inboxes. Where the allocator does not tell what
/// it holds, memory is unknown, and never said to be less.
TEST(Cost, ThreadsHoldGrainsOfTheirOwn) {
  const Scene scene = scene_of(R"({"preparation": {"count": 300, "nu": 0.7},
    "path": {"segments": [{"mode": "d2", "amount": 0.001}]}, "measure": {"rows": 1}})");
  const double one = cost_of(scene, {1, 60, 1e-6}).bytes(), two = cost_of(scene, {2, 60, 1e-6}).bytes();
  if (std::isnan(heap_bytes())) {
    EXPECT_TRUE(std::isnan(one) && std::isnan(two)) << one << ' ' << two;
    return;
  }
  EXPECT_GT(two - one, 2 * 160 * 300);
  EXPECT_LT(two - one, 2 * 400 * 300);
}

/// What a run leaves on disk, against what was said.
TEST(Cost, OfFilesAgainstThoseOfARun) {
  const Scene scene = scene_of(R"({"preparation": {"count": 400, "nu": 0.7, "rate": 2e-3},
    "path": {"segments": [{"mode": "d2", "amount": 0.001}]},
    "measure": {"rows": 1, "snapshots": [{"segment": 0, "eps_dev": 0}, {"segment": 0}]}})");
  const SceneCost cost = cost_of(scene, {1, 0.02});
  EXPECT_GT(cost.snapshot_seconds, 0);
  EXPECT_GT(cost.checkpoint_seconds, 0);
  SceneCost free = cost;
  free.checkpoint_seconds = 0;
  SceneCost at_once = free;
  at_once.checkpoint_every = 0;  // at every look, a hundred times a second
  EXPECT_NEAR(at_once.checkpoints(), 100 * free.seconds(), 1);
  EXPECT_NEAR(free.checkpoints(), 50 * free.seconds(), 1);
  EXPECT_NEAR(cost.seconds() - free.seconds(), cost.checkpoints() * cost.checkpoint_seconds,
              1e-9 * cost.seconds());
  const fs::path dir = fs::temp_directory_path() / ("grainlaw-cost-files-" + std::to_string(::getpid()));
  std::atomic<bool> stop = false;
  RunHooks hooks;
  hooks.stop = &stop;
  hooks.progress = [&](double done, const std::string&) { stop = done > 0.9; };
  ASSERT_TRUE(run_element_test(scene, dir, hooks).stopped);
  EXPECT_NEAR(static_cast<double>(fs::file_size(dir / "checkpoint.bin")), cost.checkpoint_bytes,
              0.2 * cost.checkpoint_bytes);
  fs::remove_all(dir);
}

/// What is said of a D2 test of `state`, of which nothing is run as a whole.
SceneCost cost_of_d2(const State& state, const std::string& before = "") {
  const fs::path file =
      fs::temp_directory_path() / ("grainlaw-cost-crystal-" + std::to_string(::getpid()) + ".h5");
  SnapshotWriter(file, state.radius).append(state, {state.volume_fraction(), 0, 0, 0});
  const SceneCost cost = cost_of(
      scene_of(R"({"material": {"w": 1}, "preparation": {"snapshot": ")" + file.string() +
               R"("}, "path": {"segments": [)" + before +
               R"({"mode": "d2", "amount": 0.001}]}, "measure": {"rows": 2, "observe": ["contacts"]}})"),
      {1, 60, 1e-6});
  fs::remove(file);
  return cost;
}

/// Not others like them: in a crystal each grain has twelve contacts, in another packing as dense fewer.
TEST(Cost, GrainsOfASnapshotAreTriedThemselves) {
  EXPECT_EQ(cost_of_d2(test::crystal(0.95, 0)).contacts_per_grain, 6);
}

/// The trials lie at both densities between which the path goes. Loosened by 0.3 of strain, a crystal has no
/// contact; as it is, twelve for each grain.
TEST(Cost, GrainsOfASnapshotAreTriedAsTheyAreWhereverThePathGoes) {
  const SceneCost cost =
      cost_of_d2(test::crystal(0.95, 0), R"({"mode": "components", "strain": [-0.1, -0.1, -0.1]}, )");
  EXPECT_EQ(cost.contacts_per_grain, 3);
  EXPECT_GE(cost.observers.at(0).network_bytes, 32 * 6 * sizeof(observe::Touch));
}

/// A trial strains its box by more than a short test does; one that is too narrow for that has other grains.
TEST(Cost, GrainsInANarrowBoxAreNotTriedThemselves) {
  const State wide = test::crystal(0.95, 0);
  State narrow;
  narrow.box = 0.5 * wide.box;
  for (std::size_t i = 0; i < wide.count(); ++i) {
    const auto& x = wide.position[i];
    if (std::max({x[0], x[1], x[2]}) > 0.49 * wide.box(0, 0)) continue;
    narrow.position.push_back(x);
    narrow.velocity.push_back({});
    narrow.radius.push_back(1);
  }
  ASSERT_EQ(narrow.count(), 4u);
  const SceneCost cost = cost_of_d2(narrow);
  EXPECT_GT(cost.contacts_per_grain, 0);
  EXPECT_NE(cost.contacts_per_grain, 6);
}

/// From a snapshot, stages whose steps are known only when the grains have run are run one after the other,
/// those between them too: with time enough, their passes are those of the run.
TEST(Cost, StagesThatAreTriedAsAWholeTakeWhatTheirRunTakes) {
  const fs::path dir = fs::temp_directory_path() / ("grainlaw-cost-chain-" + std::to_string(::getpid()));
  run_element_test(scene_of(R"({"preparation": {"count": 64, "rate": 2e-3, "relax": {"duration": 5}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.75}, "rate": 1e-3}]},
    "measure": {"rows": 1, "snapshots": [{"segment": 0}]}})"),
                   dir / "packing");
  const Scene scene =
      scene_of(R"({"preparation": {"snapshot": ")" + (dir / "packing/snapshots.h5").string() +
               R"("}, "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-4},
      {"mode": "relax", "residual": 1e-6}, {"mode": "relax", "duration": 50},
      {"mode": "triaxial", "amount": 0.05, "rate": 1e-4}]}, "measure": {"rows": 2}})");
  CostOptions options;
  options.trial_seconds = 1000;
  const SceneCost cost = cost_of(scene, options);
  const RunSummary run = run_element_test(scene, dir / "run");
  EXPECT_DOUBLE_EQ(cost.particle_steps(), static_cast<double>(run.particle_steps));
  for (const StageCost& stage : cost.stages) EXPECT_TRUE(stage.tried) << stage.stage.name;
  EXPECT_EQ(cost.least(), cost.most());
  fs::remove_all(dir);
}

/// What is run as a whole is still looked at where it is densest: on the way back down there is no load.
TEST(Cost, RowsAndModuliAreNotThoseOfALooseEnd) {
  const auto along = [](const std::string& segments) {
    return cost_of(scene_of(R"({"preparation": {"count": 200, "rate": 2e-3, "relax": {"duration": 5}},
      "path": {"segments": [)" +
                            segments + R"(]}, "measure": {"rows": 2, "moduli": [{"segment": 0}]}})"),
                   {1, 60, 1000});
  };
  const std::string compress = R"({"mode": "iso", "controls": {"nu": 0.78}, "rate": 2e-3})",
                    loosen = R"({"mode": "iso", "controls": {"nu": 0.6}, "rate": 2e-3})";
  const SceneCost up = along(compress), back = along(compress + ", " + loosen), loose = along(loosen);
  for (const StageCost& stage : back.stages) EXPECT_TRUE(stage.tried) << stage.stage.name;
  EXPECT_GT(back.contacts_per_grain, 0.4 * up.contacts_per_grain);  // the mean of both ends
  // Measured 4.5 to 5.2 times, 3.2 to 3.6 under a sanitizer; 1 where only the end were looked at. Not against
  // `up`: what a process measures first counts what the allocator takes for itself.
  EXPECT_GT(back.moduli_bytes, 2 * loose.moduli_bytes);
}

/// Whatever the flow does to its lists, a short one is run: here one so fast that the grains fly.
TEST(Cost, AShortSceneIsRunFromItsBeginning) {
  const Scene scene = scene_of(R"({
    "preparation": {"count": 64, "rate": 2e-2, "relax": {"tolerance": 1e-2, "duration": 2000}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-2},
      {"mode": "d2", "amount": 0.01, "rate": 1e-2}]}, "measure": {"rows": 1}})");
  const SceneCost run = cost_of(scene), planned = cost_of(scene, {1, 60, 1e-6});
  for (const StageCost& stage : run.stages) EXPECT_TRUE(stage.tried) << stage.stage.name;
  for (const StageCost& stage : planned.stages) EXPECT_FALSE(stage.tried) << stage.stage.name;
  // How early the relaxation ends is known only so.
  EXPECT_LT(run.stages[1].passes, planned.stages[1].passes);
  EXPECT_EQ(run.stages[2].passes, planned.stages[2].passes);
}

/// The range of each stage goes into that of the whole; a relaxation may end at once.
TEST(Cost, RangesAddUp) {
  SceneCost cost = cost_of(scene_of(R"({"preparation": {"count": 64, "nu": 0.7},
    "path": {"segments": [{"mode": "d2", "amount": 0.01}]}, "measure": {"rows": 1}})"),
                           {1, 60, 1e-6});  // too little to run any stage
  ASSERT_EQ(cost.stages.size(), 3u);
  EXPECT_EQ(cost.stages[1].least, 0);
  EXPECT_NEAR(cost.seconds() - cost.least(), cost.stages[1].seconds, 1e-9 * cost.seconds());
  EXPECT_EQ(cost.most(), cost.seconds());
  cost.stages[2].least = 0.5 * cost.stages[2].seconds;
  cost.stages[2].most = 3 * cost.stages[2].seconds;
  EXPECT_NEAR(cost.seconds() - cost.least(), cost.stages[1].seconds + 0.5 * cost.stages[2].seconds,
              1e-9 * cost.seconds());
  EXPECT_NEAR(cost.most() - cost.seconds(), 2 * cost.stages[2].seconds, 1e-9 * cost.seconds());
}

/// Grains of the last row are held all the time, one quad each, and the contacts of the last row; they are no
/// part of what a row takes beside. What only looks keeps nothing of its own.
TEST(Cost, WhatAnObserverKeepsIsHeldAllTheTime) {
  const SceneCost cost =
      cost_of(scene_of(R"({"preparation": {"count": 300, "nu": 0.7}, "path": {"segments": [{"mode": "d2",
    "amount": 0.001}]}, "measure": {"rows": 2, "observe": ["unbalanced", "nonaffine"]}})"),
              {1, 60, 1e-6});
  ASSERT_EQ(cost.observers.size(), 2u);
  const auto& [unbalanced, nonaffine] = std::tie(cost.observers[0], cost.observers[1]);
  EXPECT_EQ(unbalanced.kept_bytes, 0);
  EXPECT_GT(unbalanced.bytes, 0);
  EXPECT_EQ(nonaffine.kept_bytes, 300 * sizeof(Quad));
  EXPECT_GT(nonaffine.bytes, 2 * nonaffine.kept_bytes);
  SceneCost known = cost;  // whatever the allocator tells
  known.fields = {{"held", 1000}, {"for a moment", 1, true}};
  EXPECT_EQ(known.bytes(), 300 * 1000 + nonaffine.bytes + unbalanced.network_bytes);
  known.fields[1].bytes_per_grain = 10000;  // more than a row takes beside what is kept
  EXPECT_EQ(known.bytes(), 300 * (1000 + 10000) + nonaffine.kept_bytes + unbalanced.network_bytes);
}

constexpr double eighth = 20001.0 / 2500;  // of the grains, of which a trial makes copies

/// Segments tried in an eighth of the grains: seconds and their range are those of all.
TEST(Cost, RangesGrowWithTheGrains) {
  const SceneCost cost = cost_of(scene_of(R"({"preparation": {"count": 20001, "nu": 0.7, "rate": 2e-3},
    "path": {"segments": [{"mode": "constant_p", "amount": 0.05, "rate": 1e-3},
                          {"mode": "relax", "residual": 1e-2}]}, "measure": {"rows": 2}})"),
                                 {1, 60, 0.1});
  const StageCost &servo = cost.stages[2], &minimiser = cost.stages[3];
  for (const StageCost& stage : {servo, minimiser}) {
    ASSERT_TRUE(stage.tried) << stage.stage.name;
    EXPECT_NEAR(stage.most / stage.seconds, stage.seconds / stage.least, 1e-9) << stage.stage.name;
    EXPECT_GT(stage.most / stage.seconds, std::exp(0.6) - 1e-9);  // of grains that are only as dense
  }
  const double flow = servo.passes * (cost.force_seconds + cost.motion_seconds);
  EXPECT_GT(servo.seconds, 0.35 * flow);  // in an eighth of the grains it is less
  EXPECT_LT(servo.seconds, 0.35 * eighth * flow);
}

/// A compression that would take longer than it may is told by fewer grains, which take an eighth of that.
TEST(Cost, AFastCompressionOfManyIsToldByFewer) {
  const Scene scene = scene_of(R"({"preparation": {"count": 20001, "rate": 0.1,
      "relax": {"tolerance": 1e-300, "duration": 0.1}},
    "path": {"segments": [{"mode": "d2", "amount": 0.001, "rate": 1e-4}]}, "measure": {"rows": 2}})");
  TrialPacking few(scene.material, 20001, std::get<NewPacking>(scene.preparation));
  const SceneCost untried = cost_of(scene, {1, 60, 1e-6});
  EXPECT_FALSE(untried.stages[0].tried);
  const std::optional<LegCost> fewer = few.run(untried.stages[0].stage, 1000);
  ASSERT_TRUE(fewer);
  bool told = false;  // that may take as long as so many times the fewer do
  for (const double times : {3, 4, 2, 6}) {
    const SceneCost cost = cost_of(scene, {1, 60, times * fewer->seconds});
    const StageCost& gas = cost.stages[0];
    EXPECT_EQ(gas.passes, untried.stages[0].passes);
    told = gas.tried && gas.most > gas.least;
    if (!told) continue;
    EXPECT_GT(gas.seconds, 0.35 * eighth * fewer->seconds);
    EXPECT_LT(gas.least, gas.seconds);
    EXPECT_LT(gas.seconds, gas.most);
    break;
  }
  EXPECT_TRUE(told);
}

TEST(Cost, RefusesWhatARunRefuses) {
  const Scene narrow = scene_of(R"({"preparation": {"count": 8}, "path": {"segments": [
    {"mode": "components", "strain": [1.5, -0.75, -0.75]}]}})");
  EXPECT_THROW(cost_of(narrow), Error);
  // A box that glides is as wide at gamma = 1 as at 0, and narrower between.
  const auto gliding = [](const char* gamma) {
    return scene_of(R"({"preparation": {"count": 8, "nu": 0.7}, "path": {"segments": [
      {"mode": "iso", "controls": {"nu": 0.86}}, {"mode": "components", "strain": [0.16, 0.16, -0.32]},
      {"mode": "simple_shear", "amount": )" +
                    std::string(gamma) + "}]}}");
  };
  for (const char* gamma : {"0.5", "1", "-3"}) {
    try {
      cost_of(gliding(gamma));
      ADD_FAILURE() << gamma;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("path.segments[2]: makes the box")) << gamma;
    }
  }
}

}  // namespace
}  // namespace grainlaw::dem
