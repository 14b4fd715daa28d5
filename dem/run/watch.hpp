// Counts the steps of a run, tells how far it is and whether it should go on.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace grainlaw::dem {

struct RunHooks {
  /// Called some times a second with the share of all planned steps that is done, in [0, 1], and what is
  /// going on ("compress the gas", "d2 (2 of 3)"). Relaxations may end early, so the share can jump ahead; it
  /// never falls.
  std::function<void(double fraction_done, const std::string& stage)> progress;
  /// When it turns true the test stops within some 10 ms; on a quasistatic leg where its last increment
  /// ended.
  const std::atomic<bool>* stop = nullptr;
  /// Seconds from one checkpoint to the next; 0: one at every look, some ten milliseconds apart.
  double checkpoint_every = 60;
  /// That share each step. The record does not depend on how many they are.
  int threads = 1;
};

class Watch {
 public:
  /// Of two looks, about, s: checkpoints are no closer.
  static constexpr double shortest_interval = 0.01;

  Watch(const RunHooks& hooks, std::size_t grains);

  /// More passes over the contacts to come; a step of dynamics is one.
  void plan(std::uint64_t passes) { planned_ += passes; }
  /// A stage of so many passes, of which some are planned to be over already.
  void enter(const std::string& stage, std::uint64_t passes, std::uint64_t over);
  /// After each step, planned to take so many passes, that took `passes`; false where the run was told to
  /// stop.
  bool step(std::uint64_t planned = 1, std::uint64_t passes = 1);
  /// Whether it is time for a checkpoint; said once.
  bool checkpoint_due() { return std::exchange(checkpoint_due_, false); }
  /// The stage is over, perhaps before its planned end.
  void leave() { done_ = stage_end_; }
  const std::atomic<bool>* stop() const { return hooks_.stop; }
  bool stopped() const { return hooks_.stop != nullptr && hooks_.stop->load(std::memory_order_relaxed); }
  std::uint64_t particle_steps() const { return taken_ * grains_; }

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.done_, self.taken_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void look();

  const RunHooks& hooks_;
  std::uint64_t grains_, interval_;
  std::uint64_t planned_ = 0, done_ = 0, taken_ = 0, stage_end_ = 0;
  std::string stage_;
  Clock::time_point last_checkpoint_ = Clock::now();
  bool checkpoint_due_ = false;
};

}  // namespace grainlaw::dem
