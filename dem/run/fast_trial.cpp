#include "grainlaw/dem/run/fast_trial.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

namespace {

constexpr double fast_step = 1e-5;       // strain of a step
constexpr double same_density = 1e-6;    // logarithmic
constexpr double many_seconds = 0.8;     // of steps in many
constexpr double share_of_rest = 0.5;    // of the time left, that a relaxation may take
constexpr double spread_of_time = 0.25;  // of seconds, logarithmic, where the steps are known
constexpr double spread_of_end = 0.5;    // where they end as the grains come to rest
constexpr double faster_of_many = 1.08;  // of a step: the fastest of many grains makes lists more often
constexpr double cooling = 1000;         // contact durations, after which most of the motion is gone
constexpr std::uint64_t flight_steps = 60;

double strain_of_step(const Stage& stage) {
  const double strain = std::max(std::abs(stage.leg.gamma.value_or(0)), largest_component(stage.leg.strain));
  return strain / static_cast<double>(stage.stepping.steps);
}

bool is_fast(const Stage& stage) { return !needs_trial(stage) && strain_of_step(stage) > fast_step; }

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

  TrialPacking few_;
  const Material& material_;
  bool fly_ = false;
  double end_;
  ManyOverFew many_over_few_;
  std::optional<LegCost> told_;
};

void FastTrial::run(const Stage& stage, double budget) {
  told_ = few_.run(stage, budget);
  if (told_ && !told_->ended) told_.reset();
}

bool FastTrial::take(const StageCost& cost) {
  const Stage& stage = cost.stage;
  const double left = end_ - thread_seconds();
  told_.reset();
  if (is_fast(stage)) {
    if (left > 0) run(stage, left);
    if (told_) many_over_few_.see(material_, few_, stage.stepping.dt);
    fly_ = true;
    return told_.has_value();
  }
  if (relaxes(stage) && fly_ && left > 0) run(stage, share_of_rest * left);
  if (told_) return true;
  fly_ = false;
  few_.compress_to(cost.nu[1]);
  few_.settle();
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
  return is_fast(stage) && std::abs(strain[0] + strain[1] + strain[2]) > same_density;
}

std::vector<bool> flying(const std::vector<StageCost>& stages, double contact_duration) {
  std::vector<bool> fly;
  bool before = false;
  for (const StageCost& cost : stages) {
    const Stage& stage = cost.stage;
    const bool goes_on =
        is_fast(stage) || (relaxes(stage) && stage.leg.duration < cooling * contact_duration);
    before = compresses_fast(stage) || (before && goes_on);
    fly.push_back(before);
  }
  return fly;
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
