// Which job of a campaign runs next: producers before those that wait for them, longest chains of work first;
// and how long the rest will take.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "grainlaw/calibrate/campaign_plan.hpp"

namespace grainlaw::calibrate {

class Schedule {
 public:
  enum class State { waiting, ready, running, done, failed, skipped };

  /// `jobs` must outlive the schedule.
  explicit Schedule(const std::vector<Job>& jobs);

  /// Marks a job that needs not run (its record is there) as done.
  void reuse(std::size_t job) { finish(job); }
  /// Takes the ready job at the head of the longest chain of work; nothing if none is ready.
  std::optional<std::size_t> take();
  void finish(std::size_t job);
  /// Gives up a job; returns those that now cannot run, which become `skipped`.
  std::vector<std::size_t> fail(std::size_t job);

  State state(std::size_t job) const { return states_.at(job); }
  std::size_t count(State state) const;
  /// Nothing is ready or running, so nothing will be.
  bool over() const;

  /// Seconds until the last job ends: the rest of the schedule played through with so many workers, each
  /// making `rate` particle-steps per second. `fraction` tells how far a running job is.
  double time_left(std::size_t workers, double rate,
                   const std::function<double(std::size_t)>& fraction) const;

 private:
  const std::vector<Job>& jobs_;
  std::vector<State> states_;
  std::vector<std::vector<std::size_t>> waiting_for_;  ///< by producer
  std::vector<double> chain_;  ///< a job's work and that of the longest chain after it
};

}  // namespace grainlaw::calibrate
