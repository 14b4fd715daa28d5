// grainlaw simulate: a record appears whole or not at all.
#include <gmock/gmock.h>
#include <signal.h>

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

TEST_F(Simulate, InterruptedItLeavesNothing) {
  const auto running = start_long();
  running->send(SIGINT);
  const Outcome outcome = running->wait();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.err, "stopped; nothing was written\n");
  EXPECT_THAT(listing("out"), testing::IsEmpty());
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
