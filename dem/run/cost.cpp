#include "grainlaw/dem/run/cost.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/least_width.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/dem/run/fast_trial.hpp"
#include "grainlaw/dem/run/leg_trial.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/run/trial.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/dem/scene/preparation.hpp"

namespace grainlaw::dem {

namespace {

/// Cost of a step at volume fraction nu, between the two nearest trials.
double step_at(const std::vector<TrialCost>& trials, double nu) {
  const auto above = std::find_if(trials.begin(), trials.end(), [&](const auto& t) { return t.nu >= nu; });
  if (above == trials.begin()) return trials.front().step;
  if (above == trials.end()) return trials.back().step;
  const auto below = std::prev(above);
  return below->step + (above->step - below->step) * (nu - below->nu) / (above->nu - below->nu);
}

/// Mean over the stage: nu rises or falls along it.
double mean_step(const std::vector<TrialCost>& trials, const StageCost& cost) {
  double sum = 0;
  constexpr int samples = 16;
  for (int k = 0; k < samples; ++k) {
    const double share = cost.stage.leg.progress((k + 0.5) / samples * cost.stage.leg.duration);
    sum += step_at(trials, cost.nu[0] * std::pow(cost.nu[1] / cost.nu[0], share));
  }
  return sum / samples;
}

template <class Field>
double bytes_in(const Field&) {
  return sizeof(typename Field::value_type);
}

std::vector<FieldCost> fields_of(double engine_bytes, double threads_bytes) {
  const Grains g;
  std::vector<FieldCost> fields{{"place and radius", bytes_in(g.place)},
                                {"velocity, as the forces see it", bytes_in(g.motion)},
                                {"velocity, half a step before", bytes_in(g.half)},
                                {"force", bytes_in(g.force)},
                                {"acceleration and mass", bytes_in(g.acceleration)},
                                {"number", bytes_in(g.id)}};
  double sum = 0;
  for (const FieldCost& field : fields) sum += field.bytes_per_grain;
  fields.push_back({"lists of pairs, and what keeps them right", std::max(engine_bytes - sum, 0.0)});
  fields.push_back({"room to sort the grains", bytes_in(g.place) + 3 * sizeof(std::uint32_t), true});
  const State s;
  fields.push_back({"state as it is read and written",
                    bytes_in(s.position) + bytes_in(s.velocity) + bytes_in(s.radius), true});
  if (threads_bytes > 0) fields.push_back({"what threads keep to themselves", threads_bytes});
  return fields;
}

/// Of grains that one keeps from row to row.
template <class O>
constexpr std::size_t kept_bytes_of() {
  if constexpr (requires { O::kept_bytes; })
    return O::kept_bytes;
  else
    return 0;
}

/// What an observer holds; its time is for others to say.
ObserverCost memory_of(const std::string& name, double grains, double contacts, std::size_t rows) {
  ObserverCost cost{name};
  observe::for_each_asked({name}, [&]<class O>(std::type_identity<O>) {
    cost.kept_bytes = static_cast<double>(kept_bytes_of<O>()) * grains;
    double table = 0;
    if constexpr (observe::Tabulates<O>)
      table = static_cast<double>(rows * O::table_rows * (O::table_columns.size() + 1) * sizeof(double));
    cost.kept_bytes += table;
    if (O::walks_contacts)
      cost.network_bytes = sizeof(observe::Touch) * contacts + sizeof(std::uint32_t) * grains;
    cost.bytes = static_cast<double>(O::grain_bytes) * grains + table + cost.network_bytes;
  });
  return cost;
}

/// The grains of a scene and the box they start in; places only where they come from a snapshot.
State start_of(const Scene& scene) {
  if (const auto* from = std::get_if<FromSnapshot>(&scene.preparation)) {
    State state = read_frame(from->file, from->choice);
    scene.check_grains(state);
    return state;
  }
  const auto& packing = std::get<NewPacking>(scene.preparation);
  Random random(packing.seed);
  return without_places(draw_radii(scene.material, static_cast<std::size_t>(packing.count), random),
                        packing.nu_gas);
}

/// The stages as they are planned, not yet with their times.
std::vector<StageCost> planned(const Scene& scene, const State& start) {
  const auto* packing = std::get_if<NewPacking>(&scene.preparation);
  double nu = start.volume_fraction();
  const double smallest = *std::min_element(start.radius.begin(), start.radius.end());
  const LongestSteps longest(scene, smallest);
  const std::vector<Stage> stages = plan_stages(scene, packing != nullptr ? packing->nu : nu, longest);
  check_width(stages, start, scene);
  std::vector<StageCost> list;
  for (const Stage& stage : stages) {
    const StrainTensor& strain = stage.leg.strain;
    const double after = nu * std::exp(strain[0] + strain[1] + strain[2]);
    list.push_back({stage, {nu, after}, static_cast<double>(stage.passes())});
    nu = after;
  }
  const std::vector<bool> moves = still_moving(list, time_to_rest(scene.material));
  for (std::size_t k = 0; k < list.size(); ++k) list[k].still_moves = moves[k];
  return list;
}

/// The stage that takes the most steps, of preparation or path.
const StageCost& main_stage(const std::vector<StageCost>& stages, bool of_path) {
  const StageCost* longest = nullptr;
  for (const StageCost& cost : stages)
    if (cost.stage.segment.has_value() == of_path &&
        (longest == nullptr || cost.stage.stepping.steps > longest->stage.stepping.steps))
      longest = &cost;
  return *longest;
}

std::vector<TrialCost> try_preparation(TrialPacking& packing, const Material& material,
                                       const std::vector<StageCost>& stages) {
  std::vector<TrialCost> trials;
  const StageCost& compression = stages.front();
  for (const double share : {0.0, 0.5, 1.0}) {
    packing.compress_to(compression.nu[0] + share * (compression.nu[1] - compression.nu[0]));
    Trial trial(material, packing.state(), compression.stage);
    trial.steps();
    trials.push_back(trial.cost());
  }
  return trials;
}

constexpr double same_density = 0.01;  // of volume fractions for which one trial stands

/// The densities between which the path goes; that at which it begins, where they are about the same.
std::vector<double> densities(const std::vector<StageCost>& stages) {
  double low = 1, high = 0;
  std::optional<double> first;
  for (const StageCost& cost : stages) {
    if (!cost.stage.segment) continue;
    if (!first) first = cost.nu[0];
    for (const double nu : cost.nu) {
      low = std::min(low, nu);
      high = std::max(high, nu);
    }
  }
  if (high - low > same_density) return {low, high};
  return {first.value()};
}

double nearest(double nu, const std::vector<double>& places) {
  return *std::min_element(places.begin(), places.end(),
                           [nu](double a, double b) { return std::abs(a - nu) < std::abs(b - nu); });
}

/// Of a trial on grains of which the scene has `size` times as many.
void note(const std::optional<LegCost>& tried, double size, StageCost& cost) {
  if (!tried) return;
  const double longer = cost.stage.leg.minimises() ? std::pow(size, minimiser_power - 1) : 1;
  cost.tried = true;
  cost.seconds = size * longer * tried->seconds;
  cost.least = size * longer * tried->least;
  cost.most = size * longer * tried->most;
  cost.passes = longer * tried->passes;
  cost.bytes = size * tried->bytes;
}

/// Tries those stages that need it and lie nearest to `place` among `places`, in `flowing` grains at that
/// density. Segments that are repeated are tried once.
void try_stages(const Scene& scene, std::size_t grains, const State& flowing, double place,
                const std::vector<double>& places, const CostOptions& options,
                std::vector<StageCost>& stages) {
  const double size = static_cast<double>(grains) / static_cast<double>(flowing.count());
  const double budget = options.trial_seconds.value_or(usual_trial(Likeness::density));
  std::map<std::string, std::optional<LegCost>> known;
  for (StageCost& cost : stages) {
    if (!cost.stage.segment || !needs_trial(cost.stage) || cost.tried) continue;
    if (nearest(0.5 * (cost.nu[0] + cost.nu[1]), places) != place) continue;
    const auto [found, is_new] = known.try_emplace(scene.path.segments[*cost.stage.segment].key);
    std::optional<LegCost>& tried = found->second;
    if (is_new) tried = try_leg(scene.material, flowing, cost.stage, Likeness::density, budget);
    note(tried, size, cost);
  }
}

/// The grains that a run begins with, with their places.
State first_grains(const Scene& scene, const State& start) {
  const auto* packing = std::get_if<NewPacking>(&scene.preparation);
  return packing != nullptr ? random_gas(scene.material, *packing) : start;
}

constexpr double fastest = 8e-9;  // s, of a step of a grain, so far

/// Of all stages, s.
double shortest_time(const std::vector<StageCost>& stages, std::size_t grains) {
  double steps = 0;
  for (const StageCost& cost : stages) steps += static_cast<double>(cost.stage.passes());
  return fastest * steps * static_cast<double>(grains);
}

/// Processor seconds that a stage may take in the grains that it begins with; 0 where it would take more, or
/// where those before it have taken too long.
double budget_of(const StageCost& cost, std::size_t grains, double spent, const CostOptions& options) {
  constexpr double whole_seconds = 3, all_seconds = 6;  // of a stage with planned steps; of all before it
  const Stage& stage = cost.stage;
  if (!options.trial_seconds && spent > all_seconds) return 0;
  if (needs_trial(stage)) return options.trial_seconds.value_or(usual_trial(Likeness::all));
  const double budget = options.trial_seconds.value_or(whole_seconds);
  const double expected =
      cost.tried ? cost.seconds : fastest * static_cast<double>(grains * stage.stepping.steps);
  return expected < budget ? budget : 0;
}

/// Of the places where a path comes by, the loosest and the densest.
class Extremes {
 public:
  void see(const State& state) {
    const double nu = state.volume_fraction();
    if (states_.empty())
      states_ = {state, state};
    else if (nu < states_[0].volume_fraction())
      states_[0] = state;
    else if (nu > states_[1].volume_fraction())
      states_[1] = state;
  }
  /// One where they are about as dense.
  std::vector<State> take() {
    if (states_[1].volume_fraction() - states_[0].volume_fraction() <= same_density) states_.resize(1);
    return std::move(states_);
  }

 private:
  std::vector<State> states_;
};

constexpr double widest_trial = 0.31;  // strain that a trial may add to a box, its way and a little

/// A gas like the scene's, or the grains of its snapshot; others like these where they are many, or their box
/// is so narrow that a trial could not strain it as it likes.
TrialPacking trial_packing(const Scene& scene, const State& start) {
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation))
    return {scene.material, start.count(), *packing};
  const double largest = *std::max_element(start.radius.begin(), start.radius.end());
  const bool narrow =
      Cell(start.box).narrowest() < std::exp(widest_trial) * least_width(largest, scene.material.r_mean);
  if (narrow || is_laid_out(start.count())) return {scene.material, start.count(), NewPacking{}};
  return {scene.material, start};
}

/// A packing like the scene's, as a run finds it: a gas, or at rest where it begins.
TrialPacking first_trial(const Scene& scene, const State& start) {
  TrialPacking packing = trial_packing(scene, start);
  if (std::holds_alternative<NewPacking>(scene.preparation)) return packing;
  packing.compress_to(start.volume_fraction());
  packing.settle();
  return packing;
}

constexpr double soon_run = 0.3;  // s: a scene so short at its fastest is rather run

/// Fast compressions, and what their grains do after them, where a trial has fewer grains than the scene.
void tell_fast_stages(const Scene& scene, const State& start, const CostOptions& options,
                      std::vector<StageCost>& stages) {
  if (std::none_of(stages.begin(), stages.end(), [](const StageCost& cost) { return cost.still_moves; }))
    return;
  if (!is_laid_out(start.count())) return;
  if (!options.trial_seconds && shortest_time(stages, start.count()) < soon_run) return;
  const TrialPacking few = first_trial(scene, start);
  const double size = static_cast<double>(start.count()) / static_cast<double>(few.base().count());
  const std::vector<std::optional<LegCost>> told =
      try_fast_stages(few, scene.material, stages, options.trial_seconds.value_or(usual_fast_trial));
  for (std::size_t k = 0; k < stages.size(); ++k) {
    note(told[k], size, stages[k]);
    stages[k].still_moves = stages[k].still_moves && !told[k];
  }
}

/// Runs the stages from the first on as a run does, in one and the same grains, as long as each ends within
/// its time; what is run is known to the step. If that is all of them, the loosest and the densest grains
/// between which the path went. After a servo the stages are planned anew, which is not done here.
std::vector<State> run_from_beginning(const Scene& scene, const State& start, const CostOptions& options,
                                      std::vector<StageCost>& stages) {
  if (start.count() > largest_trial) return {};
  Dynamics grains(scene.material, first_grains(scene, start));
  Extremes seen;
  const double begin = thread_seconds();
  for (std::size_t k = 0; k < stages.size(); ++k) {
    StageCost& cost = stages[k];
    const double budget = budget_of(cost, grains.count(), thread_seconds() - begin, options);
    if (!(budget > 0)) return {};
    const bool begins_path = cost.stage.segment && (k == 0 || !stages[k - 1].stage.segment);
    if (begins_path && k > 0) grains.begin_anew(grains.state());  // as a run does
    if (begins_path) seen.see(grains.state());
    const double before = thread_seconds();
    const std::optional<LegCost> tried = try_leg(grains, cost.stage, budget);
    const bool tells = tried && (needs_trial(cost.stage) || tried->ended);
    if (tells)
      note(tried, 1, cost);
    else
      cost.ran = thread_seconds() - before;
    cost.still_moves = cost.still_moves && !tells;
    if (!tried || !tried->ended) return {};
    if (cost.stage.leg.control.by_stress() && k + 1 < stages.size()) return {};
    if (cost.stage.segment) seen.see(grains.state());
  }
  return seen.take();
}

/// What the path does all the time, and how often it looks, in grains that flow as it does, or begin to.
TrialCost try_flow(const Scene& scene, const State& flowing, const State& one_copy, const Stage& main,
                   double seconds_of_steps, std::size_t grains, const CostOptions& options) {
  Trial trial(scene.material, flowing, main);
  trial.flow_in();
  trial.steps(seconds_of_steps);
  trial.rows(scene.measure.standard, scene.measure.observe);
  if (!scene.measure.snapshots.empty()) trial.snapshot();
  trial.checkpoint();
  if (options.threads > 1) trial.threads(options.threads);
  if (const std::size_t states = scene.measure.moduli.size(); states > 0)
    trial.moduli(one_copy, main, grains, states);
  return trial.cost();
}

bool any_waits_for_trial(const std::vector<StageCost>& stages) {
  return std::any_of(stages.begin(), stages.end(), [](const StageCost& cost) {
    return cost.stage.segment && needs_trial(cost.stage) && !cost.tried;
  });
}

std::vector<TrialCost> try_path(TrialPacking packing, const Scene& scene, std::size_t grains,
                                const CostOptions& options, std::vector<StageCost>& stages) {
  const std::vector<double> places = densities(stages);
  const Stage main = main_stage(stages, true).stage;
  const TrialPacking first = packing;
  std::vector<TrialCost> trials;
  for (const double place : places) {
    if (first.is_own()) packing = first;
    packing.compress_to(place);
    const bool own = packing.is_own();
    TrialPacking flowing = packing;
    if (!own || any_waits_for_trial(stages)) {
      flowing.shear();
      flowing.settle();
    }
    const TrialPacking& tried = own ? packing : flowing;
    trials.push_back(
        try_flow(scene, tried.state(), tried.base(), main, own ? own_steps : usual_steps, grains, options));
    try_stages(scene, grains, flowing.base(), place, places, options, stages);
  }
  return trials;
}

/// Of the trials of the path, the mean.
template <class Value>
double mean_of(const std::vector<TrialCost>& trials, Value&& value) {
  double sum = 0;
  for (const TrialCost& trial : trials) sum += value(trial);
  return sum / static_cast<double>(trials.size());
}

/// What one pass over all grains takes, or one of something else, on the path.
double of_all(const std::vector<TrialCost>& path, const SceneCost& cost, double TrialCost::*what) {
  return static_cast<double>(cost.grains) * mean_of(path, [&](const TrialCost& t) { return t.*what; });
}

double per_grain(const std::vector<TrialCost>& path, double TrialCost::*what) {
  return mean_of(path, [&](const TrialCost& t) { return t.*what; });
}

struct Trials {
  std::vector<TrialCost> prepared, path;
};

Trials try_all(const Scene& scene, const State& start, const CostOptions& options,
               std::vector<StageCost>& stages) {
  Trials trials;
  tell_fast_stages(scene, start, options, stages);
  for (const State& seen : run_from_beginning(scene, start, options, stages))
    trials.path.push_back(
        try_flow(scene, seen, seen, main_stage(stages, true).stage, usual_steps, start.count(), options));
  if (!trials.path.empty()) return trials;
  TrialPacking packing = trial_packing(scene, start);
  if (std::holds_alternative<NewPacking>(scene.preparation))
    trials.prepared = try_preparation(packing, scene.material, stages);
  trials.path = try_path(packing, scene, start.count(), options, stages);
  return trials;
}

void take_steps(const std::vector<TrialCost>& path, SceneCost& cost) {
  cost.contacts_per_grain = per_grain(path, &TrialCost::contacts);
  cost.pairs_per_grain = per_grain(path, &TrialCost::pairs);
  cost.force_seconds = of_all(path, cost, &TrialCost::force);
  cost.damping_seconds = of_all(path, cost, &TrialCost::damping);
  cost.motion_seconds = std::max(of_all(path, cost, &TrialCost::step) - cost.force_seconds, 0.0);
  cost.fields =
      fields_of(per_grain(path, &TrialCost::engine_bytes), per_grain(path, &TrialCost::threads_bytes));
}

void take_rows_and_files(const Scene& scene, const std::vector<TrialCost>& path, SceneCost& cost) {
  cost.row_seconds = of_all(path, cost, &TrialCost::row);
  cost.rows = scene.record_rows();
  cost.snapshots = scene.measure.snapshots.size();
  cost.snapshot_seconds = of_all(path, cost, &TrialCost::snapshot);
  cost.snapshot_bytes = static_cast<double>(cost.grains) * 2 * sizeof(Vec3);
  cost.checkpoint_seconds = of_all(path, cost, &TrialCost::checkpoint);
  cost.checkpoint_bytes = of_all(path, cost, &TrialCost::checkpoint_bytes);
}

void take_moduli(const Scene& scene, const std::vector<TrialCost>& path, SceneCost& cost) {
  cost.moduli = scene.measure.moduli.size();
  for (const TrialCost& trial : path) {
    cost.moduli_seconds = std::max(cost.moduli_seconds, trial.moduli.seconds);
    cost.moduli_bytes = std::max(cost.moduli_bytes, trial.moduli.bytes);
  }
}

/// The time of a stage that was not tried, by its planned passes.
double planned_seconds(const Trials& trials, const StageCost& stage, const SceneCost& cost) {
  if (stage.stage.leg.minimises()) return stage.passes * cost.force_seconds;
  const std::vector<TrialCost>& near = stage.stage.segment ? trials.path : trials.prepared;
  return stage.passes * static_cast<double>(cost.grains) * mean_step(near, stage);
}

/// What has run for a time, and did not end, takes no less.
void heed_what_ran(StageCost& cost) {
  constexpr double clearly = 0.8;
  if (!(cost.seconds < clearly * cost.ran)) return;
  cost.seconds = cost.ran;
  cost.least = std::max(cost.least, cost.ran);
  cost.most = std::max(cost.most, cost.ran);
  cost.still_moves = true;
}

void take_stages(const Trials& trials, std::vector<StageCost> stages, SceneCost& cost) {
  for (StageCost& stage : stages) {
    if (!stage.tried) {
      stage.seconds = stage.most = planned_seconds(trials, stage, cost);
      stage.least = stage.stage.leg.drives() ? stage.seconds : 0;
    }
    heed_what_ran(stage);
  }
  cost.stages = std::move(stages);
}

void take_observers(const Scene& scene, const std::vector<TrialCost>& path, SceneCost& cost) {
  const double grains = static_cast<double>(cost.grains);
  double contacts = 0;  // the most: their memory is kept
  for (const TrialCost& trial : path) contacts = std::max(contacts, trial.contacts);
  for (std::size_t k = 0; k < scene.measure.observe.size(); ++k) {
    ObserverCost one = memory_of(scene.measure.observe[k], grains, grains * contacts, cost.rows);
    one.seconds_per_row = grains * mean_of(path, [&](const auto& t) { return t.observers[k]; });
    cost.observers.push_back(one);
  }
}

}  // namespace

SceneCost cost_of(const Scene& scene, const CostOptions& options) {
  const State start = start_of(scene);
  std::vector<StageCost> stages = planned(scene, start);
  const Trials trials = try_all(scene, start, options, stages);
  SceneCost cost;
  cost.grains = start.count();
  cost.checkpoint_every = options.checkpoint_every;
  take_steps(trials.path, cost);
  take_rows_and_files(scene, trials.path, cost);
  take_moduli(scene, trials.path, cost);
  take_stages(trials, std::move(stages), cost);
  take_observers(scene, trials.path, cost);
  return cost;
}

}  // namespace grainlaw::dem
