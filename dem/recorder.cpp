#include "grainlaw/dem/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grainlaw/dem/snapshot_resume.hpp"

namespace grainlaw::dem {

Recorder::Recorder(const Scene& scene, std::filesystem::path dir, double nu_start)
    : dir_(std::move(dir)),
      nu_start_(nu_start),
      rows_(scene.material, scene.legs(nu_start), nu_start, scene.measure.observe) {}

Recorder::Recorder(const Scene& scene, std::filesystem::path dir, double nu_start, ArchiveReader& archive)
    : Recorder(scene, std::move(dir), nu_start) {
  keep(*this, archive);
  if (frames_ == 0)
    drop_snapshots(snapshot_file());
  else
    snapshots_ = std::make_unique<SnapshotWriter>(resume_snapshots(snapshot_file(), frames_));
}

void Recorder::begin_path(const Dynamics& dynamics) {
  path_begin_ = dynamics.time();
  rows_.append(dynamics, 0, 0, 0);
}

void Recorder::enter(const Dynamics& dynamics, const Stage& stage, std::uint64_t taken) {
  const auto after = [taken](const Steps& steps) {
    return taken == 0 ? steps.begin() : std::upper_bound(steps.begin(), steps.end(), taken);
  };
  next_row_ = after(stage.rows);
  next_snapshot_ = after(stage.snapshots);
  if (taken > 0 || next_snapshot_ == stage.snapshots.end() || *next_snapshot_ != 0) return;
  take_snapshot(dynamics, stage, 0);
  ++next_snapshot_;
}

void Recorder::after_step(const Dynamics& dynamics, const Stage& stage, std::uint64_t step) {
  if (next_row_ != stage.rows.end() && *next_row_ == step) {
    write_row(dynamics, stage, stage.progress(step));
    ++next_row_;
  }
  if (next_snapshot_ != stage.snapshots.end() && *next_snapshot_ == step) {
    take_snapshot(dynamics, stage, stage.progress(step));
    ++next_snapshot_;
  }
}

void Recorder::leave(const Dynamics& dynamics, const Stage& stage) {
  if (next_row_ != stage.rows.end()) write_row(dynamics, stage, 1);
  if (next_snapshot_ != stage.snapshots.end()) take_snapshot(dynamics, stage, 1);
}

void Recorder::flush() const {
  if (snapshots_) bring_to_disk(snapshot_file());
  if (begun()) record().write_csv(dir_ / rows_file);
}

void Recorder::write_row(const Dynamics& dynamics, const Stage& stage, double progress) {
  rows_.append(dynamics, stage.segment.value(), progress, dynamics.time() - path_begin_);
}

void Recorder::take_snapshot(const Dynamics& dynamics, const Stage& stage, double progress) {
  const State state = dynamics.state();
  if (!snapshots_) snapshots_ = std::make_unique<SnapshotWriter>(snapshot_file(), state.radius);
  const std::size_t segment = stage.segment.value();
  const double nu = state.volume_fraction();
  snapshots_->append(state, {nu, std::log(nu / nu_start_), rows_.eps_dev(segment, progress), segment});
  ++frames_;
}

}  // namespace grainlaw::dem
