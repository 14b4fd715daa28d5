// grainlaw simulate: a record appears whole or not at all.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "grainlaw/dem/files/snapshot.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::string scene(const std::string& duration) {
  return R"({"preparation": {"count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "duration": )" +
         duration + R"(}]}, "measure": {"rows": 10, "time_step": 0.2, "time_step_gas": 0.1}})";
}

class Simulate : public Program {
 protected:
  /// A run that takes minutes, once it is under way.
  std::unique_ptr<Running> start_long() {
    write("long.json", scene("1e8"));
    auto running = std::make_unique<Running>(folder, Arguments{"simulate", "long.json", "-o", "out/x"});
    EXPECT_TRUE(eventually([&] { return fs::exists(folder / "out/x.part/scene.json"); }));
    return running;
  }
};

TEST_F(Simulate, WritesARecord) {
  write("s.json", scene("200"));
  const Outcome outcome = run({"simulate", "s.json", "-o", "out/x/"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("wrote out/x/record.csv"));
  EXPECT_THAT(listing("out"), ElementsAre("x", "x/provenance.json", "x/record.csv", "x/scene.json"));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "out/x"}),
                      {"out/x: is not empty, and nothing in it is overwritten"}));
}

TEST_F(Simulate, ExplainSaysWhatIsAGuess) {
  // Grains that bear no load have no stress to keep at its start, so nothing of the servo can be tried.
  write("s.json", R"({"preparation": {"count": 64, "nu": 0.5, "rate": 2e-3, "relax": {"duration": 5}},
    "path": {"segments": [{"mode": "triaxial", "stress": 0.01, "amount": 0.5}, {"mode": "d2", "amount": 0.01}]},
    "measure": {"rows": 2}})");
  const Outcome outcome = run({"simulate", "s.json", "--explain", "--explain-seconds", "0.01"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::ContainsRegex("triaxial \\(1 of 2\\) +from 0.5 .*not tried, perhaps "));
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("d2 \\(2 of 2\\) +\\(0\\.[0-9]+\\) "));  // a density in brackets
  EXPECT_THAT(outcome.out, testing::ContainsRegex("in all: .*, perhaps "));
}

/// A compression so fast that grains do not come to rest takes more than at rest; with time it is run.
TEST_F(Simulate, ExplainSaysWhatFliesAndWasNotTried) {
  write("s.json", R"({"preparation": {"count": 2000, "rate": 1e-2, "relax": {"duration": 5}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "rate": 1e-2},
                          {"mode": "iso", "controls": {"nu": 0.72}, "rate": 5e-5}]}, "measure": {"rows": 2}})");
  const Outcome brief = run({"simulate", "s.json", "--explain", "--explain-seconds", "0.01"});
  ASSERT_EQ(brief.status, 0) << brief.err;
  EXPECT_THAT(brief.out, testing::ContainsRegex("compress the gas .* or more, for its grains still move\n"));
  EXPECT_THAT(brief.out,
              testing::ContainsRegex("relax the packing .* perhaps .*, for its grains still move\n"));
  EXPECT_THAT(brief.out, testing::ContainsRegex("iso \\(1 of 2\\) .* or more, for its grains still move\n"));
  EXPECT_THAT(brief.out, testing::ContainsRegex("iso \\(2 of 2\\) .* [0-9.]+ [mu]?s\n"));  // slow
  EXPECT_THAT(brief.out, testing::ContainsRegex("in all: .* or more of one core"));
  const Outcome whole = run({"simulate", "s.json", "--explain", "--explain-seconds", "1000"});
  EXPECT_THAT(whole.out, testing::Not(HasSubstr("or more")));
}

TEST_F(Simulate, KeepsTheRowsOfAMotionThatCannotGoOn) {
  // Boxes that grains cross in every step: sooner or later two of them meet at one point.
  write("s.json", R"({"preparation": {"count": 64, "nu": 0.7, "rate": 2e-3},
    "path": {"segments": [{"mode": "d2", "amount": 0.02, "rate": 1e-3},
                          {"repeat": 1000, "segments": [{"mode": "simple_shear", "amount": 100, "rate": 50}]}]},
    "measure": {"rows": 5}})");
  EXPECT_TRUE(
      refuses(run({"simulate", "s.json", "-o", "x"}),
              {"s.json: path.segments[1].segments[0]: ", "; rows until then are in ", "x.part/rows.csv"}));
  const std::string rows = read("x.part/rows.csv");
  EXPECT_GE(std::count(rows.begin(), rows.end(), '\n'), 6);  // those of the first segment at least
  EXPECT_FALSE(fs::exists(folder / "x"));
}

TEST_F(Simulate, ExplainsAndMakesNothing) {
  std::string json = scene("200");
  json.insert(json.find("\"rows\""), R"("observe": ["percolation"], )");
  json.insert(json.find("\"preparation\""), R"("material": {"gamma_b": 0}, )");
  write("s.json", json);
  const Outcome outcome = run({"simulate", "s.json", "--explain"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("s.json: 64 grains, w = 3"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("gamma d\\(delta\\)/dt +on, 1000 ug/us"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("gamma_b v +off"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("motion and lists of pairs +[0-9.]+ us of a step"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("checkpoints: 0, each .* on disk"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("compress the gas +0.3 to 0.64"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("iso \\(1 of 1\\) +0.64 to 0.7"));
  EXPECT_THAT(outcome.out, HasSubstr("measured in 11 rows"));
  EXPECT_THAT(
      outcome.out,
      testing::ContainsRegex("standard columns +[0-9].*\n    stress, fabric, coordination, energy_ratio\n"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("percolation +[0-9]"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("in all: .* particle-steps, .* of one core"));
  for (const auto& file : fs::directory_iterator(folder))
    EXPECT_TRUE(file.is_symlink() || !file.is_directory()) << file.path();
}

TEST_F(Simulate, ExplainsWhichColumnsASceneLeavesOut) {
  const auto explained = [&](const std::string& standard) {
    write("s.json", R"({"preparation": {"count": 64, "nu": 0.6, "rate": 1e-2, "relax": {"duration": 5}},
      "path": {"segments": [{"mode": "d2", "amount": 0.001, "rate": 1e-3}]},
      "measure": {"rows": 2, "standard": )" +
                        standard + "}}");
    const Outcome outcome = run({"simulate", "s.json", "--explain"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_THAT(explained(R"(["energy_ratio", "stress"])"),
              HasSubstr("\n    stress, energy_ratio; measure.standard leaves out fabric, coordination\n"));
  EXPECT_THAT(explained(R"(["energy_ratio", "stress"])"), Not(HasSubstr("not watched")));
  EXPECT_THAT(explained("[]"),
              HasSubstr("\n    none but segment, strains, nu, phi_J and t; measure.standard leaves out "
                        "stress, fabric, coordination, energy_ratio\n    so E_k/E_p is not watched\n"));
}

TEST_F(Simulate, ExplainsForAsLongAsItIsTold) {
  write("s.json", R"({"preparation": {"count": 64, "nu": 0.7, "rate": 1e-2, "relax": {"duration": 50}},
    "path": {"segments": [{"mode": "triaxial", "amount": 0.5, "rate": 1e-7}]}, "measure": {"rows": 2}})");
  const Outcome brief = run({"simulate", "s.json", "--explain", "--explain-seconds", "0.5"});
  ASSERT_EQ(brief.status, 0) << brief.err;
  EXPECT_THAT(brief.out,
              testing::ContainsRegex("triaxial \\(1 of 1\\) +from 0.7 .* about .* \\(.* to .*\\), several"));
  EXPECT_THAT(brief.out, testing::ContainsRegex("in all: .* to .* or more of one core"));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "out/x", "--explain-seconds", "1"}),
                      {"--explain-seconds: is for --explain alone"}));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "--explain", "--explain-seconds", "0"}),
                      {"--explain-seconds: must be a number"}));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "--explain=5"}), {"explain"}));
}

TEST_F(Simulate, NeedsAFolder) {
  write("s.json", scene("200"));
  EXPECT_TRUE(refuses(run({"simulate", "s.json"}), {"-o DIR is missing"}));
}

TEST_F(Simulate, InterruptedItSaysHowToGoOn) {
  const auto running = start_long();
  running->send(SIGINT);
  const Outcome outcome = running->wait();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.err, "stopped; go on with: grainlaw simulate long.json -o out/x --resume\n");
  EXPECT_TRUE(fs::exists(folder / "out/x.part/checkpoint.bin"));
  EXPECT_TRUE(refuses(run({"simulate", "long.json", "-o", "out/x"}),
                      {"out/x: holds an interrupted test; go on with --resume, or remove ", "/out/x.part"}));
  write("s.json", scene("200"));
  EXPECT_TRUE(
      refuses(run({"simulate", "s.json", "-o", "out/x", "--resume"}),
              {"checkpoint.bin: scene: is of another scene than s.json (path.segments[0].duration: "}));
  Running again(folder, {"simulate", "long.json", "-o", "out/x", "--resume", "--checkpoint", "0"});
  EXPECT_TRUE(eventually([&] { return fs::exists(folder / "out/x.part/checkpoint.old.bin"); }));
  again.send(SIGTERM);
  EXPECT_EQ(again.wait().status, 130);
}

TEST_F(Simulate, InterruptedUnderTheEntryScriptItNamesTheScript) {
  ::setenv("GRAINLAW_HOME", "/elsewhere", 1);
  const auto running = start_long();
  running->send(SIGINT);
  EXPECT_EQ(running->wait().err,
            "stopped; go on with: /elsewhere/grainlaw simulate long.json -o out/x --resume\n");
}

TEST_F(Simulate, KilledAtAnyMomentItGoesOnBitForBit) {
  write("s.json",
        R"({"preparation": {"count": 64, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.7}, "duration": 4000}]},
    "measure": {"rows": 10, "time_step": 0.2, "time_step_gas": 0.1,
      "snapshots": [{"segment": 0, "nu": 0.65}, {"segment": 0}]}})");
  ASSERT_EQ(run({"simulate", "s.json", "-o", "whole"}).status, 0);
  // Each run gets to a checkpoint of its own and is killed some time after; some ten are written in a ms, so
  // that some of the kills hit one being written.
  int killed = 0;
  const fs::path checkpoint = folder / "x.part/checkpoint.bin";
  const auto written = [&] {
    std::error_code none;
    const auto time = fs::last_write_time(checkpoint, none);
    return none ? fs::file_time_type::min() : time;
  };
  for (const int moment : {23, 41, 17, 35, 29, 53, 19, 47}) {
    if (fs::exists(folder / "x")) break;
    Arguments arguments{"simulate", "s.json", "-o", "x", "--checkpoint", "0"};
    if (fs::exists(folder / "x.part")) arguments.push_back("--resume");
    const auto before = written();
    Running running(folder, arguments);
    ASSERT_TRUE(eventually([&] { return written() != before || fs::exists(folder / "x"); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(moment / 4));
    running.send(SIGKILL);
    killed += running.wait().status == 128 + SIGKILL ? 1 : 0;
  }
  EXPECT_GT(killed, 1);
  if (!fs::exists(folder / "x")) {
    const Outcome outcome = run({"simulate", "s.json", "-o", "x", "--resume"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(read("x/record.csv"), read("whole/record.csv"));
  EXPECT_EQ(listing("x"), listing("whole"));
  const auto frame = [&](const std::string& name) {
    return dem::read_frame(folder / name / "snapshots.h5", {});
  };
  EXPECT_EQ(dem::list_frames(folder / "x/snapshots.h5"), dem::list_frames(folder / "whole/snapshots.h5"));
  EXPECT_EQ(frame("x"), frame("whole"));
}

TEST_F(Simulate, WhatAKilledRunLeftIsCleared) {
  const auto running = start_long();
  running->send(SIGKILL);
  running->wait();
  EXPECT_FALSE(fs::exists(folder / "out/x"));
  write("s.json", scene("200"));
  EXPECT_EQ(run({"simulate", "s.json", "-o", "out/x"}).status, 0);
  EXPECT_THAT(listing("out"), ElementsAre("x", "x/provenance.json", "x/record.csv", "x/scene.json"));
}

TEST_F(Simulate, KilledBeforeItNamesItsRecordItOnlyNamesIt) {
  write("s.json", scene("200"));
  ASSERT_EQ(run({"simulate", "s.json", "-o", "x"}).status, 0);
  fs::rename(folder / "x", folder / "x.part");
  const std::string record = read("x.part/record.csv");
  EXPECT_TRUE(
      refuses(run({"simulate", "s.json", "-o", "x"}), {"holds an interrupted test; go on with --resume"}));
  write("other.json", scene("210"));
  EXPECT_TRUE(
      refuses(run({"simulate", "other.json", "-o", "x", "--resume"}), {"is another scene", "remove"}));
  EXPECT_EQ(run({"simulate", "s.json", "-o", "x", "--resume"}).status, 0);
  EXPECT_EQ(read("x/record.csv"), record);
  EXPECT_FALSE(fs::exists(folder / "x.part"));
}

TEST_F(Simulate, RefusesToReplaceWhatItReads) {
  std::string with_snapshot = scene("200");
  with_snapshot.replace(with_snapshot.find("\"rows\""), 0, R"("snapshots": [{"segment": 0}], )");
  write("s.json", with_snapshot);
  ASSERT_EQ(run({"simulate", "s.json", "-o", "x"}).status, 0);
  // As a run that is killed before its first checkpoint leaves it.
  fs::create_directory(folder / "y.part");
  fs::rename(folder / "x/snapshots.h5", folder / "y.part/snapshots.h5");
  fs::rename(folder / "x/scene.json", folder / "y.part/scene.json");
  write("from.json", R"({"preparation": {"snapshot": "y.part/snapshots.h5"},
                         "path": {"segments": [{"mode": "relax", "duration": 1}]}})");
  EXPECT_TRUE(refuses(run({"simulate", "from.json", "-o", "y"}),
                      {"y.part/snapshots.h5: lies in ", "y.part, which this test would replace"}));
  EXPECT_TRUE(refuses(run({"simulate", "y.part/scene.json", "-o", "./y"}),
                      {"y.part/scene.json: lies in ", "move it, or give another directory with -o"}));
  EXPECT_TRUE(fs::exists(folder / "y.part/snapshots.h5"));
  EXPECT_EQ(run({"simulate", "from.json", "-o", "z"}).status, 0);
}

TEST_F(Simulate, AFullDiskKeepsTheLastCheckpoint) {
  const auto running = start_long();
  running->send(SIGINT);
  running->wait();
  const std::string before = read("out/x.part/checkpoint.bin");
  const Outcome full =
      run({"simulate", "long.json", "-o", "out/x", "--checkpoint", "0", "--resume"}, {"", 4000});
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, HasSubstr("cannot be written: File too large"));
  EXPECT_EQ(read("out/x.part/checkpoint.bin"), before);
  // Without one there is nothing to keep.
  write("s.json", scene("200"));
  EXPECT_EQ(run({"simulate", "s.json", "-o", "y", "--checkpoint", "0"}, {"", 4000}).status, 2);
  EXPECT_THAT(listing("y.part"), testing::IsEmpty());
}

TEST_F(Simulate, RefusesOptionsThatMakeNoSense) {
  write("s.json", scene("200"));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "x", "--simd", "mmx"}),
                      {"--simd: must be one that this machine can run (", "baseline), got \"mmx\""}));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "x", "--checkpoint", "-1"}),
                      {"--checkpoint: must be a number", "got -1"}));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "x", "--resume"}),
                      {"x: holds no interrupted test to go on with (no x.part beside it)"}));
}

TEST_F(Simulate, RunsOnTheInstructionSetThatIsAskedFor) {
  write("s.json", scene("200"));
  ASSERT_EQ(run({"simulate", "s.json", "-o", "x", "--simd", "baseline"}).status, 0);
  EXPECT_THAT(read("x/provenance.json"), HasSubstr("\"simd\": \"baseline\""));
}

TEST_F(Simulate, TwoIntoOneFolderAreRefused) {
  const auto running = start_long();
  write("s.json", scene("200"));
  EXPECT_TRUE(refuses(run({"simulate", "s.json", "-o", "out/x"}), {"out/x: is in use by another grainlaw"}));
}

TEST_F(Simulate, AForeignFolderInTheWayIsKept) {
  write("s.json", scene("200"));
  write("x.part/diary.txt", "precious");
  EXPECT_TRUE(
      refuses(run({"simulate", "s.json", "-o", "x"}), {"x.part: is in the way: it holds \"diary.txt\""}));
  EXPECT_EQ(read("x.part/diary.txt"), "precious");
}

}  // namespace
}  // namespace grainlaw::apps
