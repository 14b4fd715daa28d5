#include "grainlaw/dem/run/cost.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <type_traits>
#include <utility>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/dem/record/row_writer.hpp"
#include "grainlaw/dem/run/moduli_cost.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/step/forces.hpp"

namespace grainlaw::dem {

namespace {

constexpr double trial_seconds = 0.15;  // of steps, at each density
constexpr std::uint64_t fewest_steps = 40, fewest_rows = 5;
constexpr std::size_t moduli_grains = 1000;  // at most, where moduli are tried

/// What is allocated, in bytes.
double heap_bytes() {
  const auto heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

/// Seconds of a call, from as many as fit into `budget` seconds; at least `least`.
template <class F>
double seconds_of(F&& call, double budget, std::uint64_t least) {
  const double begin = thread_seconds();
  std::uint64_t calls = 0;
  double spent = 0;
  do {
    call();
    ++calls;
    spent = thread_seconds() - begin;
  } while (spent < budget || calls < least);
  return spent / static_cast<double>(calls);
}

/// Costs per grain in one packing, s.
struct TrialCost {
  double nu = 0;
  double step = 0, force = 0, row = 0;
  std::vector<double> observers;
  double contacts = 0, pairs = 0, bytes = 0;
  double moduli = 0;  ///< of a state, not per grain
};

class Trial {
 public:
  /// At the mean rate of `stage` and with its step; where that minimises, with a step of the default.
  Trial(const Material& material, const State& state, const Stage& stage)
      : material_(material),
        dt_(stage.leg.minimises()
                ? time_step(material, *std::min_element(state.radius.begin(), state.radius.end()),
                            Measure{}.time_step)
                : stage.stepping.dt),
        grains_(static_cast<double>(state.count())),
        heap_before_(heap_bytes()),
        dynamics_(material, state) {
    for (std::size_t c = 0; c < 3; ++c) rate_[c] = -stage.leg.strain[c] / stage.leg.duration;
    cost_.nu = state.volume_fraction();
    dynamics_.start(dt_, rate_);
    step();
    cost_.bytes = (heap_bytes() - heap_before_) / grains_;
  }

  void steps() {
    for (std::uint64_t k = 0; k < fewest_steps / 4; ++k) step();
    cost_.step = seconds_of([&] { step(); }, trial_seconds, fewest_steps) / grains_;
    Grains copy = dynamics_.grains();
    const Pairs& pairs = dynamics_.neighbours().pairs();
    cost_.force = seconds_of([&] { add_contact_forces(dynamics_.law(), pairs, dynamics_.cell(), copy); },
                             trial_seconds / 10, 5) /
                  grains_;
    cost_.pairs = static_cast<double>(pairs.count()) / grains_;
  }

  void rows(const std::vector<std::string>& asked) {
    const Leg leg{};
    RowWriter writer(material_, {leg}, cost_.nu);
    const double append = seconds_between_steps([&] { writer.append(dynamics_, 0, 0, 0); });
    cost_.row = (append + seconds_per_row(writer.record())) / grains_;
    cost_.contacts = static_cast<double>(dynamics_.measure().contacts) / grains_;
    const SignConvention sign({leg});
    for (const std::string& name : asked) {
      observe::Observers one({name});
      std::size_t row = 0;
      Quads velocity;
      Measurement measured;
      const auto measure = [&] { velocity = dynamics_.velocities(), measured = dynamics_.measure(); };
      const auto observe = [&] { one.observe(dynamics_, velocity, measured, material_, sign, 0, row++); };
      measure();
      observe();  // the first has nothing to compare with
      double seconds = seconds_between_steps(observe, measure);
      for (const auto& table : one.tables())
        seconds += seconds_of([&] { table.rows.to_csv(); }, 0, 1) / static_cast<double>(row);
      cost_.observers.push_back(seconds / grains_);
    }
  }

  void moduli(const State& base, std::size_t grains) {
    cost_.moduli = moduli_seconds(material_, base, grains);
  }
  const TrialCost& cost() const { return cost_; }

 private:
  /// Seconds of a call after each step and what comes before it, as in a test that writes rows: with what it
  /// needs no longer in the nearest caches.
  template <class Call, class Before>
  double seconds_between_steps(Call&& call, Before&& before) {
    double spent = 0;
    std::uint64_t calls = 0;
    do {
      step();
      before();
      const double begin = thread_seconds();
      call();
      spent += thread_seconds() - begin;
      ++calls;
    } while (spent < trial_seconds / 10 || calls < fewest_rows);
    return spent / static_cast<double>(calls);
  }
  template <class Call>
  double seconds_between_steps(Call&& call) {
    return seconds_between_steps(call, [] {});
  }
  /// Of the text of a table.
  static double seconds_per_row(const Record& table) {
    return seconds_of([&] { table.to_csv(); }, 0, 1) / static_cast<double>(table.rows());
  }

  void step() {
    Vec3 length = dynamics_.cell().length();
    for (std::size_t c = 0; c < 3; ++c) length[c] *= std::exp(rate_[c] * dt_);
    dynamics_.step(length, rate_);
  }

  const Material& material_;
  double dt_;
  Vec3 rate_{};
  double grains_, heap_before_;
  Dynamics dynamics_;
  TrialCost cost_;
};

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

std::vector<FieldCost> fields_of(double engine_bytes) {
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
  const State s;
  fields.push_back(
      {"state as it is read and written", bytes_in(s.position) + bytes_in(s.velocity) + bytes_in(s.radius)});
  return fields;
}

/// Bytes of an observer: kept from row to row, and while a row is measured.
double bytes_of(const std::string& name, double grains, double contacts, std::size_t rows) {
  double bytes = 0;
  observe::for_each_asked({name}, [&]<class O>(std::type_identity<O>) {
    bytes = static_cast<double>(O::grain_bytes) * grains;
    if (O::walks_contacts) bytes += sizeof(observe::Touch) * contacts + sizeof(std::uint32_t) * grains;
    if constexpr (observe::Tabulates<O>)
      bytes += static_cast<double>(rows * O::table_rows * (O::table_columns.size() + 1) * sizeof(double));
  });
  return bytes;
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
  State state;
  state.radius = draw_radii(scene.material, static_cast<std::size_t>(packing.count), random);
  state.box = Mat3::identity();
  const double edge = std::cbrt(state.volume_fraction() / packing.nu_gas);
  state.box = Mat3::diagonal({edge, edge, edge});
  return state;
}

/// The stages as they are planned, not yet with their times.
std::vector<StageCost> planned(const Scene& scene, const State& start) {
  const auto* packing = std::get_if<NewPacking>(&scene.preparation);
  double nu = start.volume_fraction();
  const LongestSteps longest(scene, *std::min_element(start.radius.begin(), start.radius.end()));
  const std::vector<Stage> stages = plan_stages(scene, packing != nullptr ? packing->nu : nu, longest);
  check_width(stages, start, scene);
  std::vector<StageCost> list;
  for (const Stage& stage : stages) {
    const StrainTensor& strain = stage.leg.strain;
    const double after = nu * std::exp(strain[0] + strain[1] + strain[2]);
    list.push_back({stage, {nu, after}, 0});
    nu = after;
  }
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

/// `few`: the same with few grains, for the moduli.
std::vector<TrialCost> try_path(TrialPacking& packing, TrialPacking& few, const Scene& scene,
                                std::size_t grains, const std::vector<StageCost>& stages) {
  double low = 1, high = 0;
  for (const StageCost& cost : stages)
    if (cost.stage.segment)
      for (const double nu : cost.nu) {
        low = std::min(low, nu);
        high = std::max(high, nu);
      }
  std::vector<double> places{low};
  if (high - low > 0.01) places.push_back(high);
  std::vector<TrialCost> trials;
  for (const double nu : places) {
    packing.compress_to(nu);
    TrialPacking flowing = packing;
    flowing.shear();
    Trial trial(scene.material, flowing.state(), main_stage(stages, true).stage);
    trial.steps();
    trial.rows(scene.measure.observe);
    if (!scene.measure.moduli.empty()) {
      few.compress_to(nu);
      trial.moduli(few.base(), grains);
    }
    trials.push_back(trial.cost());
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

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double SceneCost::seconds() const {
  double sum = row_seconds * static_cast<double>(rows) + moduli_seconds * static_cast<double>(moduli);
  for (const ObserverCost& observer : observers) sum += observer.seconds_per_row * static_cast<double>(rows);
  for (const StageCost& stage : stages) sum += stage.seconds;
  return sum;
}

double SceneCost::particle_steps() const {
  double sum = 0;
  for (const StageCost& stage : stages)
    sum += static_cast<double>(stage.stage.passes()) * static_cast<double>(grains);
  return sum;
}

double SceneCost::bytes() const {
  double sum = 0;
  for (const FieldCost& field : fields) sum += field.bytes_per_grain * static_cast<double>(grains);
  for (const ObserverCost& observer : observers) sum += observer.bytes;
  return sum;
}

SceneCost cost_of(const Scene& scene) {
  const State start = start_of(scene);
  std::vector<StageCost> stages = planned(scene, start);
  const auto* own = std::get_if<NewPacking>(&scene.preparation);
  const NewPacking like = own != nullptr ? *own : NewPacking{};
  TrialPacking packing(scene.material, start.count(), like);
  TrialPacking few(scene.material, std::min(start.count(), moduli_grains), like);
  std::vector<TrialCost> prepared;
  if (own != nullptr) prepared = try_preparation(packing, scene.material, stages);
  const std::vector<TrialCost> path = try_path(packing, few, scene, start.count(), stages);
  const double grains = static_cast<double>(start.count());
  SceneCost cost;
  cost.grains = start.count();
  cost.contacts_per_grain = mean_of(path, [](const auto& t) { return t.contacts; });
  cost.pairs_per_grain = mean_of(path, [](const auto& t) { return t.pairs; });
  cost.force_seconds = grains * mean_of(path, [](const auto& t) { return t.force; });
  cost.motion_seconds = grains * mean_of(path, [](const auto& t) { return t.step - t.force; });
  cost.row_seconds = grains * mean_of(path, [](const auto& t) { return t.row; });
  cost.rows = scene.record_rows();
  cost.snapshots = scene.measure.snapshots.size();
  cost.moduli = scene.measure.moduli.size();
  for (const TrialCost& trial : path) cost.moduli_seconds = std::max(cost.moduli_seconds, trial.moduli);
  cost.snapshot_bytes = grains * 2 * sizeof(Vec3);
  cost.fields = fields_of(mean_of(path, [](const auto& t) { return t.bytes; }));
  for (StageCost& stage : stages)
    stage.seconds =
        static_cast<double>(stage.stage.passes()) *
        (stage.stage.leg.minimises() ? cost.force_seconds
                                     : grains * mean_step(stage.stage.segment ? path : prepared, stage));
  cost.stages = std::move(stages);
  for (std::size_t k = 0; k < scene.measure.observe.size(); ++k) {
    const std::string& name = scene.measure.observe[k];
    cost.observers.push_back({name, grains * mean_of(path, [&](const auto& t) { return t.observers[k]; }),
                              bytes_of(name, grains, grains * cost.contacts_per_grain, cost.rows)});
  }
  return cost;
}

}  // namespace grainlaw::dem
