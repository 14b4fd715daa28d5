#include "grainlaw/dem/run/element_test.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "grainlaw/dem/drive/controlled_drive.hpp"
#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/packing/crystal_order.hpp"
#include "grainlaw/dem/record/checkpoint.hpp"
#include "grainlaw/dem/record/recorder.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/dem/scene/provenance.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw::dem {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// How far a test is, and where it began.
struct Place {
  double nu_start = 0;    ///< volume fraction at the start of the path
  std::size_t stage = 0;  ///< the one it is in
  LegState leg;           ///< how far on it
  std::string started = utc_now();
  double wall_s = 0;  ///< until the last checkpoint

  static Place at_the_beginning(double nu_start) {
    Place place;
    place.nu_start = nu_start;
    return place;
  }
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.nu_start, self.stage, self.leg, self.started, self.wall_s);
  }
};

/// A test under way: the grains, the stages they go through, how far they are and what was recorded.
class ElementTest {
 public:
  ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks)
      : ElementTest(scene, std::move(out_dir), hooks, first_state(scene)) {}
  /// Goes on from a checkpoint.
  ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks,
              ArchiveReader archive);

  RunSummary run();

 private:
  ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks, const State& start);
  static State first_state(const Scene& scene);
  static double nu_start(const Scene& scene, const State& start);
  void begin_path();
  void plan_again();
  void walk();
  void leave_leg();
  void cut_short(const std::string& why);
  Error with_rows_kept(const Error& error) const;
  double wall_s() const { return place_.wall_s + seconds_since(begin_); }
  void write_checkpoint() const;
  void write_record(const RunSummary& summary) const;

  const Scene& scene_;
  std::filesystem::path out_dir_;
  Clock::time_point begin_ = Clock::now();
  Place place_;
  Dynamics dynamics_;
  LongestSteps longest_;
  std::vector<Stage> stages_;
  Recorder recorder_;
  Watch watch_;
  std::string cut_short_;  ///< why it ended early, if it did
};

ElementTest::ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks,
                         const State& start)
    : scene_(scene),
      out_dir_(std::move(out_dir)),
      place_(Place::at_the_beginning(nu_start(scene, start))),
      dynamics_(scene.material, start, hooks.threads),
      longest_(scene, dynamics_.grains().smallest_radius()),
      stages_(plan_stages(scene, place_.nu_start, longest_)),
      recorder_(scene, out_dir_, place_.nu_start),
      watch_(hooks, start.count()) {
  check_width(stages_, start, scene);
  for (const Stage& stage : stages_) watch_.plan(stage.passes());
}

ElementTest::ElementTest(const Scene& scene, std::filesystem::path out_dir, const RunHooks& hooks,
                         ArchiveReader archive)
    : scene_(scene),
      out_dir_(std::move(out_dir)),
      place_(archive.take<Place>()),
      dynamics_(scene.material, archive, hooks.threads),
      longest_(scene, dynamics_.grains().smallest_radius()),
      stages_(plan_stages(scene, place_.nu_start, longest_)),
      recorder_(scene, out_dir_, place_.nu_start, archive),
      watch_(hooks, dynamics_.count()) {
  archive(watch_);
  archive.finish();
  for (const Stage& stage : stages_) watch_.plan(stage.passes());
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

/// The path starts from the prepared packing as a test does that reads it from a snapshot.
void ElementTest::begin_path() {
  if (place_.stage > 0) dynamics_.begin_anew(dynamics_.state());
  recorder_.begin_path(dynamics_);
}

/// Plans the stage anew where the strain before it was not known in advance.
void ElementTest::plan_again() {
  Stage& stage = stages_[place_.stage];
  const double third = place_.leg.eps_vol / 3;
  Waypoint from(place_.nu_start);
  from.move({third, third, third}, {});
  from.eps_dev = place_.leg.eps_dev;
  from.gamma = place_.leg.gamma;
  if (place_.leg.axis != StrainTensor{}) from.axis = place_.leg.axis;
  stage = stage_from(scene_, *stage.segment, from, longest_);
  if (place_.leg.step == 0) check_width({stage}, dynamics_.state(), scene_);
}

/// Takes the stage to its end, or to where the run is told to stop.
void ElementTest::walk() {
  const std::uint64_t announced = stages_[place_.stage].passes();
  if (stages_[place_.stage].segment && scene_.path.by_stress()) {
    try {
      plan_again();
    } catch (const Error& error) {
      if (place_.leg.step > 0) throw;
      cut_short_ = std::string(error.what()) + "; the test ends there";  // where the servo has led
      place_.stage = stages_.size();
      return;
    }
  }
  const Stage& stage = stages_[place_.stage];
  watch_.enter(stage.name, announced, place_.leg.step * stage.passes_per_step());
  recorder_.enter(dynamics_, stage, place_.leg);
  place_.leg.entered = true;
  try {
    const auto after_step = [&](std::uint64_t) {
      recorder_.after_step(dynamics_, stage, place_.leg);
      if (!watch_.step(stage.passes_per_step(), place_.leg.passes)) return false;
      if (watch_.checkpoint_due()) write_checkpoint();
      return true;
    };
    drive(dynamics_, stage.leg, stage.stepping, place_.leg, after_step, watch_.stop());
  } catch (const Error& error) {
    if (error.unwritable() || !stage.segment) throw;
    if (!stage.leg.minimises()) throw with_rows_kept(error);
    return cut_short(error.what());
  }
  if (watch_.stopped()) return;
  watch_.leave();
  if (place_.leg.control.lost) return cut_short(why_lost(scene_.material, stage.leg, place_.leg));
  recorder_.leave(dynamics_, stage, place_.leg);
  leave_leg();
}

/// On to the next stage, whose leg begins with the strain that this one ended with.
void ElementTest::leave_leg() {
  const Leg& leg = stages_[place_.stage].leg;
  LegState next;
  next.eps_vol = leg.eps_vol[1];
  next.eps_dev = leg.eps_dev[1];
  next.axis = leg.axis.value_or(place_.leg.axis);
  const bool sheared = leg.axis || leg.control.by_stress();
  next.gamma = leg.gamma ? leg.gamma_before + *leg.gamma : sheared ? 0 : place_.leg.gamma;
  if (leg.controlled()) {
    const StrainTensor strain = leg_strain(dynamics_, place_.leg);
    next.eps_vol = leg.eps_vol[0] + strain[0] + strain[1] + strain[2];
    next.eps_dev = leg_eps_dev(dynamics_, leg, place_.leg);
  }
  if (!stages_[place_.stage].segment) next.eps_vol = 0;  // the path begins after the preparation
  ++place_.stage;
  place_.leg = next;
}

/// Ends the test on a leg that cannot go on.
void ElementTest::cut_short(const std::string& why) {
  const Stage& stage = stages_[place_.stage];
  const Error error(scene_.file, scene_.path.segments.at(*stage.segment).key, why);
  cut_short_ = std::string(error.what()) + "; the test ends there";
  place_.stage = stages_.size();
}

/// Of a motion that cannot go on, whose last rows may be no result: it is said where that was, and where they
/// are.
Error ElementTest::with_rows_kept(const Error& error) const {
  recorder_.flush();
  return {
      scene_.file, scene_.path.segments.at(*stages_[place_.stage].segment).key,
      std::string(error.what()) + "; rows until then are in " + (out_dir_ / Recorder::rows_file).string()};
}

void ElementTest::write_checkpoint() const {
  recorder_.flush();
  Place place = place_;
  place.wall_s = wall_s();
  dem::write_checkpoint(out_dir_, scene_,
                        [&](ArchiveWriter& archive) { archive(place, dynamics_, recorder_, watch_); });
}

RunSummary ElementTest::run() {
  remove_half_written(out_dir_);
  write_file(out_dir_ / "scene.json", scene_.to_json(out_dir_).dump(2) + "\n");
  while (place_.stage < stages_.size() && !watch_.stopped()) {
    if (stages_[place_.stage].segment && !recorder_.begun()) begin_path();
    walk();
  }
  RunSummary summary;
  summary.stopped = place_.stage < stages_.size();
  if (summary.stopped) write_checkpoint();
  summary.wall_s = wall_s();
  summary.particle_steps = watch_.particle_steps();
  if (summary.stopped) return summary;
  summary.cut_short = cut_short_;
  summary.warnings = recorder_.warnings();
  if (!cut_short_.empty()) summary.warnings.push_back(cut_short_);
  if (may_crystallise(scene_.material))
    summary.warnings.push_back(crystal_warning(scene_.material, dynamics_.state()));
  write_record(summary);
  return summary;
}

void ElementTest::write_record(const RunSummary& summary) const {
  Provenance provenance = Provenance::begin(scene_);
  provenance.started = place_.started;
  provenance.wall_time_s = summary.wall_s;
  provenance.particle_steps = summary.particle_steps;
  provenance.time_step = longest_.path;
  provenance.warnings = summary.warnings;
  provenance.cut_short = summary.cut_short;
  provenance.rows = recorder_.record().rows();
  write_file(out_dir_ / "provenance.json", provenance.to_json().dump(2) + "\n");
  for (const auto& table : recorder_.tables()) table.rows.write_csv(out_dir_ / table.file);
  if (recorder_.moduli().rows() > 0) recorder_.moduli().write_csv(out_dir_ / ModuliWriter::file);
  recorder_.record().write_csv(out_dir_ / "record.csv");
  std::filesystem::remove(out_dir_ / Recorder::rows_file);
  remove_checkpoints(out_dir_);
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

bool has_whole_record(const std::filesystem::path& dir) {
  return !has_checkpoint(dir) && std::filesystem::exists(dir / "record.csv");
}

RunSummary run_element_test(const Scene& scene, const std::filesystem::path& out_dir, const RunHooks& hooks) {
  if (has_checkpoint(out_dir))
    return ElementTest(scene, out_dir, hooks, read_checkpoint(out_dir, scene)).run();
  check_directory(out_dir);
  ElementTest test(scene, out_dir, hooks);
  make_directory(out_dir);
  return test.run();
}

}  // namespace grainlaw::dem
