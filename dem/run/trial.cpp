#include "grainlaw/dem/run/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/record/row_writer.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

namespace fs = std::filesystem;

constexpr double trial_seconds = 0.15;  // of rows and files
constexpr double shortest_way = 0.01;   // strain of a component, to and fro
constexpr double longest_way = 0.3;     // at constant volume, if the leg goes so far
constexpr double fast_step = 3e-6;      // strain of a step from which grains move otherwise than after a rest
constexpr double flow_seconds = 0.4;    // at most, until the grains move as the flow makes them
constexpr double moduli_seconds = 6;    // at each density, for states and the way from one to the next
constexpr double between_states = 0.3;  // s, at most, from one state to the next
constexpr std::size_t fewest_states = 3, most_states = 12;
constexpr std::uint64_t steps_between = 5;  // rows
constexpr std::uint64_t fewest_steps = 40, fewest_rows = 5, fewest_files = 3;

double step_of(const Material& material, const State& state, const Stage& stage) {
  if (!stage.leg.minimises()) return stage.stepping.dt;
  return time_step(material, *std::min_element(state.radius.begin(), state.radius.end()),
                   Measure{}.time_step);
}

/// The mean of G along the leg, 1/us.
Mat3 mean_gradient(const State& state, const Leg& leg) {
  return Drive(state.box, leg).gradient(0.5 * leg.duration, leg.duration);
}

/// exp(G dt).
Mat3 stretch_of(const Leg& leg, const Mat3& gradient, double dt) {
  if (leg.gamma) return Mat3::identity() + dt * gradient;  // G G = 0
  return exponential(dt * gradient);
}

double fastest_of(const Mat3& gradient) {
  double fastest = 0;
  for (std::size_t k = 0; k < 9; ++k) fastest = std::max(fastest, std::abs(gradient.data()[k]));
  return fastest;
}

/// How far the box is strained before it turns round: by as much as the leg does, where that leaves the
/// density alone.
double way_of(const Leg& leg, const Mat3& gradient) {
  const double trace = gradient(0, 0) + gradient(1, 1) + gradient(2, 2);
  if (std::abs(trace) > 1e-6 * fastest_of(gradient)) return shortest_way;
  return std::clamp(largest_strain(leg), shortest_way, longest_way);
}

/// How many make this strain; 0 where the box is at rest.
std::uint64_t steps_of(double strain, const Mat3& gradient, double dt) {
  const double fastest = fastest_of(gradient);
  if (!(fastest > 0)) return 0;
  return static_cast<std::uint64_t>(std::clamp(strain / (fastest * dt), 1.0, 1e15));
}

/// Of the text of a table.
double seconds_per_row(const Record& table) {
  return seconds_of([&] { table.to_csv(); }, 0, 1) / static_cast<double>(table.rows());
}

/// A folder of its own among the temporary ones, removed with all that is in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    const fs::path among = fs::temp_directory_path(error);
    std::string name = (among / "grainlaw-explain-XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr) {
      const char* const set = std::getenv("TMPDIR");
      throw Error("TMPDIR", "",
                  "must be a folder that can be written to, for a trial of snapshots and checkpoints, got " +
                      (set != nullptr ? std::string(set) : among.string()));
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

double largest_strain(const Leg& leg) {
  return std::max(std::abs(leg.gamma.value_or(0)), largest_component(leg.strain));
}

Trial::Trial(const Material& material, const State& state, const Stage& stage)
    : material_(material),
      start_(state),
      dt_(step_of(material, state, stage)),
      grains_(static_cast<double>(state.count())),
      gradient_(mean_gradient(state, stage.leg)),
      stretch_(stretch_of(stage.leg, gradient_, dt_)),
      heap_before_(heap_bytes()),
      dynamics_(material, state) {
  cost_.nu = state.volume_fraction();
  steps_a_way_ = steps_of(way_of(stage.leg, gradient_), gradient_, dt_);
  dynamics_.start_flow(dt_, gradient_);
  step();
  cost_.engine_bytes = (heap_bytes() - heap_before_) / grains_;
}

void Trial::step() {
  if (steps_a_way_ > 0 && steps_gone_ == steps_a_way_) {
    gradient_ = -1 * gradient_;
    stretch_ = inverse(stretch_);
    dynamics_.start_flow(dt_, gradient_);
    steps_gone_ = 0;
  }
  dynamics_.step(stretch_ * dynamics_.cell().edges(), gradient_);
  ++steps_gone_;
}

/// Half a way: where the box turns round, grains have fewer contacts.
void Trial::flow_in() {
  if (fastest_of(gradient_) * dt_ < fast_step) return;
  const double begin = thread_seconds();
  while (2 * steps_gone_ < steps_a_way_ && thread_seconds() - begin < flow_seconds) step();
}

void Trial::steps(double seconds) {
  for (std::uint64_t k = 0; k < fewest_steps / 4; ++k) step();
  cost_.step = seconds_of([&] { step(); }, seconds, fewest_steps) / grains_;
  Grains copy = dynamics_.grains();
  const Pairs& pairs = dynamics_.neighbours().pairs();
  const auto force = [&](const ContactLaw& law) {
    return seconds_of([&] { add_contact_forces(law, pairs, dynamics_.cell(), copy); }, trial_seconds / 10, 5);
  };
  const ContactLaw law = dynamics_.law();
  double whole = 0, elastic = 0;
  constexpr int turns = 3;
  for (int turn = 0; turn < turns; ++turn) {
    whole += force(law) / turns;
    if (law.damped()) elastic += force(law.elastic()) / turns;
  }
  cost_.force = whole / grains_;
  cost_.damping = law.damped() ? std::max(whole - elastic, 0.0) / grains_ : 0;
  cost_.pairs = static_cast<double>(pairs.count()) / grains_;
}

/// Seconds of a call after some steps and what comes before it, as in a test that writes rows: what it needs
/// is no longer in the nearest caches, nor how the last one went in the processor's prediction of branches.
/// What takes next to no time is not waited for.
template <class Call, class Before>
double Trial::seconds_between_steps(Call&& call, Before&& before) {
  const double first = thread_seconds();
  double spent = 0, end = first;
  std::uint64_t calls = 0;
  do {
    for (std::uint64_t k = 0; k < steps_between; ++k) step();
    before();
    const double begin = thread_seconds();
    call();
    end = thread_seconds();
    spent += end - begin;
    ++calls;
  } while ((spent < trial_seconds / 10 && end - first < 2 * trial_seconds) || calls < fewest_rows);
  return spent / static_cast<double>(calls);
}

double Trial::seconds_to_measure(const Wanted& wanted) {
  return seconds_between_steps([&] { dynamics_.measure(wanted); }, [] {});
}

double Trial::seconds_to_observe(const std::string& name, const Wanted& standard) {
  observe::Observers one({name});
  const SignConvention sign({Leg{}});
  std::size_t row = 0;
  Quads velocity;
  Measurement measured;
  const auto measure = [&] { velocity = dynamics_.velocities(), measured = dynamics_.measure(one.reads()); };
  const auto observe = [&] { one.observe(dynamics_, velocity, measured, material_, sign, 0, row++); };
  measure();
  observe();  // the first has nothing to compare with
  double seconds = seconds_between_steps(observe, measure);
  for (const auto& table : one.tables())
    seconds += seconds_of([&] { table.rows.to_csv(); }, 0, 1) / static_cast<double>(row);
  const Wanted both = standard | one.reads();
  if (both != standard) seconds += std::max(seconds_to_measure(both) - seconds_to_measure(standard), 0.0);
  return seconds;
}

void Trial::rows(const std::vector<std::string>& standard, const std::vector<std::string>& observers) {
  RowWriter writer(material_, {Leg{}}, cost_.nu, standard);
  const double append = seconds_between_steps([&] { writer.append(dynamics_, 0, 0, 0); }, [] {});
  cost_.row = (append + seconds_per_row(writer.record())) / grains_;
  cost_.contacts = dynamics_.measure(Wanted{.coordination = true}).contacts / grains_;
  for (const std::string& name : observers)
    cost_.observers.push_back(seconds_to_observe(name, writer.wanted()) / grains_);
}

void Trial::threads(int threads) {
  const double before = heap_bytes();
  Dynamics shared(material_, start_, threads);
  shared.start_flow(dt_, gradient_);
  shared.step(stretch_ * shared.cell().edges(), gradient_);
  cost_.threads_bytes = std::max((heap_bytes() - before) / grains_ - cost_.engine_bytes, 0.0);
}

void Trial::snapshot() {
  const ScratchFolder folder;
  SnapshotWriter writer(folder.path() / "trial.h5", start_.radius);
  cost_.snapshot =
      seconds_of([&] { writer.append(dynamics_.state(), {}); }, trial_seconds / 10, fewest_files) / grains_;
}

void Trial::checkpoint() {
  const ScratchFolder folder;
  const fs::path file = folder.path() / "trial.bin";
  const auto write = [&] {
    ArchiveWriter archive(file);
    archive(dynamics_);
    archive.finish();
  };
  cost_.checkpoint = seconds_of(write, trial_seconds / 10, fewest_files) / grains_;
  cost_.checkpoint_bytes = static_cast<double>(fs::file_size(file)) / grains_;
}

void Trial::moduli(const State& flowing, const Stage& stage, std::size_t grains, std::size_t asked) {
  Trial other(material_, flowing, stage);
  const std::uint64_t apart = std::max(fewest_steps, other.steps_a_way_ / most_states);
  const std::size_t enough = std::clamp(asked, fewest_states, most_states);
  const double begin = thread_seconds();
  std::size_t states = 0;
  ModuliCost all;
  while (states < fewest_states || (states < enough && thread_seconds() - begin < moduli_seconds)) {
    const double left = thread_seconds();
    for (std::uint64_t k = 0; k < apart && thread_seconds() - left < between_states; ++k) other.step();
    const ModuliCost one = moduli_cost(material_, other.dynamics_.state(), grains);
    all.seconds += one.seconds;
    all.bytes = std::max(all.bytes, one.bytes);
    ++states;
  }
  cost_.moduli = {all.seconds / static_cast<double>(states), all.bytes};
}

}  // namespace grainlaw::dem
