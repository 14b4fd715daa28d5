// Which job runs next, and how long the rest takes.
#include "grainlaw/calibrate/campaign_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grainlaw::calibrate {
namespace {

/// Jobs from (work, index of the producer or -1).
std::vector<Job> jobs_of(const std::vector<std::pair<double, int>>& list) {
  std::vector<Job> jobs;
  for (const auto& [work, needs] : list)
    jobs.push_back({"j" + std::to_string(jobs.size()), jobs.size(), 1,
                    needs < 0 ? std::nullopt : std::optional<std::size_t>(needs), Json(), work});
  return jobs;
}

const auto nothing_done = [](std::size_t) { return 0.0; };

TEST(CampaignSchedule, LongestChainFirst) {
  const auto jobs = jobs_of({{5, -1}, {1, -1}, {6, 1}, {4, -1}, {2, 1}});  // chains 5, 7, 6, 4, 2
  Schedule schedule(jobs);
  EXPECT_EQ(schedule.take(), 1u);
  EXPECT_EQ(schedule.take(), 0u);
  EXPECT_EQ(schedule.take(), 3u);
  EXPECT_EQ(schedule.take(), std::nullopt);  // the others wait for 1
  schedule.finish(1);
  EXPECT_EQ(schedule.take(), 2u);
  EXPECT_EQ(schedule.take(), 4u);
  for (const std::size_t i : {0u, 2u, 3u, 4u}) schedule.finish(i);
  EXPECT_TRUE(schedule.over());
  EXPECT_EQ(schedule.count(Schedule::State::done), 5u);
}

TEST(CampaignSchedule, AFailureSkipsAllThatComeAfterIt) {
  const auto jobs = jobs_of({{1, -1}, {1, 0}, {1, 1}, {1, -1}});
  Schedule schedule(jobs);
  EXPECT_EQ(schedule.take(), 0u);
  EXPECT_THAT(schedule.fail(0), testing::ElementsAre(1, 2));
  EXPECT_FALSE(schedule.over());
  EXPECT_EQ(schedule.take(), 3u);
  schedule.finish(3);
  EXPECT_TRUE(schedule.over());
  EXPECT_EQ(schedule.count(Schedule::State::skipped), 2u);
}

TEST(CampaignSchedule, AFailureKeepsRecordsThatAreThere) {
  const auto jobs = jobs_of({{1, -1}, {1, 0}});
  Schedule schedule(jobs);
  schedule.reuse(1);
  EXPECT_EQ(schedule.take(), 0u);
  EXPECT_TRUE(schedule.fail(0).empty());
  EXPECT_EQ(schedule.state(1), Schedule::State::done);
}

TEST(CampaignSchedule, TimeLeftPlaysTheRestThrough) {
  const auto jobs = jobs_of({{4, -1}, {3, 0}, {2, -1}, {2, -1}});
  Schedule schedule(jobs);
  EXPECT_DOUBLE_EQ(schedule.time_left(1, 1.0, nothing_done), 11);
  EXPECT_DOUBLE_EQ(schedule.time_left(2, 1.0, nothing_done), 7);  // 4 then 3; beside them 2 and 2
  EXPECT_DOUBLE_EQ(schedule.time_left(2, 2.0, nothing_done), 3.5);
  EXPECT_DOUBLE_EQ(schedule.time_left(9, 1.0, nothing_done), 7);  // no number of workers beats the chain
  schedule.take();
  EXPECT_DOUBLE_EQ(schedule.time_left(2, 1.0, [](std::size_t) { return 0.5; }), 5);
  schedule.finish(0);
  EXPECT_DOUBLE_EQ(schedule.time_left(1, 1.0, nothing_done), 7);
}

}  // namespace
}  // namespace grainlaw::calibrate
