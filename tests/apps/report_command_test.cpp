// grainlaw report on files that cannot be read: it writes what it can, names them and ends with status 2.
#include <gmock/gmock.h>

#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;

class ReportCommand : public Program {
 protected:
  /// A folder with a campaign that has not been run.
  void SetUp() override {
    Program::SetUp();
    write("out/campaign.json", tiny_campaign());
  }
};

TEST_F(ReportCommand, MissingFilesAreNoFault) {
  const Outcome outcome = run({"report", "out"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "wrote out/report.html\n");
  EXPECT_EQ(outcome.err, "");
}

TEST_F(ReportCommand, NamesEveryFileThatCannotBeRead) {
  write("out/fits.json", "{}");
  write("out/timing.json", "[");
  const Outcome outcome = run({"report", "out"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "wrote out/report.html\n");
  EXPECT_EQ(outcome.err, "out/fits.json: fits: must be a list\nout/timing.json: line 1 is not valid JSON\n");
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}

}  // namespace
}  // namespace grainlaw::apps
