// Reading CAMPAIGN.json: lists are written out, states are found on the path that passes them, and what could
// not be run to its end is refused before anything starts.
#include "grainlaw/calibrate/campaign.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaign_examples.hpp"
#include "grainlaw/calibrate/campaign_plan.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  try {
    campaign_of(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Campaign, ReadsTheQuickCampaign) {
  const auto campaign = Campaign::load(GRAINLAW_DATA_DIR "/campaigns/quick.json");
  EXPECT_EQ(campaign.name, "quick");
  EXPECT_GE(campaign.preparation.count, 1000);
  EXPECT_EQ(campaign.role_of("iso"), Role::fit);
  int d2_states = 0;
  for (const auto& test : campaign.tests)
    d2_states += test.name.starts_with("d2-0.") && test.role == Role::fit;
  EXPECT_GE(d2_states, 5);
}

TEST(Campaign, TheQuickOneMeasuresTheMemory) {
  const auto campaign = Campaign::load(GRAINLAW_DATA_DIR "/campaigns/quick.json");
  std::size_t over_compressions = 0, most_cycles = 0, shear = 0;
  for (const auto& test : campaign.tests) {
    if (test.role != Role::memory) continue;
    (test.from ? shear : over_compressions) += 1;
    if (!test.from) most_cycles = std::max(most_cycles, test.path.segments.size() / 2);
    EXPECT_GE(test.seeds.size(), 3u) << test.name;  // errors come from the scatter over seeds
  }
  EXPECT_GE(over_compressions, 3u);
  EXPECT_GE(most_cycles, 10u);
  EXPECT_GE(shear, 3u);
}

TEST(Campaign, TheRoleOfMemoryIsReadAndWritten) {
  std::string test = iso;
  test.replace(test.find("fit"), 3, "memory");
  const auto campaign = campaign_of(with_tests(test));
  EXPECT_EQ(campaign.role_of("iso"), Role::memory);
  EXPECT_EQ(campaign.to_json().at("tests").at(0).at("role"), "memory");
}

TEST(Campaign, WritesOutListsOfStates) {
  const auto campaign = campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": [0.7, 0.75]})")));
  ASSERT_EQ(campaign.tests.size(), 3u);
  EXPECT_EQ(campaign.tests[1].name, "d2-0.7");
  EXPECT_EQ(campaign.tests[2].name, "d2-0.75");
  EXPECT_DOUBLE_EQ(campaign.test("d2-0.75").nu_start, 0.75);
  EXPECT_THAT(campaign.tests[1].seeds, ElementsAre(1, 2));
}

TEST(Campaign, OneStateKeepsTheName) {
  const auto campaign = campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": 0.7})")));
  EXPECT_TRUE(campaign.has_test("d2"));
  EXPECT_FALSE(campaign.has_test("d2-0.7"));
}

TEST(Campaign, AStateIsOnTheLastSegmentThatPassesIt) {
  const auto campaign =
      campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": 0.7})", "unloading") + "," +
                             d2(R"({"test": "iso", "nu": 0.7, "segment": 0})", "loading")));
  EXPECT_EQ(campaign.test("unloading").from->segment, 1u);
  EXPECT_EQ(campaign.test("loading").from->segment, 0u);
  EXPECT_EQ(campaign.test("loading").from->nu, 0.7);
}

TEST(Campaign, TheEndOfASegmentNeedsNoVolumeFraction) {
  const auto campaign = campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": 0.82})", "top") + "," +
                                               d2(R"({"test": "iso"})", "end") + "," +
                                               d2(R"({"test": "end", "nu": 0.64})", "again")));
  EXPECT_EQ(campaign.test("top").from->segment, 0u);  // where segment 1 begins, segment 0 ends
  EXPECT_FALSE(campaign.test("top").from->nu);
  EXPECT_EQ(campaign.test("end").from->segment, 1u);
  EXPECT_NEAR(campaign.test("end").nu_start, 0.64, 1e-15);
  EXPECT_FALSE(campaign.test("again").from->nu);  // D2 does not change it: the state is D2's end
}

TEST(Campaign, NominalStartIsFollowedThroughAChain) {
  const std::string first =
      R"({"name": "a", "role": "fit", "path": {"segments": [{"mode": "uni", "amount": 0.1}]}})";
  const std::string second = R"({"name": "b", "role": "predict", "from": {"test": "a"},
      "path": {"segments": [{"mode": "uni", "amount": 0.05}]}})";
  const auto campaign = campaign_of(with_tests(second + "," + first + "," + d2(R"({"test": "b"})")));
  EXPECT_NEAR(campaign.test("b").nu_start, 0.64 * std::exp(0.1), 1e-15);
  EXPECT_NEAR(campaign.test("d2").nu_start, 0.64 * std::exp(0.15), 1e-15);
}

TEST(Campaign, AsWrittenItReadsBackTheSame) {
  const std::string with_measure =
      R"({"name": "x", "role": "predict", "from": {"test": "iso", "nu": [0.7, 0.72]},
      "measure": {"rows": 7, "snapshots": [{"segment": 0, "eps_dev": 0.1}]},
      "path": {"segments": [{"mode": "d3", "amount": 0.2}]}})";
  const auto campaign = campaign_of(with_tests(with_measure + "," + iso + "," + d2(R"({"test": "x-0.7"})")));
  const auto again = campaign_of(campaign.to_json().dump());
  EXPECT_EQ(again.to_json(), campaign.to_json());
  EXPECT_EQ(difference(again, campaign), "");
  EXPECT_EQ(again.test("x-0.72").measure.rows, 7);
  EXPECT_FALSE(campaign.to_json().at("preparation").contains("seed"));
}

TEST(Campaign, SaysWhereTwoDiffer) {
  const auto one = campaign_of(with_tests(iso));
  auto text = with_tests(iso);
  text.replace(text.find("100"), 3, "125");
  EXPECT_EQ(difference(one, campaign_of(text)), "preparation.count: 100 there, 125 here");
  EXPECT_EQ(difference(one, campaign_of(with_tests(iso + "," + d2(R"({"test": "iso"})")))),
            "tests: 1 entries there, 2 here");
}

TEST(Campaign, RecordsAreNamedByTestAndSeed) { EXPECT_EQ(record_name("uni-0.69", 3), "uni-0.69-s3"); }

TEST(Campaign, RefusesAnOriginThatIsNot) {
  const auto from = [](const std::string& origin) { return refusal(with_tests(iso + "," + d2(origin))); };
  EXPECT_EQ(from(R"({"test": "izo"})"),
            R"(c.json: tests[1].from.test: must be the name of a test, got "izo")");
  EXPECT_EQ(
      from(R"({"test": "iso", "nu": 0.9})"),
      R"(c.json: tests[1].from.nu: must be a volume fraction that "iso" passes, 0.64 to 0.82, got 0.9)");
  EXPECT_EQ(
      from(R"({"test": "iso", "nu": [0.7, 0.5]})"),
      R"(c.json: tests[1].from.nu: must be a volume fraction that "iso" passes, 0.64 to 0.82, got 0.5)");
  EXPECT_EQ(from(R"({"test": "iso", "segment": 2})"),
            R"(c.json: tests[1].from.segment: must be less than 2, the number of segments of "iso", got 2)");
  EXPECT_THAT(from(R"({"test": "iso", "nu": 0.64, "segment": 0})"),
              HasSubstr(R"(is where "iso" itself starts)"));
  EXPECT_THAT(from(R"({"test": "iso", "nu": 1})"),
              StartsWith("c.json: tests[1].from.nu: must be > 0 and < 1, got 1"));
  EXPECT_THAT(from(R"({"test": "iso", "nus": 0.7})"), HasSubstr("did you mean nu?"));
  EXPECT_THAT(from(R"({"test": "iso", "nu": [0.7, 0.70005]})"), HasSubstr("2e-04 away from 0.7"));
  EXPECT_THAT(from(R"({"test": "iso", "nu": [0.7, 0.7]})"), HasSubstr("is taken by another test"));
}

TEST(Campaign, RefusesAListAsOrigin) {
  EXPECT_EQ(refusal(with_tests(iso + "," + d2(R"({"test": "iso", "nu": [0.7, 0.75]})") + "," +
                               d2(R"({"test": "d2"})", "more"))),
            R"(c.json: tests[2].from.test: "d2" stands for several tests; name one of d2-0.7, d2-0.75)");
}

TEST(Campaign, RefusesCircles) {
  EXPECT_EQ(refusal(with_tests(d2(R"({"test": "b"})", "a") + "," + d2(R"({"test": "c"})", "b") + "," +
                               d2(R"({"test": "a"})", "c"))),
            "c.json: tests[0].from.test: goes round in a circle: a from b from c from a");
  EXPECT_THAT(refusal(with_tests(d2(R"({"test": "a"})", "a"))), HasSubstr("a from a"));
}

TEST(Campaign, RefusesNamesThatAreNoFileNames) {
  for (const char* name : {"", "a/b", "../x", "-x", ".x", "a b", "\\u00fc", "a\\u0000"}) {
    std::string test = iso;
    test.replace(test.find("iso"), 3, name);
    EXPECT_THAT(refusal(with_tests(test)), StartsWith("c.json: tests[0].name: must be 1 to 100 letters"))
        << name;
  }
  EXPECT_EQ(refusal(with_tests(iso + "," + iso)),
            R"(c.json: tests[1].name: is taken by another test, got "iso")");
}

TEST(Campaign, RefusesSeedsThatAreNot) {
  const auto seeds = [](const std::string& list) {
    return refusal(R"({"name": "c", "seeds": )" + list + R"(, "tests": [)" + iso + "]}");
  };
  EXPECT_THAT(seeds("[1, 1]"), HasSubstr("seeds[1]: is given twice, got 1"));
  EXPECT_THAT(seeds("[0.5]"), HasSubstr("seeds[0]: must be a whole number, got 0.5"));
  EXPECT_THAT(seeds("[]"), HasSubstr("seeds: must have at least 1"));
  EXPECT_THAT(seeds("[-1]"), HasSubstr("seeds[0]: must be >= 0"));
  EXPECT_THAT(seeds("1"), HasSubstr("seeds: must be a list"));
}

TEST(Campaign, RefusesASeedItsOriginDoesNotHave) {
  std::string only_first = iso;
  only_first.insert(1, R"("seeds": [1], )");
  EXPECT_EQ(refusal(with_tests(only_first + "," + d2(R"({"test": "iso"})"))),
            R"(c.json: tests[1].seeds: must be some of the seeds of "iso", where it starts, got 2)");
  std::string foreign = iso;
  foreign.insert(1, R"("seeds": [3], )");
  EXPECT_EQ(refusal(with_tests(foreign)),
            "c.json: tests[0].seeds: must be some of the campaign's seeds, got 3");
}

TEST(Campaign, RefusesPathsThatCannotBeFollowed) {
  const auto path = [](const std::string& segments) {
    return refusal(with_tests(R"({"name": "a", "role": "fit", "path": )" + segments + "}"));
  };
  EXPECT_THAT(path(R"({"segments": [{"mode": "iso", "controls": {"nu": 0.64}}]})"),
              HasSubstr("tests[0].path.segments[0]: has nothing to do"));
  EXPECT_THAT(path(R"({"segments": [{"mode": "iso", "amount": 0.5}]})"), HasSubstr("must stay > 0 and < 1"));
  EXPECT_THAT(path(R"({"start": {"nu": 0.64}, "segments": [{"mode": "iso", "amount": 0.1}]})"),
              StartsWith("c.json: tests[0].path.start.nu: means nothing in a campaign"));
  EXPECT_THAT(path(R"({"segments": [{"mode": "iso", "controls": {"nu": 1.5}}]})"),
              HasSubstr("tests[0].path.segments[0].controls.nu: must be > 0 and < 1, got 1.5"));
}

// iso, then constant P from it, then shear from where the servo has led.
const std::string constant_p =
    R"({"name": "cp", "role": "predict", "from": {"test": "iso", "nu": 0.7},
        "path": {"segments": [{"mode": "constant_p", "amount": 0.05}]}})";

TEST(Campaign, TakesPathsUnderStressControlAndStatesAfterThem) {
  const Campaign campaign = campaign_of(with_tests(iso + "," + constant_p + "," + d2(R"({"test": "cp"})")));
  EXPECT_TRUE(campaign.test("cp").nu_known);
  EXPECT_DOUBLE_EQ(campaign.test("cp").nu_start, 0.7);
  const CampaignTest& after = campaign.test("d2");
  EXPECT_FALSE(after.nu_known);
  ASSERT_TRUE(after.from);
  EXPECT_EQ(after.from->segment, 0U);
  EXPECT_FALSE(after.from->nu);
  for (const Job& job : plan(campaign)) EXPECT_GT(job.particle_steps, 0) << job.record;
}

TEST(Campaign, RefusesToGuessWhatAServoDoes) {
  EXPECT_THAT(
      refusal(with_tests(iso + "," + constant_p + "," + d2(R"({"test": "cp", "nu": 0.7})"))),
      HasSubstr(
          "tests[2].from.nu: must be left out, got 0.7: how dense the grains are in segment 0 of \"cp\""));
  std::string fitted = constant_p;
  fitted.replace(fitted.find("predict"), 7, "fit");
  EXPECT_THAT(refusal(with_tests(iso + "," + fitted)),
              HasSubstr("tests[1].role: must be predict where the path is under stress control, got fit"));
  EXPECT_THAT(
      refusal(with_tests(
          iso +
          R"(,{"name": "s", "role": "fit", "path": {"segments": [{"mode": "simple_shear", "amount": 0.1}]}})")),
      HasSubstr("tests[1].role: must be predict where the path has simple_shear, got fit"));
}

TEST(Campaign, RefusesSnapshotsOffThePath) {
  const auto snapshot = [](const std::string& request) {
    std::string test = iso;
    test.insert(1, R"("measure": {"snapshots": [)" + request + "]}, ");
    return refusal(with_tests(test));
  };
  EXPECT_THAT(snapshot(R"({"segment": 2})"),
              HasSubstr("tests[0].measure.snapshots[0].segment: must be less than 2"));
  EXPECT_THAT(snapshot(R"({"segment": 0, "nu": 0.5})"),
              StartsWith("c.json: tests[0].measure.snapshots[0].nu: must lie in"));
}

TEST(Campaign, RefusesRecordsThatLackColumns) {
  const auto campaign = [](const std::string& measure, const std::string& of_test) {
    std::string test = iso;
    test.insert(1, R"("measure": )" + of_test + ", ");
    return R"({"name": "c", "seeds": [1], "measure": )" + measure + R"(, "tests": [)" + test + "]}";
  };
  EXPECT_EQ(
      refusal(campaign(R"({"standard": ["stress", "coordination", "energy_ratio"]})", "{}")),
      "c.json: measure.standard: must have \"fabric\" in a campaign, whose fits, comparisons and report "
      "read its columns");
  EXPECT_EQ(refusal(campaign("{}", R"({"standard": []})")),
            "c.json: tests[0].measure.standard: must have \"stress\" in a campaign, whose fits, comparisons "
            "and report read its columns");
  EXPECT_THAT(refusal(campaign("{}", R"({"standard": ["stres"]})")),
              HasSubstr("tests[0].measure.standard[0]: must be one of stress, "));
  const Campaign good =
      campaign_of(campaign(R"({"standard": ["energy_ratio", "fabric", "stress", "coordination"]})", "{}"));
  EXPECT_EQ(good.tests[0].measure.standard, column_groups());
}

TEST(Campaign, RefusesWhatNobodyAskedFor) {
  EXPECT_THAT(refusal(R"({"name": "c", "seed": [1], "seeds": [1], "tests": [)" + iso + "]}"),
              StartsWith("c.json: seed: unknown key, did you mean seeds?"));
  EXPECT_THAT(refusal(R"({"name": "c", "preparation": {"seed": 3}, "seeds": [1], "tests": [)" + iso + "]}"),
              StartsWith("c.json: preparation.seed: must be left out"));
  EXPECT_THAT(refusal(R"({"name": "c", "seeds": [1], "tests": []})"),
              HasSubstr("tests: must have at least one entry"));
  std::string test = iso;
  test.replace(test.find("fit"), 3, "fits");
  EXPECT_THAT(refusal(with_tests(test)),
              HasSubstr(R"(tests[0].role: must be one of fit, predict, memory, got "fits")"));
}

}  // namespace
}  // namespace grainlaw::calibrate
