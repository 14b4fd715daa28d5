#include "grainlaw/dem/watch.hpp"

#include <algorithm>

namespace grainlaw::dem {

namespace {
constexpr std::uint64_t work_between_looks = 200'000;  // particle-steps, some 10 ms
}

Watch::Watch(const RunHooks& hooks, std::size_t grains)
    : hooks_(hooks), grains_(grains), interval_(std::max<std::uint64_t>(1, work_between_looks / grains)) {}

void Watch::enter(const std::string& stage, std::uint64_t steps, std::uint64_t taken) {
  stage_ = stage;
  stage_end_ = done_ - std::min(taken, steps) + steps;
  look();
}

bool Watch::step() {
  if (done_ < stage_end_) ++done_;  // a controlled leg may take longer than planned
  if (++taken_ % interval_ != 0) return true;
  look();
  return !stopped();
}

void Watch::look() {
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - last_checkpoint_).count() >= hooks_.checkpoint_every) {
    checkpoint_due_ = true;
    last_checkpoint_ = now;
  }
  if (hooks_.progress && planned_ > 0)
    hooks_.progress(std::min(1.0, static_cast<double>(done_) / static_cast<double>(planned_)), stage_);
}

}  // namespace grainlaw::dem
