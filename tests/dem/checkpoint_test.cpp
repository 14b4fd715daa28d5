// A test that is stopped or killed at any moment and gone on with makes the same record as one left alone, to
// the last bit; a checkpoint that is damaged or another test's is refused.
#include "grainlaw/dem/record/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Coarse: every way to follow a leg, rows and snapshots on each, and lists that are renewed often.
const char* const scene_text = R"({
  "preparation": {"count": 150, "seed": 3, "rate": 1e-3, "relax": {"tolerance": 1e-2, "duration": 100}},
  "path": {"segments": [
    {"mode": "iso", "controls": {"nu": 0.75}, "rate": 5e-4},
    {"mode": "relax", "tolerance": 1e-3, "duration": 200},
    {"mode": "d2", "amount": 0.05, "rate": 2e-4},
    {"mode": "relax", "residual": 1e-4},
    {"mode": "d2", "amount": 0.01, "profile": "quasistatic", "increment": 5e-4, "residual": 1e-4}]},
  "measure": {"rows": 10, "time_step": 0.2, "time_step_gas": 0.1,
    "snapshots": [{"segment": 0, "nu": 0.64}, {"segment": 0, "nu": 0.7}, {"segment": 1}, {"segment": 2}, {"segment": 4}],
    "moduli": [{"segment": 0, "nu": 0.65}, {"segment": 0, "nu": 0.74}, {"segment": 1}, {"segment": 2, "eps_dev": 0.02}]}
})";

Scene scene_of(const std::string& json) {
  return Scene::read(Reader(parse_json(json, "scene.json"), "scene.json"), "");
}

template <class List>
bool same_bits(const List& a, const List& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

class Checkpoints : public testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("grainlaw-checkpoint-" + std::to_string(::getpid()));
    fs::remove_all(dir);
    fs::create_directories(dir);
  }
  void TearDown() override { fs::remove_all(dir); }

  /// Runs the test in `name` until it has looked `looks` times whether to stop; true if it came to its end
  /// before.
  bool run(const std::string& name, int looks = 1 << 30, double checkpoint_every = 1e9) {
    std::atomic<bool> stop = false;
    RunHooks hooks;
    hooks.stop = &stop;
    hooks.checkpoint_every = checkpoint_every;
    hooks.progress = [&](double, const std::string&) {
      if (looks-- <= 0) stop = true;
    };
    return !run_element_test(scene, dir / name, hooks).stopped;
  }
  void expect_same(const std::string& name, const std::string& whole) {
    EXPECT_EQ(read_file(dir / name / "record.csv"), read_file(dir / whole / "record.csv")) << name;
    if (!scene.measure.moduli.empty()) {
      EXPECT_EQ(read_file(dir / name / "moduli.csv"), read_file(dir / whole / "moduli.csv")) << name;
    }
    const auto frames = list_frames(dir / whole / "snapshots.h5");
    ASSERT_EQ(list_frames(dir / name / "snapshots.h5"), frames) << name;
    for (std::size_t k = 0; k < frames.size(); ++k)
      EXPECT_EQ(read_frame(dir / name / "snapshots.h5", {.nu = {}, .frame = k, .segment = {}}),
                read_frame(dir / whole / "snapshots.h5", {.nu = {}, .frame = k, .segment = {}}));
    EXPECT_EQ(fs::exists(dir / name / "rows.csv"), false);
    EXPECT_FALSE(has_checkpoint(dir / name));
  }
  std::string refusal(const std::string& name) {
    try {
      run(name);
    } catch (const Error& error) {
      return error.what();
    }
    return "not refused";
  }

  Scene scene = scene_of(scene_text);
  fs::path dir;
};

TEST_F(Checkpoints, AStoppedTestGoesOnAsIfItHadNot) {
  ASSERT_TRUE(run("whole"));
  int stops = 0;
  while (!run("stopped", 2)) {
    ++stops;
    EXPECT_TRUE(fs::exists(dir / "stopped/checkpoint.bin"));
  }
  EXPECT_GT(stops, 8);
  expect_same("stopped", "whole");
}

TEST_F(Checkpoints, ATestOfFewColumnsGoesOnToo) {
  scene.measure.standard = {"coordination"};
  scene.measure.observe = {"energy"};
  ASSERT_TRUE(run("whole"));
  while (!run("stopped", 5)) {
  }
  expect_same("stopped", "whole");
  // The other columns are those of another scene.
  ASSERT_FALSE(run("other", 5));
  scene.measure.standard = {};
  EXPECT_THAT(refusal("other"), HasSubstr("measure.standard"));
}

TEST_F(Checkpoints, AnIncrementMayBeInterrupted) {
  // Increments that take hundreds of passes, left in their midst, by another thread, after ever longer times.
  scene = scene_of(R"({
    "preparation": {"count": 150, "seed": 3, "rate": 1e-3, "relax": {"tolerance": 1e-2, "duration": 100}},
    "path": {"segments": [
      {"mode": "iso", "controls": {"nu": 0.72}, "profile": "quasistatic", "increment": 0.01, "residual": 1e-10},
      {"mode": "d2", "amount": 0.02, "profile": "quasistatic", "increment": 0.01, "residual": 1e-10}]},
    "measure": {"rows": 2, "time_step": 0.2, "snapshots": [{"segment": 0, "nu": 0.64}, {"segment": 1}]}})");
  ASSERT_TRUE(run("whole"));
  int stops = 0;
  for (std::chrono::microseconds patience{100};; patience = patience * 5 / 4) {
    std::atomic<bool> stop = false;
    RunHooks hooks;
    hooks.stop = &stop;
    std::jthread other([&](const std::stop_token& over) {
      const auto end = std::chrono::steady_clock::now() + patience;
      while (!over.stop_requested() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      stop = true;
    });
    if (!run_element_test(scene, dir / "left", hooks).stopped) break;
    ++stops;
  }
  EXPECT_GT(stops, 5);
  expect_same("left", "whole");
}

TEST_F(Checkpoints, ChangeNoDigit) {
  ASSERT_TRUE(run("whole"));
  ASSERT_TRUE(run("often", 1 << 30, 0));
  expect_same("often", "whole");
}

TEST_F(Checkpoints, AKilledTestGoesOnFromTheNewest) {
  ASSERT_TRUE(run("whole"));
  // Dies without a word at a look of its choice, having written a checkpoint at each of the looks before.
  const auto killed_at_look = [&](int looks) {
    const pid_t child = ::fork();
    if (child == 0) {
      RunHooks hooks;
      hooks.checkpoint_every = 0;
      hooks.progress = [&](double, const std::string&) {
        if (--looks == 0) ::raise(SIGKILL);
      };
      run_element_test(scene, dir / "killed", hooks);
      ::_exit(0);
    }
    int status = 0;
    return ::waitpid(child, &status, 0) == child && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  };
  for (const int looks : {5, 3, 6, 4, 3}) {
    ASSERT_TRUE(killed_at_look(looks));
    EXPECT_TRUE(has_checkpoint(dir / "killed"));
    EXPECT_FALSE(fs::exists(dir / "killed/record.csv"));
  }
  ASSERT_TRUE(run("killed"));
  expect_same("killed", "whole");
}

TEST_F(Checkpoints, RowsSoFarCanBeRead) {
  ASSERT_TRUE(run("whole"));
  int looks = 1;
  while (!fs::exists(dir / "part/rows.csv")) ASSERT_FALSE(run("part", looks++));
  const std::string rows = read_file(dir / "part/rows.csv");
  EXPECT_GT(std::count(rows.begin(), rows.end(), '\n'), 1);
  EXPECT_TRUE(read_file(dir / "whole/record.csv").starts_with(rows));
}

TEST_F(Checkpoints, ASpoiltOneLeavesTheOneBefore) {
  ASSERT_TRUE(run("whole"));
  ASSERT_FALSE(run("a", 5));
  ASSERT_FALSE(run("a", 5));
  const fs::path newest = dir / "a/checkpoint.bin", earlier = dir / "a/checkpoint.old.bin";
  const std::string good = read_file(newest);
  ASSERT_TRUE(fs::exists(earlier));
  const auto with = [&](const std::string& name, const std::string& text) {
    fs::copy(dir / "a", dir / name, fs::copy_options::recursive);
    write_file(dir / name / "checkpoint.bin", text);
    ASSERT_TRUE(run(name));
    expect_same(name, "whole");
  };
  with("cut", good.substr(0, good.size() / 2));
  with("empty", "");
  std::string flipped = good;
  flipped[good.size() / 3] ^= 1;
  with("flipped", flipped);
  // A run that was killed while it wrote or renamed one.
  fs::copy(dir / "a", dir / "renamed", fs::copy_options::recursive);
  fs::rename(dir / "renamed/checkpoint.bin", dir / "renamed/checkpoint.bin.part");
  ASSERT_TRUE(run("renamed"));
  expect_same("renamed", "whole");
}

TEST_F(Checkpoints, WithoutAWholeOneTheTestIsRefused) {
  ASSERT_FALSE(run("a", 5));
  const fs::path newest = dir / "a/checkpoint.bin";
  const std::string good = read_file(newest);
  ASSERT_FALSE(fs::exists(dir / "a/checkpoint.old.bin"));
  std::vector<std::string> spoilt;
  for (const std::size_t length : {0, 7, 8, 100, 1000}) spoilt.push_back(good.substr(0, length));
  spoilt.push_back(good.substr(0, good.size() - 1));
  for (std::size_t at = 0; at < good.size(); at += good.size() / 7) {
    spoilt.push_back(good);
    spoilt.back()[at] ^= 4;
  }
  for (const auto& text : spoilt) {
    write_file(newest, text);
    const std::string why = refusal("a");
    EXPECT_THAT(why, HasSubstr(newest.string() + ": is cut short"));
    EXPECT_THAT(why, HasSubstr("remove " + (dir / "a").string() + " to start the test anew"));
    EXPECT_EQ(read_file(newest), text);  // as evidence
  }
}

TEST_F(Checkpoints, OfAnotherSceneIsRefused) {
  ASSERT_FALSE(run("a", 5));
  scene.measure.rows = 11;
  EXPECT_THAT(refusal("a"), HasSubstr("checkpoint.bin: scene: is of another scene than scene.json "
                                      "(measure.rows: 10 there, 11 here); go on with that scene"));
}

TEST_F(Checkpoints, OfAnotherInstructionSetIsRefused) {
  ASSERT_EQ(simd_targets_here().front(), simd_target());
  ASSERT_FALSE(run("a", 5));
  // What a machine with other instructions would have left, so that one with a single set can test it.
  const fs::path file = dir / "a/checkpoint.bin";
  const std::string ours = read_file(file);
  Json elsewhere = parse_json(ArchiveReader(file).line(), "");
  ASSERT_EQ(elsewhere.at("simd"), simd_target());
  elsewhere.at("simd") = "neon";
  {
    ArchiveWriter archive(file);
    archive.line(elsewhere.dump());
    archive.finish();
  }
  const std::string why = refusal("a");
  EXPECT_THAT(why, HasSubstr("simd: the test ran on neon, this run is on " + simd_target()));
  EXPECT_THAT(why, HasSubstr("go on with --simd neon"));
  write_file(file, ours);
  EXPECT_TRUE(run("a"));
}

TEST_F(Checkpoints, OfAnotherProgramIsRefused) {
  ASSERT_FALSE(run("a", 5));
  const std::string line = ArchiveReader(dir / "a/checkpoint.bin").line();
  const auto refusal_of = [&](const std::string& key, const std::string& value) {
    Json changed = parse_json(line, "");
    changed.at(key) = value;
    ArchiveWriter archive(dir / "a/checkpoint.bin");
    archive.line(changed.dump());
    archive.finish();
    return refusal("a");
  };
  EXPECT_THAT(refusal_of("commit", "0123abc"),
              HasSubstr("commit: was written by grainlaw with commit 0123abc"));
  EXPECT_THAT(refusal_of("version", "9.9.9"),
              HasSubstr("version: was written by grainlaw with version 9.9.9"));
  EXPECT_THAT(refusal_of("compiler", "gcc 1.0.0"), HasSubstr("compiler gcc 1.0.0"));
  EXPECT_THAT(refusal_of("build", "Debug -g"),
              HasSubstr("build: was written by grainlaw with build Debug -g, this one has " +
                        build_options() + ": it may not go on with the same numbers"));
  EXPECT_THAT(refusal_of("format", "grainlaw-checkpoint-7"),
              HasSubstr("format: must be grainlaw-checkpoint-1, got grainlaw-checkpoint-7"));
}

TEST_F(Checkpoints, WithSnapshotsMissingTheTestIsRefused) {
  int looks = 1;
  while (!fs::exists(dir / "a/snapshots.h5")) ASSERT_FALSE(run("a", looks++));
  fs::remove(dir / "a/snapshots.h5");
  EXPECT_THAT(refusal("a"), HasSubstr("snapshots.h5: "));
}

TEST_F(Checkpoints, ATestThatBeginsFromASnapshotNeedsItNoMore) {
  ASSERT_TRUE(run("whole"));
  scene = scene_of(R"({"preparation": {"snapshot": ")" + (dir / "whole/snapshots.h5").string() +
                   R"(", "segment": 1}, "path": {"segments": [{"mode": "d2", "amount": 0.05, "rate": 2e-4}]},
                   "measure": {"rows": 10, "snapshots": [{"segment": 0}]}})");
  ASSERT_TRUE(run("b"));
  ASSERT_FALSE(run("c", 1));
  fs::remove(dir / "whole/snapshots.h5");
  ASSERT_TRUE(run("c"));
  expect_same("c", "b");
}

TEST(KeptDynamics, TakesTheSameStepsAndMakesTheSameListsAtTheSameTime) {
  const Material material;
  Dynamics dynamics(material, test::squeezed(material, 61, 4, 0.7, 0.3));
  const Vec3 rate{1e-3, -2e-3, 5e-4};
  const double dt = time_step(material, dynamics.grains().smallest_radius(), 0.1);
  const auto step = [&](Dynamics& d, const Vec3& from) {
    d.step({from[0] * (1 + rate[0] * dt), from[1] * (1 + rate[1] * dt), from[2] * (1 + rate[2] * dt)}, rate);
  };
  dynamics.start(dt, rate);
  const fs::path file = fs::temp_directory_path() / ("grainlaw-kept-" + std::to_string(::getpid()));
  for (int k = 0; k < 12; ++k) {
    for (int n = 0; n < 37; ++n) step(dynamics, dynamics.cell().length());
    ArchiveWriter writer(file);
    writer(dynamics);
    writer.finish();
    ArchiveReader reader(file);
    Dynamics again(material, reader);
    reader.finish();
    for (int n = 0; n < 50; ++n) {
      step(dynamics, dynamics.cell().length());
      step(again, again.cell().length());
    }
    EXPECT_TRUE(same_bits(again.grains().place, dynamics.grains().place)) << k;
    EXPECT_TRUE(same_bits(again.grains().motion, dynamics.grains().motion)) << k;
    EXPECT_TRUE(same_bits(again.grains().force, dynamics.grains().force)) << k;
    EXPECT_EQ(again.neighbours().updates(), dynamics.neighbours().updates());
  }
  EXPECT_GT(dynamics.neighbours().sorts(), 3u);
  EXPECT_GT(dynamics.neighbours().updates(), dynamics.neighbours().sorts());
  fs::remove(file);
}

}  // namespace
}  // namespace grainlaw::dem
