// Campaigns with a box too narrow for their grains are refused before anything is run.
#include "grainlaw/calibrate/campaign_boxes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "campaign_examples.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& tests) {
  try {
    check_boxes(campaign_of(with_tests(tests)));
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// A test of one segment.
std::string sheared(const std::string& mode, double eps_dev, const std::string& from = "") {
  return R"({"name": "sheared", "role": "predict", )" + (from.empty() ? "" : "\"from\": " + from + ", ") +
         R"("path": {"segments": [{"mode": ")" + mode + R"(", "controls": {"eps_dev": )" + to_text(eps_dev) +
         "}}]}}";
}

/// D2 to eps_dev makes the cube narrower by exp(-eps_dev/sqrt(3)) along x.
double narrowest_eps_dev(double nu) {
  const Material material;
  dem::Random random(1);
  const auto radii = dem::draw_radii(material, 100, random);
  double solid = 0, largest = 0;
  for (const double r : radii) {
    solid += 4 * std::acos(-1.0) / 3 * r * r * r;
    largest = std::max(largest, r);
  }
  return std::sqrt(3) * std::log(std::cbrt(solid / nu) / (2 * largest + 0.02 * material.r_mean));
}

TEST(CampaignBoxes, OfANewPackingAreRefusedWhereTheyBecomeTooNarrow) {
  const double most = narrowest_eps_dev(0.64);
  EXPECT_EQ(refusal(iso + "," + sheared("d2", 0.999 * most)), "accepted");
  EXPECT_THAT(refusal(iso + "," + sheared("d2", 1.001 * most)),
              testing::AllOf(StartsWith("c.json: tests[1].path.segments[0]: makes the box"),
                             HasSubstr("take more grains or less strain")));
}

TEST(CampaignBoxes, AreThoseOfTheStateThatATestStartsFrom) {
  const double most = narrowest_eps_dev(0.75);
  const std::string from = R"({"test": "iso", "nu": 0.75})";
  EXPECT_EQ(refusal(iso + "," + sheared("d2", 0.999 * most, from)), "accepted");
  EXPECT_THAT(refusal(iso + "," + sheared("d2", 1.001 * most, from)), HasSubstr("tests[1].path.segments[0]"));
}

/// A test called `first` with these segments.
std::string first(const std::string& segments) {
  return R"({"name": "first", "role": "predict", "path": {"segments": [)" + segments + "]}},";
}

TEST(CampaignBoxes, AreFollowedThroughTheTestsBefore) {
  const double most = narrowest_eps_dev(0.64);
  const std::string from = R"({"test": "first"})";
  const auto d2_of = [](double eps_dev) {
    return R"({"mode": "d2", "controls": {"eps_dev": )" + to_text(eps_dev) + "}}";
  };
  // D2 goes on where D2 has been, with rest between; and back, it gains room.
  for (const std::string& rest : {std::string(), std::string(R"(, {"mode": "relax"})")}) {
    const std::string half = first(d2_of(0.5 * most) + rest);
    EXPECT_EQ(refusal(half + sheared("d2", 0.499 * most, from)), "accepted");
    EXPECT_THAT(refusal(half + sheared("d2", 0.501 * most, from)), HasSubstr("tests[1].path.segments[0]"));
    EXPECT_EQ(refusal(half + sheared("d2", -1.499 * most, from)), "accepted");
  }
  // From the end of the first segment, not of the last.
  const std::string two = first(d2_of(0.5 * most) + "," + d2_of(0.8 * most));
  EXPECT_EQ(refusal(two + sheared("d2", 0.499 * most, R"({"test": "first", "segment": 0})")), "accepted");
  EXPECT_THAT(refusal(two + sheared("d2", 0.499 * most, from)), HasSubstr("tests[1].path.segments[0]"));
  // Through a test between.
  const std::string between = R"({"name": "between", "role": "predict", "from": {"test": "first"}, "path":
      {"segments": [{"mode": "iso", "controls": {"nu": 0.65}}, {"mode": "iso", "controls": {"nu": 0.64}}]}},)";
  const std::string half = first(d2_of(0.5 * most)) + between;
  EXPECT_EQ(refusal(half + sheared("d2", 0.499 * most, R"({"test": "between"})")), "accepted");
  EXPECT_THAT(refusal(half + sheared("d2", 0.501 * most, R"({"test": "between"})")), HasSubstr("tests[2]"));
}

/// UNI makes the box narrower along z by its strain, D3 by two thirds of eps_dev.
TEST(CampaignBoxes, AreThoseOfAStateOnTheWay) {
  const std::string uni = first(R"({"mode": "uni", "controls": {"nu": 0.72}})");
  const double room = narrowest_eps_dev(0.64) / std::sqrt(3), most = 1.5 * (room - std::log(0.68 / 0.64));
  const std::string from = R"({"test": "first", "nu": 0.68})";
  EXPECT_EQ(refusal(uni + sheared("d3", 0.999 * most, from)), "accepted");
  EXPECT_THAT(refusal(uni + sheared("d3", 1.001 * most, from)), HasSubstr("tests[1].path.segments[0]"));
}

TEST(CampaignBoxes, AfterAServoAreForTheirTurn) {
  const double most = narrowest_eps_dev(0.64);
  const std::string servo = first(R"({"mode": "triaxial", "stress": 0.01, "amount": 0.1})");
  EXPECT_EQ(refusal(servo + sheared("d2", 2 * most, R"({"test": "first"})")), "accepted");
  EXPECT_EQ(refusal(sheared("constant_p", 2 * most)), "accepted");
}

TEST(CampaignBoxes, OfTheCampaignsThatComeWithIt) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GRAINLAW_DATA_DIR "/campaigns")) {
    EXPECT_NO_THROW(check_boxes(Campaign::load(entry.path()))) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 10u);
}

}  // namespace
}  // namespace grainlaw::calibrate
