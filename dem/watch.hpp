// Counts the steps of a run, tells how far it is and whether it should go on.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace grainlaw::dem {

struct RunHooks {
  /// Called some times a second with the share of all planned steps that is done, in [0, 1], and what is
  /// going on
  /// ("compress the gas", "d2 (2 of 3)"). Relaxations may end early, so the share can jump ahead; it never
  /// falls.
  std::function<void(double fraction_done, const std::string& stage)> progress;
  /// When it turns true the test stops within some 10 ms.
  const std::atomic<bool>* stop = nullptr;
};

class Watch {
 public:
  Watch(const RunHooks& hooks, std::size_t grains);

  /// More steps to come.
  void plan(std::uint64_t steps) { planned_ += steps; }
  /// A stage of so many steps, of which some are taken already.
  void enter(const std::string& stage, std::uint64_t steps, std::uint64_t taken);
  /// After each step; false where the run was told to stop.
  bool step();
  /// The stage is over, perhaps before its planned end.
  void leave() { done_ = stage_end_; }
  bool stopped() const { return hooks_.stop != nullptr && hooks_.stop->load(std::memory_order_relaxed); }
  std::uint64_t particle_steps() const { return taken_ * grains_; }

 private:
  void report() const;

  const RunHooks& hooks_;
  std::uint64_t grains_, interval_;
  std::uint64_t planned_ = 0, done_ = 0, taken_ = 0, stage_end_ = 0;
  std::string stage_;
};

}  // namespace grainlaw::dem
