#include "grainlaw/calibrate/run_campaign.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <variant>

#include "grainlaw/calibrate/campaign_schedule.hpp"
#include "grainlaw/calibrate/kept_record.hpp"
#include "grainlaw/dem/record/checkpoint.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::calibrate {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto look_every = std::chrono::milliseconds(100);
constexpr double first_estimate_after = 2.0;  // s; before, the rate is mostly start-up

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What a running job tells about itself.
struct Pulse {
  Clock::time_point begin;
  double begin_fraction = 0;  ///< where it went on from a checkpoint
  double fraction = 0;
  std::string stage;
};

struct Failure {
  std::string error;
  std::exception_ptr unwritable;  ///< set where the disk, not the test, is the reason
};

/// How a job ended.
struct Ending {
  std::size_t job;
  std::variant<dem::RunSummary, Failure> outcome;
};

class Runner {
 public:
  Runner(std::vector<Job> jobs, RunFolder folder, const RunOptions& options)
      : folder_(std::move(folder)),
        options_(options),
        jobs_(std::move(jobs)),
        schedule_(jobs_),
        pulses_(jobs_.size()) {}

  CampaignResult run();

 private:
  void clear();
  bool look();
  void halt();
  void work();
  Ending run_job(std::size_t job);
  void check_origin(const Job& job) const;
  dem::RunSummary run_test(std::size_t job);
  void handle(const Ending& ending);
  void handle_failure(std::size_t job, const Failure& failure);
  CampaignProgress progress() const;
  void write_failures() const;
  bool halted() const { return halt_.load(std::memory_order_relaxed); }

  const RunFolder folder_;
  const RunOptions& options_;
  const std::vector<Job> jobs_;
  CampaignResult result_;
  Clock::time_point begin_ = Clock::now();
  std::exception_ptr unwritable_;
  double reused_work_ = 0;   ///< estimated particle-steps
  double actual_steps_ = 0;  ///< particle-steps of jobs that ended
  double ended_busy_s_ = 0;  ///< what they took

  std::atomic<bool> halt_{false};
  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  Schedule schedule_;
  std::vector<Pulse> pulses_;
  std::deque<Ending> endings_;
};

/// Removes what an interrupted run left, but for tests that can go on; finds the records that are there, and
/// checks all that is to be gone on with.
void Runner::clear() {
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const fs::path part = folder_.part(jobs_[i].record);
    if (!folder_.has_record(jobs_[i].record) && dem::has_whole_record(part))
      fs::rename(part, folder_.record(jobs_[i].record));  // killed before it could do so
    const bool made = folder_.has_record(jobs_[i].record);
    if (!made && dem::has_checkpoint(part))
      dem::check_checkpoint(part, dem::Scene::read(Reader(jobs_[i].scene, jobs_[i].record), part));
    else
      fs::remove_all(part);
    if (!made) continue;
    check_kept_record(folder_.record(jobs_[i].record), jobs_[i].scene);
    schedule_.reuse(i);
    reused_work_ += jobs_[i].particle_steps;
    ++result_.reused;
  }
  for (const Job& job : jobs_) {
    if (!job.needs || folder_.has_record(job.record)) continue;
    const std::string& producer = jobs_[*job.needs].record;
    if (folder_.has_record(producer) && cut_short(folder_.record(producer)).empty())
      check_kept_snapshots(folder_.record(producer));
  }
}

CampaignResult Runner::run() {
  clear();
  std::vector<std::jthread> workers;
  try {
    const std::size_t open = jobs_.size() - result_.reused;
    for (std::size_t i = 0; i < std::min(options_.workers, open); ++i)
      workers.emplace_back([this] { work(); });
    while (look()) {
    }
  } catch (...) {
    halt();
    throw;
  }
  workers.clear();
  result_.wall_s = seconds_since(begin_);
  if (unwritable_) std::rethrow_exception(unwritable_);
  write_failures();
  return result_;
}

/// Deals with what has happened since the last look; false when all is over.
bool Runner::look() {
  using State = Schedule::State;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, look_every, [&] { return !endings_.empty() || schedule_.over(); });
  std::deque<Ending> endings;
  endings.swap(endings_);
  const bool over =
      endings.empty() && (schedule_.over() || (halted() && schedule_.count(State::running) == 0));
  lock.unlock();
  for (const Ending& ending : endings) handle(ending);
  if (over) return false;
  if (options_.hooks.stop != nullptr && options_.hooks.stop->load(std::memory_order_relaxed)) {
    result_.stopped = true;
    halt();
  }
  if (options_.hooks.progress && !halted()) options_.hooks.progress(progress());
  return true;
}

void Runner::halt() {
  {
    const std::lock_guard lock(mutex_);
    halt_ = true;
  }
  changed_.notify_all();
}

void Runner::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    std::optional<std::size_t> job;
    changed_.wait(lock, [&] { return halted() || schedule_.over() || (job = schedule_.take()).has_value(); });
    if (!job) return;
    pulses_[*job].begin = Clock::now();
    lock.unlock();
    Ending ending = run_job(*job);
    lock.lock();
    endings_.push_back(std::move(ending));
    changed_.notify_all();
  }
}

Ending Runner::run_job(std::size_t job) {
  try {
    return {job, run_test(job)};
  } catch (const Error& error) {
    return {job, Failure{error.what(), error.unwritable() ? std::current_exception() : nullptr}};
  } catch (const fs::filesystem_error& error) {
    return {job, Failure{error.what(), std::current_exception()}};
  } catch (const std::bad_alloc&) {
    return {job, Failure{"out of memory", nullptr}};
  } catch (const std::exception& error) {
    return {job, Failure{error.what(), nullptr}};
  }
}

/// Throws Error where the test that this one starts from ended before it came to that state.
void Runner::check_origin(const Job& job) const {
  if (!job.needs) return;
  const std::string& producer = jobs_[*job.needs].record;
  const fs::path dir = folder_.record(producer);
  const std::string why = cut_short(dir);
  if (!why.empty() && !fs::exists(dir / "snapshots.h5"))
    throw Error("starts from " + producer + ", which did not get there: " + why);
}

dem::RunSummary Runner::run_test(std::size_t index) {
  const Job& job = jobs_[index];
  check_origin(job);
  const fs::path part = folder_.part(job.record);
  fs::create_directory(part);  // before the scene is read: its snapshot is looked for from here
  const dem::Scene scene = dem::Scene::read(Reader(job.scene, job.record), part);
  const auto progress = [this, index](double fraction, const std::string& stage) {
    const std::lock_guard lock(mutex_);
    if (pulses_[index].stage.empty()) pulses_[index].begin_fraction = fraction;
    pulses_[index].fraction = fraction;
    pulses_[index].stage = stage;
  };
  const dem::RunSummary summary =
      options_.run_test(scene, part, {progress, &halt_, options_.checkpoint_every});
  if (!summary.stopped)
    fs::rename(part, folder_.record(job.record));
  else if (!dem::has_checkpoint(part))
    fs::remove_all(part);
  return summary;
}

void Runner::handle(const Ending& ending) {
  if (const auto* failure = std::get_if<Failure>(&ending.outcome))
    return handle_failure(ending.job, *failure);
  const auto& summary = std::get<dem::RunSummary>(ending.outcome);
  {
    const std::lock_guard lock(mutex_);
    if (summary.stopped)
      schedule_.fail(ending.job);
    else
      schedule_.finish(ending.job);
    changed_.notify_all();
  }
  if (summary.stopped) return;
  ++result_.finished;
  const Pulse& pulse = pulses_[ending.job];
  ended_busy_s_ += seconds_since(pulse.begin);
  actual_steps_ += (1 - pulse.begin_fraction) * static_cast<double>(summary.particle_steps);
  reused_work_ += pulse.begin_fraction * jobs_[ending.job].particle_steps;
  if (options_.hooks.finished) options_.hooks.finished({jobs_[ending.job].record, summary}, progress());
}

/// Errors of a scene begin with its file, which in a campaign is the record's name and is said anyway.
std::string without_name(const std::string& error, const std::string& record) {
  return error.starts_with(record + ": ") ? error.substr(record.size() + 2) : error;
}

void Runner::handle_failure(std::size_t job, const Failure& failure) {
  FailedJob failed{jobs_[job].record, without_name(failure.error, jobs_[job].record), {}};
  {
    const std::lock_guard lock(mutex_);
    for (const std::size_t i : schedule_.fail(job)) failed.skipped.push_back(jobs_[i].record);
    if (failure.unwritable) halt_ = true;
    changed_.notify_all();
  }
  if (failure.unwritable) {
    std::error_code ignored;
    if (!dem::has_checkpoint(folder_.part(failed.record)))
      fs::remove_all(folder_.part(failed.record), ignored);
    if (!unwritable_) unwritable_ = failure.unwritable;
    return;
  }
  dem::remove_checkpoints(folder_.part(failed.record));  // the next try is to start anew
  result_.failed.push_back(failed);
  if (options_.hooks.failed) options_.hooks.failed(failed);
}

CampaignProgress Runner::progress() const {
  const std::lock_guard lock(mutex_);
  CampaignProgress now;
  now.jobs = jobs_.size();
  double total = 0, done = 0, running = 0, before = reused_work_, busy_s = ended_busy_s_;
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    const double work = jobs_[i].particle_steps;
    const auto state = schedule_.state(i);
    if (state == Schedule::State::failed || state == Schedule::State::skipped) continue;
    total += work;
    if (state == Schedule::State::done) done += work;
    if (state == Schedule::State::running) {
      running += work * pulses_[i].fraction;
      before += work * pulses_[i].begin_fraction;
      busy_s += seconds_since(pulses_[i].begin);
      now.running.push_back(jobs_[i].record + (pulses_[i].stage.empty() ? "" : ": " + pulses_[i].stage));
    }
  }
  now.finished = schedule_.count(Schedule::State::done);
  now.fraction = total > 0 ? (done + running) / total : 1;
  const double elapsed = seconds_since(begin_);
  const double made = done + running - before;  // by this process
  if (elapsed < first_estimate_after || !(made > 0)) return now;
  now.rate = (actual_steps_ + running - (before - reused_work_)) / elapsed;
  // The rate of one worker in the units of the estimates, so that a bad estimate of a relaxation cancels.
  now.seconds_left = schedule_.time_left(options_.workers, made / busy_s,
                                         [&](std::size_t i) { return pulses_[i].fraction; });
  return now;
}

void Runner::write_failures() const {
  const fs::path file = folder_.dir / "failures.json";
  if (result_.failed.empty()) {
    fs::remove(file);
    return;
  }
  Json list = Json::array();
  for (const FailedJob& failed : result_.failed)
    list.push_back({{"record", failed.record}, {"error", failed.error}, {"skipped", failed.skipped}});
  write_file(file, Json{{"failures", list}}.dump(2) + "\n");
}

}  // namespace

CampaignResult run_campaign(const Campaign& campaign, const CampaignFolder& folder,
                            const RunOptions& options) {
  return run_jobs(plan(campaign), folder.records(), options);
}

CampaignResult run_jobs(std::vector<Job> jobs, const RunFolder& folder, const RunOptions& options) {
  return Runner(std::move(jobs), folder, options).run();
}

}  // namespace grainlaw::calibrate
