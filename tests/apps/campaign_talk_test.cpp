// What a campaign says of its runs: the warning that nearly all of them give goes to the log, and is counted
// once; any other is said at once.
#include <gmock/gmock.h>

#include "program.hpp"

namespace grainlaw::apps {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CampaignTalk : public Program {};

TEST_F(CampaignTalk, CountsRunsThatAreNotQuasiStaticOnce) {
  write("c.json", tiny_campaign());
  const Outcome outcome = run({"calibrate", "c.json", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              ContainsRegex("\n[0-9]+ of 10 runs have rows with E_k/E_p above 1e-3 \\(largest 0\\.[0-9]+, "
                            "[a-z0-9.-]+-s[12]\\): see \"What was run\" in the report\nsimulated 10 tests"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("load-bearing rows")));
  EXPECT_THAT(read("out/campaign.log"), ContainsRegex("warning iso-s1: E_k/E_p is above 1e-3 in "));
}

TEST_F(CampaignTalk, SaysOtherWarningsAtOnce) {
  std::string text = tiny_campaign();
  text.insert(text.find("\"preparation\""), R"("material": {"w": 1.1}, )");
  write("c.json", text);
  const Outcome outcome = run({"calibrate", "c.json", "-o", "out"});
  EXPECT_THAT(outcome.err, HasSubstr("warning: iso-s1: w = 1.1 is below 1.2: grains"));
  EXPECT_THAT(read("out/campaign.log"), HasSubstr("warning iso-s1: w = 1.1 is below 1.2: grains"));
}

}  // namespace
}  // namespace grainlaw::apps
