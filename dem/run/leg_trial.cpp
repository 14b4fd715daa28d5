#include "grainlaw/dem/run/leg_trial.hpp"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double plan_counts = 0.1;         // w: the share of a leg that its plan counts as
constexpr double spread_of_shares = 0.2;    // c: of passes per share, from one part of a leg to others
constexpr double spread_of_packings = 0.6;  // of passes, between packings that are only as dense
constexpr double before_end = 0.95;         // a leg whose stresses are not on target is not done
constexpr std::size_t most_pieces = 8;
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
  if (stage.leg.controlled()) return std::min(state.control.progress, before_end);
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

/// Passes until a share was done, between the marks about it.
double passes_at(const std::vector<LegMark>& seen, double share) {
  const auto behind = std::lower_bound(seen.begin(), seen.end(), share,
                                       [](const LegMark& mark, double at) { return mark.share < at; });
  if (behind == seen.end()) return seen.back().passes;
  const LegMark before = behind == seen.begin() ? LegMark{} : *std::prev(behind);
  if (!(behind->share > before.share)) return behind->passes;
  return before.passes +
         (behind->passes - before.passes) * (share - before.share) / (behind->share - before.share);
}

/// Relative standard error of the mean of what equal pieces of the share took; of a single mark nothing is
/// known, and pieces smaller than from one mark to the next would all be alike.
double error_of_pieces(const std::vector<LegMark>& seen) {
  const std::size_t pieces = std::min(most_pieces, seen.size());
  if (pieces < 2) return 1;
  const double count = static_cast<double>(pieces), piece = seen.back().share / count,
               mean = seen.back().passes / count;
  double squares = 0;
  for (std::size_t k = 0; k < pieces; ++k) {
    const double from = static_cast<double>(k) * piece;
    squares += std::pow((passes_at(seen, from + piece) - passes_at(seen, from)) / mean - 1, 2);
  }
  return std::sqrt(squares / ((count - 1) * count));
}

/// A stage that is run until it ends, or its time is over.
class LegTrial {
 public:
  LegTrial(Dynamics& grains, const Stage& stage, double budget)
      : stage_(stage), budget_(budget), dynamics_(grains) {}

  /// False where the grains cannot follow: an increment without balance, a motion that is unstable.
  bool run();
  bool ended() const;
  bool lost() const { return state_.control.lost; }
  double seconds() const { return seconds_; }
  double passes() const { return passes_; }
  const std::vector<LegMark>& seen() const { return seen_; }
  /// The time since the last look, of an increment in its midst, at the pace until then.
  double passes_under_way() const { return at_look_ > 0 ? passes_ * (seconds_ - at_look_) / at_look_ : 0; }

 private:
  bool after(std::uint64_t step);

  const Stage& stage_;
  double budget_;
  Dynamics& dynamics_;
  LegState state_;
  double begin_ = 0, at_look_ = 0, seconds_ = 0, passes_ = 0;
  bool left_ = false;
  std::vector<LegMark> seen_;
};

bool LegTrial::after(std::uint64_t step) {
  passes_ += static_cast<double>(state_.passes);
  if (!stage_.leg.minimises() && (step % steps_per_look != 0 || step < fewest_looks * steps_per_look))
    return true;
  // A share that falls, where a servo takes back what it did to the box, is no new part.
  const double before = seen_.empty() ? 0 : seen_.back().share;
  seen_.push_back({std::max(before, share_done(stage_, state_)), passes_});
  at_look_ = thread_seconds() - begin_;
  left_ = at_look_ >= budget_;
  return !left_;
}

bool LegTrial::run() {
  begin_ = thread_seconds();
  try {
    const Alarm alarm(budget_);  // for an increment that takes longer
    drive(
        dynamics_, stage_.leg, stage_.stepping, state_, [this](std::uint64_t step) { return after(step); },
        alarm.rung());
  } catch (const Error&) {
    return false;
  }
  seconds_ = thread_seconds() - begin_;
  return true;
}

bool LegTrial::ended() const {
  if (stage_.leg.minimises()) return state_.step == stage_.stepping.steps;
  return !left_ && !state_.control.lost;
}

/// Of a part: its passes in seconds, at the pace of the trial.
std::optional<LegCost> extrapolated(const LegTrial& trial, double planned, Likeness like) {
  if (trial.seen().empty() || !(trial.seen().back().share > 0)) return std::nullopt;
  std::vector<LegMark> seen = trial.seen();
  seen.back().passes += trial.passes_under_way();
  const LegPasses passes = passes_of(seen, planned, like);
  const double pace = trial.seconds() / seen.back().passes;
  LegCost cost;
  cost.passes = passes.all;
  cost.seconds = pace * passes.all;
  cost.least = pace * passes.least;
  cost.most = pace * passes.most;
  return cost;
}

/// Of grains that are only as dense, what a whole leg takes is uncertain too.
LegCost whole(const LegTrial& trial, Likeness like) {
  const double factor = like == Likeness::all ? 1 : std::exp(spread_of_packings), all = trial.seconds();
  LegCost cost;
  cost.seconds = all;
  cost.least = all / factor;
  cost.most = all * factor;
  cost.passes = trial.passes();
  return cost;
}

}  // namespace

LegPasses passes_of(const std::vector<LegMark>& seen, double planned, Likeness like) {
  const auto [share, passes] = seen.back();
  const double rest = (1 - share) * (passes + plan_counts * planned) / (share + plan_counts);
  const double e = std::hypot(2 * error_of_pieces(seen), spread_of_shares / std::sqrt(share + plan_counts));
  const double all = passes + rest;
  if (like == Likeness::all) return {all, passes + rest * std::exp(-e), passes + rest * std::exp(e)};
  const double of_all = std::exp(std::hypot(e * rest / all, spread_of_packings));
  return {all, all / of_all, all * of_all};
}

namespace {

std::optional<LegCost> try_in(Dynamics& grains, const Stage& stage, Likeness like, double budget) {
  const bool only_waits = stage.leg.controlled() && !stage.leg.drives();
  if (only_waits && like == Likeness::density) return std::nullopt;
  LegTrial trial(grains, stage, budget);
  if (!trial.run()) return std::nullopt;
  std::optional<LegCost> cost;
  if (trial.ended())
    cost = whole(trial, like);
  else if (like == Likeness::density || !trial.lost())
    cost = extrapolated(trial, static_cast<double>(stage.passes()), like);
  if (!cost) return std::nullopt;
  cost->ended = trial.ended();
  if (stage.leg.minimises()) cost->bytes = minimiser_bytes(grains.material(), grains.state());
  return cost;
}

}  // namespace

std::optional<LegCost> try_leg(const Material& material, const State& grains, const Stage& wanted,
                               Likeness like, double budget) {
  Stage stage = wanted;
  if (like == Likeness::density) stage.leg.control = kept_at_start(stage.leg.control);
  Dynamics own(material, grains);
  return try_in(own, stage, like, budget);
}

std::optional<LegCost> try_leg(Dynamics& grains, const Stage& stage, double budget) {
  return try_in(grains, stage, Likeness::all, budget);
}

}  // namespace grainlaw::dem
