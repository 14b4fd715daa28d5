// The runs of a campaign: one scene per test and seed, the snapshots that others need, and how much work each
// is.
#include "grainlaw/calibrate/campaign_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaign_examples.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::calibrate {
namespace {

const Job& job_of(const std::vector<Job>& jobs, const std::string& record) {
  return *std::find_if(jobs.begin(), jobs.end(), [&](const Job& job) { return job.record == record; });
}

TEST(CampaignPlan, OneRunPerTestAndSeed) {
  const auto jobs = plan(campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": [0.7, 0.75]})"))));
  std::vector<std::string> names;
  for (const Job& job : jobs) names.push_back(job.record);
  EXPECT_THAT(names,
              testing::ElementsAre("iso-s1", "iso-s2", "d2-0.7-s1", "d2-0.7-s2", "d2-0.75-s1", "d2-0.75-s2"));
  EXPECT_EQ(job_of(jobs, "iso-s2").scene.at("preparation").at("seed"), 2);
  EXPECT_FALSE(jobs[0].needs);
  EXPECT_EQ(jobs[2].needs, 0u);
  EXPECT_EQ(jobs[5].needs, 1u);
}

TEST(CampaignPlan, ProducersKeepTheStatesThatOthersStartFrom) {
  std::string first_seed_only = d2(R"({"test": "iso", "nu": 0.8})", "x");
  first_seed_only.insert(1, R"("seeds": [1], )");
  const auto jobs = plan(campaign_of(with_tests(
      iso + "," + d2(R"({"test": "iso", "nu": 0.7})") + "," + d2(R"({"test": "iso", "nu": 0.7})", "same") +
      "," + d2(R"({"test": "iso", "nu": 0.82})", "top") + "," + first_seed_only)));
  const auto snapshots = [&](const std::string& record) {
    return job_of(jobs, record).scene.at("measure").at("snapshots");
  };
  EXPECT_EQ(snapshots("iso-s1"),
            Json::parse(R"([{"segment": 1, "nu": 0.7}, {"segment": 0}, {"segment": 1, "nu": 0.8}])"));
  EXPECT_EQ(snapshots("iso-s2"), Json::parse(R"([{"segment": 1, "nu": 0.7}, {"segment": 0}])"));
  EXPECT_EQ(job_of(jobs, "d2-s2").scene.at("preparation"),
            Json::parse(R"({"snapshot": "../iso-s2/snapshots.h5", "nu": 0.7, "segment": 1})"));
  EXPECT_EQ(job_of(jobs, "top-s1").scene.at("preparation"),
            Json::parse(R"({"snapshot": "../iso-s1/snapshots.h5", "segment": 0})"));
}

TEST(CampaignPlan, EveryRunIsASceneThatCanBeRead) {
  for (const Job& job : plan(Campaign::load(GRAINLAW_DATA_DIR "/campaigns/quick.json")))
    EXPECT_NO_THROW(dem::Scene::read(Reader(job.scene, job.record), "")) << job.record;
}

TEST(CampaignPlan, WorkIsGrainsTimesSteps) {
  // D2 to 0.4 at the default rate takes 0.4/sqrt(3)/2.839e-5 us, in steps of 0.2 of the smallest pair's t_c =
  // 0.2279 us.
  const auto campaign = campaign_of(with_tests(iso + "," + d2(R"({"test": "iso", "nu": 0.7})")));
  EXPECT_NEAR(estimate_particle_steps(campaign, campaign.test("d2")),
              100 * 0.4 / std::sqrt(3.0) / 2.839e-5 / (0.2 * 0.2279), 1e-3 * 1.78e7);
}

}  // namespace
}  // namespace grainlaw::calibrate
