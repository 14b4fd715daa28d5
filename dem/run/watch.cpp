#include "grainlaw/dem/run/watch.hpp"

#include <algorithm>

namespace grainlaw::dem {

namespace {
constexpr std::uint64_t work_between_looks = 200'000;  // particle-steps, some 10 ms
}

Watch::Watch(const RunHooks& hooks, std::size_t grains)
    : hooks_(hooks), grains_(grains), interval_(std::max<std::uint64_t>(1, work_between_looks / grains)) {}

void Watch::enter(const std::string& stage, std::uint64_t passes, std::uint64_t over) {
  stage_ = stage;
  stage_end_ = done_ - std::min(over, passes) + passes;
  look();
}

bool Watch::step(std::uint64_t planned, std::uint64_t passes) {
  done_ = std::min(done_ + planned,
                   std::max(done_, stage_end_));  // a controlled leg may take longer than planned
  const std::uint64_t before = taken_ / interval_;
  taken_ += passes;
  if (taken_ / interval_ == before) return true;
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
