// timing.json holds statistics alone: one that is spoilt stops nothing; a record without its provenance does.
#include <gmock/gmock.h>

#include "grainlaw/element/json.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

using testing::HasSubstr;

class StageTimes : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("c.json", tiny_campaign());
    ASSERT_EQ(run({"calibrate", "c.json", "-o", "out"}).status, 0);
  }
};

TEST_F(StageTimes, ASpoiltTimingIsBegunAnew) {
  write("out/timing.json", "[");
  const Outcome outcome = run({"calibrate", "-o", "out", "--resume"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "warning: out/timing.json: line 1 is not valid JSON; times are counted anew\n");
  EXPECT_EQ(load_json(folder / "out/timing.json").at("stages").size(), 4u);
}

TEST_F(StageTimes, ASpoiltProvenanceNamesTheDirectoryToRemove) {
  write("out/records/iso-s1/provenance.json", "[");
  const Outcome outcome = run({"calibrate", "-o", "out", "--resume"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("out/records/iso-s1/provenance.json: "));
  EXPECT_THAT(outcome.err, HasSubstr("remove the directory out/records/iso-s1 "));
}

}  // namespace
}  // namespace grainlaw::apps
