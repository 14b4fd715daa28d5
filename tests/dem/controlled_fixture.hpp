// Records of small scenes under control, in a directory of their own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::dem::test {

class ControlledRun : public testing::Test {
 protected:
  void SetUp() override {
    dir = std::filesystem::temp_directory_path() / ("grainlaw-controlled-run-" + std::to_string(::getpid()));
    std::filesystem::remove_all(dir);
  }
  void TearDown() override { std::filesystem::remove_all(dir); }

  static Scene scene_of(const std::string& segments, const std::string& measure, int count, int seed,
                        const std::string& relax) {
    const std::string json = R"({"preparation": {"count": )" + std::to_string(count) + R"(, "seed": )" +
                             std::to_string(seed) + R"(, "nu": 0.72, "rate": 1e-3, "relax": {"duration": )" +
                             relax + R"(}}, "path": {"segments": [)" + segments + R"(]}, "measure": {)" +
                             measure + "}}";
    return Scene::read(Reader(parse_json(json, "scene.json"), "scene.json"), "");
  }

  /// The record of a path on a small jammed packing.
  Record run(const std::string& segments, const std::string& measure = R"("rows": 10)",
             const std::string& name = "a", int count = 150, int seed = 3) {
    summary = run_element_test(scene_of(segments, measure, count, seed, "200"), dir / name);
    return Record::read_csv(dir / name / "record.csv", record_columns());
  }

  /// Stopped again and again, it leaves the same record.
  void expect_goes_on_from_checkpoints(const std::string& segments, const std::string& measure) {
    const Scene scene = scene_of(segments, measure, 150, 3, "50");
    run_element_test(scene, dir / "a");
    int stops = 0;
    RunSummary part;
    for (part.stopped = true; part.stopped; ++stops) {
      std::atomic<bool> stop = false;
      int looks = 0;
      RunHooks hooks;
      hooks.stop = &stop;
      hooks.progress = [&](double, const std::string&) { stop = ++looks > 4; };
      part = run_element_test(scene, dir / "b", hooks);
    }
    EXPECT_GT(stops, 3);
    EXPECT_EQ(read_file(dir / "a" / "record.csv"), read_file(dir / "b" / "record.csv"));
    EXPECT_EQ(list_frames(dir / "b" / "snapshots.h5").size(), list_frames(dir / "a" / "snapshots.h5").size());
  }

  std::filesystem::path dir;
  RunSummary summary;
};

}  // namespace grainlaw::dem::test
