#include "grainlaw/dem/element_test.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <system_error>

#include "grainlaw/dem/drive.hpp"
#include "grainlaw/dem/preparation.hpp"
#include "grainlaw/dem/provenance.hpp"
#include "grainlaw/dem/row_writer.hpp"
#include "grainlaw/dem/snapshot.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::dem {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t work_between_looks = 200'000;  // particle-steps, some 10 ms
constexpr std::uint64_t least_steps_per_row = 2;

double smallest_of(const std::vector<double>& list) { return *std::min_element(list.begin(), list.end()); }

/// Counts steps, tells how far the run is and whether it should go on.
class Watch {
 public:
  Watch(const RunHooks& hooks, std::size_t grains)
      : hooks_(hooks), grains_(grains), interval_(std::max<std::uint64_t>(1, work_between_looks / grains)) {}

  void plan(std::uint64_t steps) { planned_ += steps; }
  void enter(std::string stage, std::uint64_t steps) {
    stage_ = std::move(stage);
    stage_end_ = done_ + steps;
    report();
  }
  /// After each step; false where the run was told to stop.
  bool step() {
    ++taken_;
    if (++done_ % interval_ != 0) return true;
    report();
    return !stopped();
  }
  /// The stage is over, perhaps before its planned end.
  void leave() { done_ = stage_end_; }
  bool stopped() const { return hooks_.stop != nullptr && hooks_.stop->load(std::memory_order_relaxed); }
  std::uint64_t particle_steps() const { return taken_ * grains_; }

 private:
  void report() const {
    if (hooks_.progress && planned_ > 0)
      hooks_.progress(std::min(1.0, static_cast<double>(done_) / static_cast<double>(planned_)), stage_);
  }

  const RunHooks& hooks_;
  std::uint64_t grains_, interval_;
  std::uint64_t planned_ = 0, done_ = 0, taken_ = 0, stage_end_ = 0;
  std::string stage_;
};

/// What happens at which step of a leg.
struct LegPlan {
  StepPlan stepping;
  std::vector<std::uint64_t> rows;       ///< steps after which to measure, rising
  std::vector<std::uint64_t> snapshots;  ///< steps after which to take one, rising
  double progress(const Leg& leg, std::uint64_t step) const {
    return step >= stepping.steps ? 1.0 : leg.progress(static_cast<double>(step) * stepping.dt);
  }
};

/// The share of a leg's strain at which a wanted snapshot lies.
double wanted_progress(const SnapshotRequest& wanted, const Leg& leg, double nu_start) {
  const auto share = [](double x, const double(&ends)[2]) {
    return std::clamp((x - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0);
  };
  if (wanted.nu) return share(std::log(*wanted.nu / nu_start), leg.eps_vol);
  if (wanted.eps_dev) return share(*wanted.eps_dev, leg.eps_dev);
  return 1;
}

LegPlan plan_leg(const Leg& leg, std::size_t index, const Measure& measure, double nu_start,
                 double longest_step) {
  const bool at_rest = leg.mode == Mode::relax;
  const auto rows = at_rest ? std::uint64_t{1} : static_cast<std::uint64_t>(measure.rows);
  LegPlan plan;
  plan.stepping = plan_steps(leg, longest_step, at_rest ? 1 : least_steps_per_row * rows);
  const double steps = static_cast<double>(plan.stepping.steps);
  for (std::uint64_t k = 1; k <= rows; ++k) {
    const double share = leg.time_at(static_cast<double>(k) / static_cast<double>(rows)) / leg.duration;
    const auto step =
        k == rows ? plan.stepping.steps : static_cast<std::uint64_t>(std::lround(share * steps));
    if (step > 0 && (plan.rows.empty() || step > plan.rows.back())) plan.rows.push_back(step);
  }
  for (const SnapshotRequest& wanted : measure.snapshots)
    if (wanted.segment == index) {
      const double share = at_rest ? 1 : leg.time_at(wanted_progress(wanted, leg, nu_start)) / leg.duration;
      const auto step =
          std::min(plan.stepping.steps, static_cast<std::uint64_t>(std::ceil(share * steps * (1 - 1e-12))));
      plan.snapshots.push_back(step);
    }
  std::sort(plan.snapshots.begin(), plan.snapshots.end());
  plan.snapshots.erase(std::unique(plan.snapshots.begin(), plan.snapshots.end()), plan.snapshots.end());
  return plan;
}

/// Throws Error if the box becomes narrower along the path than its largest grain allows.
void check_width(const std::vector<Leg>& legs, Vec3 length, const State& state, const Scene& scene) {
  const double widest = 2 * *std::max_element(state.radius.begin(), state.radius.end()),
               least = widest + 0.02 * scene.material.r_mean;
  for (std::size_t i = 0; i < legs.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      length[c] *= std::exp(-legs[i].strain[c]);
      if (length[c] < least)
        throw Error(scene.file, "path.segments[" + std::to_string(i) + "]",
                    "makes the box " + to_text(length[c]) + " mm wide, too narrow for a grain of diameter " +
                        to_text(widest) + " mm (it would touch its own image); must stay >= " +
                        to_text(least) + " mm: take more grains or less strain");
    }
}

class ElementTest {
 public:
  ElementTest(const Scene& scene, const std::filesystem::path& out_dir, const RunHooks& hooks)
      : scene_(scene), out_dir_(out_dir), start_(first_state(scene)), watch_(hooks, start_.count()) {
    const double r = smallest_of(start_.radius);
    step_ = time_step(scene.material, r, scene.measure.time_step);
    step_gas_ = time_step(scene.material, r, scene.measure.time_step_gas);
    plan();
  }

  RunSummary run();

 private:
  static State first_state(const Scene& scene);
  void plan();
  void prepare();
  void walk(Dynamics& dynamics);
  void walk(Dynamics& dynamics, std::size_t index, RowWriter& rows);
  void take_snapshot(const Dynamics& dynamics, const RowWriter& rows, std::size_t index, double progress);
  std::string stage_name(std::size_t index) const;

  const Scene& scene_;
  std::filesystem::path out_dir_;
  State start_;
  Watch watch_;
  double step_ = 0, step_gas_ = 0;  ///< longest steps on the path and during preparation, us
  StepPlan compression_, relaxation_;
  std::vector<Leg> legs_;
  std::vector<LegPlan> plans_;
  double nu_start_ = 0;
  double path_begin_ = 0;  ///< us
  std::unique_ptr<SnapshotWriter> snapshots_;
  std::unique_ptr<RowWriter> rows_;
};

State ElementTest::first_state(const Scene& scene) {
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation))
    return random_gas(scene.material, *packing);
  const auto& from = std::get<FromSnapshot>(scene.preparation);
  const State state = read_frame(from.file, from.choice);
  scene.check_grains(state);
  return state;
}

void ElementTest::plan() {
  nu_start_ = start_.volume_fraction();
  Vec3 length = start_.box;
  if (const auto* packing = std::get_if<NewPacking>(&scene_.preparation)) {
    nu_start_ = packing->nu;
    const Leg leg = compression_leg(*packing);
    for (double& edge : length) edge *= std::exp(-leg.strain[0]);
    compression_ = plan_steps(leg, step_gas_, 1);
    relaxation_ = plan_steps(relaxation_leg(packing->relax), step_gas_, 1);
    watch_.plan(compression_.steps + relaxation_.steps);
  }
  legs_ = scene_.legs(nu_start_);
  check_width(legs_, length, start_, scene_);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    plans_.push_back(plan_leg(legs_[i], i, scene_.measure, nu_start_, step_));
    watch_.plan(plans_.back().stepping.steps);
  }
}

void ElementTest::prepare() {
  const auto* packing = std::get_if<NewPacking>(&scene_.preparation);
  if (packing == nullptr) return;
  Dynamics dynamics(scene_.material, start_);
  const auto each = [&](std::uint64_t) { return watch_.step(); };
  watch_.enter("compress the gas", compression_.steps);
  follow(dynamics, compression_leg(*packing), compression_, each);
  watch_.leave();
  if (watch_.stopped()) return;
  watch_.enter("relax the packing", relaxation_.steps);
  relax(dynamics, relaxation_leg(packing->relax), relaxation_, each);
  watch_.leave();
  start_ = dynamics.state();
}

std::string ElementTest::stage_name(std::size_t index) const {
  return name_of(legs_[index].mode) + " (" + std::to_string(index + 1) + " of " +
         std::to_string(legs_.size()) + ")";
}

void ElementTest::take_snapshot(const Dynamics& dynamics, const RowWriter& rows, std::size_t index,
                                double progress) {
  if (!snapshots_) snapshots_ = std::make_unique<SnapshotWriter>(out_dir_ / "snapshots.h5", start_.radius);
  const State state = dynamics.state();
  const double nu = state.volume_fraction();
  snapshots_->append(state, {nu, std::log(nu / nu_start_), rows.eps_dev(index, progress), index});
}

void ElementTest::walk(Dynamics& dynamics, std::size_t index, RowWriter& rows) {
  const Leg& leg = legs_[index];
  const LegPlan& plan = plans_[index];
  auto next_row = plan.rows.begin();
  auto next_snapshot = plan.snapshots.begin();
  std::uint64_t last = 0;
  const auto write_row = [&](std::uint64_t step) {
    rows.append(dynamics.measure(), index, plan.progress(leg, step), dynamics.time() - path_begin_);
  };
  const auto observe = [&](std::uint64_t step) {
    last = step;
    if (next_row != plan.rows.end() && *next_row == step) {
      write_row(step);
      ++next_row;
    }
    if (next_snapshot != plan.snapshots.end() && *next_snapshot == step) {
      take_snapshot(dynamics, rows, index, plan.progress(leg, step));
      ++next_snapshot;
    }
    return watch_.step();
  };
  watch_.enter(stage_name(index), plan.stepping.steps);
  if (next_snapshot != plan.snapshots.end() && *next_snapshot == 0) {
    take_snapshot(dynamics, rows, index, 0);
    ++next_snapshot;
  }
  if (leg.mode == Mode::relax)
    relax(dynamics, leg, plan.stepping, observe);
  else
    follow(dynamics, leg, plan.stepping, observe);
  if (watch_.stopped()) return;
  if (next_row != plan.rows.end()) write_row(plan.stepping.steps);  // a relaxation that ended early
  if (next_snapshot != plan.snapshots.end()) take_snapshot(dynamics, rows, index, 1);
  watch_.leave();
}

void ElementTest::walk(Dynamics& dynamics) {
  path_begin_ = dynamics.time();
  rows_ = std::make_unique<RowWriter>(scene_.material, legs_, nu_start_);
  rows_->append(dynamics.measure(), 0, 0, 0);
  for (std::size_t i = 0; i < legs_.size() && !watch_.stopped(); ++i) walk(dynamics, i, *rows_);
}

RunSummary ElementTest::run() {
  const auto begin = Clock::now();
  Provenance provenance = Provenance::begin(scene_);
  write_file(out_dir_ / "scene.json", scene_.to_json(out_dir_).dump(2) + "\n");
  prepare();
  if (!watch_.stopped()) {
    Dynamics dynamics(scene_.material, start_);
    walk(dynamics);
  }
  RunSummary summary;
  summary.stopped = watch_.stopped();
  summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  summary.particle_steps = watch_.particle_steps();
  if (summary.stopped) return summary;
  summary.warnings = rows_->warnings();
  provenance.wall_time_s = summary.wall_s;
  provenance.particle_steps = summary.particle_steps;
  provenance.time_step = step_;
  provenance.warnings = summary.warnings;
  write_file(out_dir_ / "provenance.json", provenance.to_json().dump(2) + "\n");
  rows_->record().write_csv(out_dir_ / "record.csv");
  return summary;
}

void make_directory(const std::filesystem::path& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error) throw Error(dir.string(), "", "cannot be created: " + error.message());
}

void check_directory(const std::filesystem::path& dir) {
  std::error_code ignored;
  if (!std::filesystem::exists(dir, ignored)) return;
  if (!std::filesystem::is_directory(dir, ignored))
    throw Error(dir.string(), "", "must be a directory, but is a file");
  if (!std::filesystem::is_empty(dir, ignored))
    throw Error(dir.string(), "", "must be empty or not exist; nothing in it is overwritten");
}

}  // namespace

RunSummary run_element_test(const Scene& scene, const std::filesystem::path& out_dir, const RunHooks& hooks) {
  check_directory(out_dir);
  ElementTest test(scene, out_dir, hooks);
  make_directory(out_dir);
  return test.run();
}

}  // namespace grainlaw::dem
