#include "grainlaw/dem/run/fast_trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/run/trial.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

namespace {

constexpr double fast_compression = 1e-5;  // strain of a step
constexpr double same_volume = 1e-6;       // logarithmic
constexpr double many_seconds = 0.8;       // of steps in many
constexpr double share_of_rest = 0.5;      // of the time left, that a relaxation may take
constexpr double spread_of_time = 0.25;    // of seconds, logarithmic, where the steps are known
constexpr double spread_of_end = 0.5;      // where they end as the grains come to rest
constexpr double faster_of_many = 1.08;    // of a step: the fastest of many grains makes lists more often
constexpr double relaxation_times = 7;     // after which most of the motion is gone
constexpr std::uint64_t flight_steps = 60;

bool is_fast(const Stage& stage) {
  return !needs_trial(stage) &&
         largest_strain(stage.leg) / static_cast<double>(stage.stepping.steps) > fast_compression;
}

bool relaxes(const Stage& stage) { return !needs_trial(stage) && !stage.leg.drives(); }

/// Seconds of a step of one grain among these, in a box at rest.
double seconds_in_flight(const Material& material, const State& grains, double dt) {
  Dynamics dynamics(material, grains);
  const Mat3 edges = dynamics.cell().edges(), rest{};
  dynamics.start_flow(dt, rest);
  dynamics.step(edges, rest);
  return seconds_of([&] { dynamics.step(edges, rest); }, 0, flight_steps) /
         static_cast<double>(grains.count());
}

/// What a step of a grain takes among many over what it takes among few, where they fly: the mean over some
/// moments.
class ManyOverFew {
 public:
  void see(const Material& material, const TrialPacking& packing, double dt) {
    if (spent_ > many_seconds) return;
    const double begin = thread_seconds();
    constexpr int turns = 3;
    for (int turn = 0; turn < turns; ++turn) few_ += seconds_in_flight(material, packing.base(), dt) / turns;
    many_ += seconds_in_flight(material, packing.state(), dt);
    spent_ += thread_seconds() - begin;
  }
  double ratio() const { return few_ > 0 ? faster_of_many * many_ / few_ : 1; }

 private:
  double few_ = 0, many_ = 0, spent_ = 0;
};

/// The stages one after the other.
class FastTrial {
 public:
  FastTrial(TrialPacking few, const Material& material, double budget)
      : few_(std::move(few)), material_(material), end_(thread_seconds() + budget) {}

  /// False where there is no going on.
  bool take(const StageCost& cost);
  double ratio() const { return many_over_few_.ratio(); }
  /// Of the last stage, among few; none where it was not run to its end.
  const std::optional<LegCost>& told() const { return told_; }

 private:
  void run(const Stage& stage, double budget);
  void come_to_rest();

  TrialPacking few_;
  const Material& material_;
  bool moved_ = false;             // by a fast stage
  std::optional<double> rest_at_;  // volume fraction at which slow stages have left them, not yet gone to
  double end_;
  ManyOverFew many_over_few_;
  std::optional<LegCost> told_;
};

void FastTrial::run(const Stage& stage, double budget) {
  told_ = few_.run(stage, budget);
  if (told_ && !told_->ended) told_.reset();
}

void FastTrial::come_to_rest() {
  if (!rest_at_) return;
  few_.compress_to(*rest_at_);
  few_.settle();
  rest_at_.reset();
}

bool FastTrial::take(const StageCost& cost) {
  const Stage& stage = cost.stage;
  told_.reset();
  const bool fast = is_fast(stage), left_moving = !rest_at_ && moved_;
  if (fast) come_to_rest();
  const double left = end_ - thread_seconds();
  if (left <= 0) return false;
  if (fast || (relaxes(stage) && left_moving)) run(stage, fast ? left : share_of_rest * left);
  if (fast) {
    if (told_) many_over_few_.see(material_, few_, stage.stepping.dt);
    moved_ = true;
    return told_.has_value();
  }
  if (!told_) rest_at_ = cost.nu[1];
  return !stage.leg.control.by_stress();
}

void widen(const Stage& stage, double ratio, LegCost& cost) {
  const bool ends_early = cost.passes < static_cast<double>(stage.passes());
  const double factor = std::exp(ends_early ? spread_of_end : spread_of_time);
  cost.seconds *= ratio;
  cost.least = cost.seconds / factor;
  cost.most = cost.seconds * factor;
}

}  // namespace

bool compresses_fast(const Stage& stage) {
  const StrainTensor& strain = stage.leg.strain;
  return is_fast(stage) && std::abs(strain[0] + strain[1] + strain[2]) > same_volume;
}

double time_to_rest(const Material& material) {
  if (!(material.gamma_b > 0)) return std::numeric_limits<double>::infinity();
  return relaxation_times * material.rho * sphere_volume(material.r_mean) / material.gamma_b;
}

std::vector<bool> still_moving(const std::vector<StageCost>& stages, double time_to_rest) {
  std::vector<bool> list;
  bool moving = false;
  double calm = 0;  // time since the last fast stage, us
  for (const StageCost& cost : stages) {
    const Stage& stage = cost.stage;
    if (compresses_fast(stage)) moving = true;
    if (is_fast(stage))
      calm = 0;
    else if (!stage.leg.minimises())
      calm += stage.leg.duration;
    moving = moving && calm < time_to_rest;
    list.push_back(moving);
    moving = moving && !stage.leg.minimises();
  }
  return list;
}

std::vector<std::optional<LegCost>> try_fast_stages(TrialPacking few, const Material& material,
                                                    const std::vector<StageCost>& stages, double budget) {
  std::vector<std::optional<LegCost>> told(stages.size());
  FastTrial trial(std::move(few), material, budget);
  const auto more_to_come = [&](std::size_t k) {
    return std::any_of(stages.begin() + static_cast<std::ptrdiff_t>(k), stages.end(),
                       [](const StageCost& cost) { return compresses_fast(cost.stage); });
  };
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const bool follows = k > 0 && told[k - 1] && (is_fast(stages[k].stage) || relaxes(stages[k].stage));
    if (!more_to_come(k) && !follows) break;
    if (!trial.take(stages[k])) break;
    told[k] = trial.told();
  }
  for (std::size_t k = 0; k < stages.size(); ++k)
    if (told[k]) widen(stages[k].stage, trial.ratio(), *told[k]);
  return told;
}

}  // namespace grainlaw::dem
