// Runs the element tests of a campaign on several threads: what is finished on disk is kept, what fails stops
// only those that start from it, and everything can be interrupted and gone on with.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign_folder.hpp"
#include "grainlaw/calibrate/campaign_plan.hpp"
#include "grainlaw/dem/run/element_test.hpp"

namespace grainlaw::calibrate {

/// How far a campaign is. Work is counted in estimated particle-steps of all jobs, reused ones included.
struct CampaignProgress {
  double fraction = 0;                 ///< of the work
  double rate = 0;                     ///< particle-steps per second since the start, all threads together
  std::optional<double> seconds_left;  ///< unknown in the first seconds
  std::size_t finished = 0, jobs = 0;  ///< reused ones count as finished
  std::vector<std::string> running;    ///< "d2-0.69-s1: d2 (1 of 1)"
};

struct FinishedJob {
  std::string record;
  dem::RunSummary summary;
};

struct FailedJob {
  std::string record;
  std::string error;
  std::vector<std::string> skipped;  ///< records that would have started from it
};

/// All are called from the thread that called run_campaign.
struct CampaignHooks {
  std::function<void(const CampaignProgress&)> progress;  ///< some times a second
  std::function<void(const FinishedJob&, const CampaignProgress&)> finished;
  std::function<void(const FailedJob&)> failed;
  const std::atomic<bool>* stop = nullptr;
};

using RunTest =
    std::function<dem::RunSummary(const dem::Scene&, const std::filesystem::path&, const dem::RunHooks&)>;

struct RunOptions {
  std::size_t workers = 1;
  CampaignHooks hooks;
  double checkpoint_every = 60;  ///< s, see dem::RunHooks
  RunTest run_test = dem::run_element_test;
};

struct CampaignResult {
  std::size_t reused = 0, finished = 0;  ///< records found on disk, and made now
  std::vector<FailedJob> failed;
  bool stopped = false;
  double wall_s = 0;
};

/// Makes every record of the campaign that is not in the folder yet: in records/NAME.part, renamed when
/// complete. What an interrupted run left there goes on from its checkpoint; a checkpoint that cannot be gone
/// on from is an Error, before anything is run. Failures are also written to failures.json; they are tried
/// again next time. Throws Error if the disk cannot be written: records made so far are kept.
CampaignResult run_campaign(const Campaign& campaign, const CampaignFolder& folder,
                            const RunOptions& options);

/// The same for runs that were planned elsewhere; `folder.dir` has a directory `records`, and whoever calls
/// holds it.
CampaignResult run_jobs(std::vector<Job> jobs, const RunFolder& folder, const RunOptions& options);

}  // namespace grainlaw::calibrate
