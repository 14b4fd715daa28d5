#include "grainlaw/dem/element_test.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "grainlaw/dem/crystal_order.hpp"
#include "grainlaw/dem/drive.hpp"
#include "grainlaw/dem/preparation.hpp"
#include "grainlaw/dem/provenance.hpp"
#include "grainlaw/dem/recorder.hpp"
#include "grainlaw/dem/stage.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::dem {

namespace {

using Clock = std::chrono::steady_clock;

/// A test under way: the grains, the stages they go through, how far they are and what was recorded.
class ElementTest {
 public:
  ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks)
      : ElementTest(scene, std::move(out_dir), hooks, first_state(scene)) {}

  RunSummary run();

 private:
  ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks, const State& start);
  static State first_state(const Scene& scene);
  static double nu_start(const Scene& scene, const State& start);
  std::vector<Stage> feasible_stages(const Scene& scene, const State& start) const;
  void begin_path();
  void walk();
  void write_record(Provenance& provenance, const RunSummary& summary) const;

  const Scene& scene_;
  std::filesystem::path out_dir_;
  double nu_start_;
  LongestSteps longest_;
  std::vector<Stage> stages_;
  Dynamics dynamics_;
  std::size_t stage_ = 0;  ///< the one it is in
  LegState leg_;           ///< how far
  Recorder recorder_;
  Watch watch_;
};

ElementTest::ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks,
                         const State& start)
    : scene_(scene),
      out_dir_(std::move(out_dir)),
      nu_start_(nu_start(scene, start)),
      longest_(scene, *std::min_element(start.radius.begin(), start.radius.end())),
      stages_(feasible_stages(scene, start)),
      dynamics_(scene.material, start),
      recorder_(scene, out_dir_, nu_start_),
      watch_(hooks, start.count()) {
  for (const Stage& stage : stages_) watch_.plan(stage.stepping.steps);
}

State ElementTest::first_state(const Scene& scene) {
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation))
    return random_gas(scene.material, *packing);
  const auto& from = std::get<FromSnapshot>(scene.preparation);
  const State state = read_frame(from.file, from.choice);
  scene.check_grains(state);
  return state;
}

double ElementTest::nu_start(const Scene& scene, const State& start) {
  const auto* packing = std::get_if<NewPacking>(&scene.preparation);
  return packing != nullptr ? packing->nu : start.volume_fraction();
}

std::vector<Stage> ElementTest::feasible_stages(const Scene& scene, const State& start) const {
  std::vector<Stage> stages = plan_stages(scene, nu_start_, longest_);
  check_width(stages, start, scene);
  return stages;
}

/// The path starts from the prepared packing as a test does that reads it from a snapshot.
void ElementTest::begin_path() {
  if (stage_ > 0) dynamics_ = Dynamics(scene_.material, dynamics_.state());
  recorder_.begin_path(dynamics_);
}

/// Takes the stage to its end, or to where the run is told to stop.
void ElementTest::walk() {
  const Stage& stage = stages_[stage_];
  watch_.enter(stage.name, stage.stepping.steps, leg_.step);
  recorder_.enter(dynamics_, stage, leg_.step);
  drive(dynamics_, stage.leg, stage.stepping, leg_, [&](std::uint64_t step) {
    recorder_.after_step(dynamics_, stage, step);
    return watch_.step();
  });
  if (watch_.stopped()) return;
  recorder_.leave(dynamics_, stage);
  watch_.leave();
  ++stage_;
  leg_ = {};
}

RunSummary ElementTest::run() {
  const auto begin = Clock::now();
  Provenance provenance = Provenance::begin(scene_);
  write_file(out_dir_ / "scene.json", scene_.to_json(out_dir_).dump(2) + "\n");
  while (stage_ < stages_.size() && !watch_.stopped()) {
    if (stages_[stage_].segment && !recorder_.begun()) begin_path();
    walk();
  }
  RunSummary summary;
  summary.stopped = stage_ < stages_.size();
  summary.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  summary.particle_steps = watch_.particle_steps();
  if (summary.stopped) return summary;
  summary.warnings = recorder_.warnings();
  if (may_crystallise(scene_.material))
    summary.warnings.push_back(crystal_warning(scene_.material, dynamics_.state()));
  write_record(provenance, summary);
  return summary;
}

void ElementTest::write_record(Provenance& provenance, const RunSummary& summary) const {
  provenance.wall_time_s = summary.wall_s;
  provenance.particle_steps = summary.particle_steps;
  provenance.time_step = longest_.path;
  provenance.warnings = summary.warnings;
  write_file(out_dir_ / "provenance.json", provenance.to_json().dump(2) + "\n");
  recorder_.record().write_csv(out_dir_ / "record.csv");
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
