#include "grainlaw/dem/run/leg_trial.hpp"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <thread>
#include <variant>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double part_seconds = 0.5, warm_up = 0.3, whole_seconds = 1.5;
constexpr std::chrono::milliseconds look_every{20};
constexpr std::uint64_t fewest_looks = 20, steps_per_look = 10;

Control kept_at_start(Control control) {
  for (ComponentControl& component : control.component)
    if (auto* target = std::get_if<StressTarget>(&component)) target->stress.reset();
  if (control.mean) control.mean->stress.reset();
  return control;
}

/// The share of the leg that was done.
double share_done(const Stage& stage, const LegState& state) {
  if (stage.leg.controlled()) return state.control.progress;
  return static_cast<double>(state.step) / static_cast<double>(stage.stepping.steps);
}

double minimiser_bytes(const Material& material, const State& state) {
  const double before = heap_bytes();
  StaticPacking packing(material, state);
  packing.find_contacts();
  return heap_bytes() - before;
}

/// Rings when the thread that sets it has spent so many processor seconds.
class Alarm {
 public:
  explicit Alarm(double seconds) : end_(thread_seconds() + seconds) {
    if (::pthread_getcpuclockid(::pthread_self(), &clock_) != 0) throw Error("no clock of this thread");
    thread_ = std::thread([this] { watch(); });
  }
  ~Alarm() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    cancelled_.notify_one();
    thread_.join();
  }
  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;
  const std::atomic<bool>* rung() const { return &rung_; }

 private:
  void watch() {
    std::unique_lock lock(mutex_);
    while (!rung_ && !cancelled_.wait_for(lock, look_every, [this] { return done_; })) {
      timespec now{};
      ::clock_gettime(clock_, &now);
      rung_ = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) > end_;
    }
  }

  double end_;
  ::clockid_t clock_{};
  std::mutex mutex_;
  std::condition_variable cancelled_;
  bool done_ = false;
  std::atomic<bool> rung_ = false;
  std::thread thread_;
};

/// How far a trial is.
struct Mark {
  double seconds = 0, share = 0, passes = 0;
};

/// Of the whole leg: what was measured, where it came to its end; else by what it is like beyond the way into
/// it, if it came so far.
std::optional<LegCost> whole(const Mark& warm, const Mark& end) {
  if (end.share >= 1) return LegCost{end.seconds, end.passes, 0};
  const Mark from = end.share > warm.share ? warm : Mark{};
  const double part = end.share - from.share;
  if (!(part > 0)) return std::nullopt;
  return LegCost{(end.seconds - from.seconds) / part, (end.passes - from.passes) / part, 0};
}

}  // namespace

std::optional<LegCost> try_leg(const Material& material, const State& grains, const Stage& wanted,
                               Likeness like) {
  if (wanted.leg.controlled() && !wanted.leg.drives()) return std::nullopt;
  Stage stage = wanted;
  if (like == Likeness::density) stage.leg.control = kept_at_start(stage.leg.control);
  Dynamics dynamics(material, grains);
  LegState state;
  const bool by_increments = stage.leg.minimises();
  const double budget = like == Likeness::all ? whole_seconds : part_seconds;
  const double begin = thread_seconds();
  double passes = 0;
  const auto mark = [&] { return Mark{thread_seconds() - begin, share_done(stage, state), passes}; };
  Mark warm;
  const auto go_on = [&](std::uint64_t step) {
    passes += static_cast<double>(state.passes);
    if (!by_increments && (step % steps_per_look != 0 || step < fewest_looks * steps_per_look)) return true;
    const Mark now = mark();
    if (warm.seconds == 0 && now.seconds > warm_up * part_seconds) warm = now;
    return now.seconds < budget;
  };
  try {
    const Alarm alarm(budget);  // for an increment that takes longer
    drive(dynamics, stage.leg, stage.stepping, state, go_on, alarm.rung());
  } catch (const Error&) {  // an increment that cannot be brought into balance, grains that do not hold
    return std::nullopt;
  }
  const Mark end = mark();
  if (like == Likeness::all && end.share < 1) return std::nullopt;
  std::optional<LegCost> cost = whole(warm, end);
  if (cost && by_increments) cost->bytes = minimiser_bytes(material, grains);
  return cost;
}

}  // namespace grainlaw::dem
