// The program itself: --version, --help, where it finds its data, and that the commands of docs/commands.md
// work as printed.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "grainlaw/element/file.hpp"
#include "grainlaw/element/version.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The commands of a page, in order: lines of its code blocks that begin with "grainlaw ".
std::vector<Arguments> commands_of(const fs::path& page) {
  std::vector<Arguments> commands;
  std::istringstream lines(read_file(page));
  bool code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) code = !code;
    if (!code || !line.starts_with("grainlaw ")) continue;
    std::istringstream words(line.substr(0, line.find(" #")));
    std::string word;
    words >> word;
    Arguments arguments;
    while (words >> word) arguments.push_back(word);
    commands.push_back(arguments);
  }
  return commands;
}

TEST_F(Program, VersionNamesCommitCompilerAndLibraries) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, testing::StartsWith("grainlaw " + version() + "\n"));
  for (const char* part : {"commit ", "compiler ", "SUNDIALS ", "Ceres ", "HDF5 ", "Eigen ", "nlohmann_json ",
                           "CLI11 ", "spdlog ", "fmt "})
    EXPECT_THAT(outcome.out, testing::ContainsRegex(std::string(part) + "[^ \n]"));
}

TEST_F(Program, HelpHasAnExampleForEachCommand) {
  const std::string help = run({"--help"}).out;
  for (const char* name : {"calibrate", "simulate", "predict", "fit", "polish", "report", "probe",
                           "infer-phij", "export", "replay", "bench"}) {
    EXPECT_THAT(help, HasSubstr(std::string("  grainlaw ") + name));
    const Outcome own = run({name, "--help"});
    EXPECT_EQ(own.status, 0);
    EXPECT_THAT(own.out, testing::ContainsRegex(std::string("Examples?:\n  grainlaw ") + name));
  }
}

TEST_F(Program, FindsTheQuickCampaignFromAnywhere) {
  fs::remove(folder / "data");
  Running running(folder, {"calibrate", "--jobs", "1"});
  EXPECT_TRUE(eventually([&] { return fs::exists(folder / "out/quick/campaign.json") || running.ended(); }));
  running.send(SIGINT);
  EXPECT_EQ(running.wait().status, 130);
  EXPECT_THAT(read("out/quick/campaign.json"), HasSubstr("\"quick\""));
}

/// calibrate and simulate are only begun here, then interrupted: their examples take minutes.
TEST_F(Program, EveryExampleOfTheManualWorks) {
  write("tiny.json", tiny_campaign());
  ASSERT_EQ(run({"calibrate", "tiny.json", "-o", "out/quick"}).status, 0);
  const auto commands = commands_of(fs::path(GRAINLAW_SOURCE_DIR) / "docs/commands.md");
  std::map<std::string, int> seen;
  for (const Arguments& arguments : commands) {
    const std::string text = testing::PrintToString(arguments);
    ++seen[arguments.at(0)];
    if (arguments[0] != "calibrate" && arguments[0] != "simulate") {
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.status, 0) << text << outcome.err;
      continue;
    }
    fs::rename(folder / "out/quick", folder / "kept");
    Running running(folder, arguments);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    running.send(SIGINT);
    const Outcome outcome = running.wait();
    EXPECT_EQ(outcome.status, 130) << text << outcome.err;
    fs::remove_all(folder / "out/quick");
    fs::rename(folder / "kept", folder / "out/quick");
  }
  for (const char* name :
       {"calibrate", "simulate", "predict", "fit", "report", "export", "--version", "--help"})
    EXPECT_GT(seen[name], 0) << name;
}

}  // namespace
}  // namespace grainlaw::apps
