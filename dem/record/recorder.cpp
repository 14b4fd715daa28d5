#include "grainlaw/dem/record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grainlaw/dem/files/snapshot_resume.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

/// Deviatoric strain of the path where the box is.
double eps_dev(const Dynamics& dynamics, const Stage& stage, const LegState& state) {
  const Leg& leg = stage.leg;
  if (leg.controlled()) return leg_eps_dev(dynamics, leg, state);
  return leg.eps_dev_at(stage.progress(state.step));
}

}  // namespace

Recorder::Recorder(const Scene& scene, std::filesystem::path dir, double nu_start)
    : dir_(std::move(dir)),
      requests_(scene.measure.snapshots),
      snapshot_requests_(requests_.size()),
      nu_start_(nu_start),
      rows_(scene.material, scene.legs(nu_start), nu_start, scene.measure.standard, scene.measure.observe),
      moduli_(scene.material, scene.legs(nu_start)) {
  requests_.insert(requests_.end(), scene.measure.moduli.begin(), scene.measure.moduli.end());
}

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

void Recorder::enter(const Dynamics& dynamics, const Stage& stage, const LegState& leg) {
  const auto after = [&leg](const Steps& steps) {
    return leg.entered ? std::upper_bound(steps.begin(), steps.end(), leg.step) : steps.begin();
  };
  next_row_ = after(stage.rows);
  next_snapshot_ = after(stage.snapshots);
  next_moduli_ = after(stage.moduli);
  if (leg.entered) return;
  rows_done_ = 0;
  wanted_.clear();
  for (std::uint64_t i = 0; i < requests_.size(); ++i)
    if (stage.leg.controlled() && requests_[i].segment == stage.segment) wanted_.push_back(i);
  take_due(0, dynamics, stage, leg);
}

void Recorder::take_due(std::uint64_t step, const Dynamics& dynamics, const Stage& stage,
                        const LegState& leg) {
  if (next_snapshot_ != stage.snapshots.end() && *next_snapshot_ == step) {
    take_snapshot(dynamics, stage, eps_dev(dynamics, stage, leg));
    ++next_snapshot_;
  }
  for (; next_moduli_ != stage.moduli.end() && *next_moduli_ == step; ++next_moduli_)
    moduli_.append(dynamics.state(), stage.segment.value(), eps_dev(dynamics, stage, leg));
}

void Recorder::take(const Steps& requests, const Dynamics& dynamics, const Stage& stage, double eps_dev) {
  bool snapshot = false;
  for (const std::uint64_t i : requests)
    if (wants_moduli(i))
      moduli_.append(dynamics.state(), stage.segment.value(), eps_dev);
    else
      snapshot = true;
  if (snapshot) take_snapshot(dynamics, stage, eps_dev);
}

void Recorder::after_step(const Dynamics& dynamics, const Stage& stage, const LegState& leg) {
  if (stage.leg.controlled()) return after_controlled_step(dynamics, stage, leg);
  if (next_row_ != stage.rows.end() && *next_row_ == leg.step) {
    write_row(dynamics, stage, eps_dev(dynamics, stage, leg));
    ++next_row_;
  }
  take_due(leg.step, dynamics, stage, leg);
}

/// Rows, snapshots and moduli wait until the stresses are on target, as the driven axes do.
void Recorder::after_controlled_step(const Dynamics& dynamics, const Stage& stage, const LegState& leg) {
  if (!leg.control.looked || !leg.control.on_target) return;
  // Below 0 where a servo on its way to a first target shears the other way.
  const double share = std::clamp(leg.control.progress, 0.0, 1.0);
  const auto due = static_cast<std::uint64_t>(share * static_cast<double>(stage.row_count));
  for (; rows_done_ < std::min(due, stage.row_count); ++rows_done_)
    write_row(dynamics, stage, eps_dev(dynamics, stage, leg));
  const auto reached = std::stable_partition(wanted_.begin(), wanted_.end(), [&](std::uint64_t i) {
    return !passed(requests_[i], dynamics, stage, leg);
  });
  take({reached, wanted_.end()}, dynamics, stage, eps_dev(dynamics, stage, leg));
  wanted_.erase(reached, wanted_.end());
}

/// Whether the wanted value lies between the beginning of the leg and now.
bool Recorder::passed(const StateRequest& wanted, const Dynamics& dynamics, const Stage& stage,
                      const LegState& leg) const {
  const auto between = [](double value, double begin, double now) {
    constexpr double slack = 1e-9;  // the end itself, up to rounding, as where scenes are checked
    return (value - begin) * (now - value) >= 0 || std::abs(now - value) <= slack ||
           std::abs(value - begin) <= slack;
  };
  if (wanted.eps_dev) return between(*wanted.eps_dev, stage.leg.eps_dev[0], eps_dev(dynamics, stage, leg));
  if (!wanted.nu) return false;
  const StrainTensor strain = leg_strain(dynamics, leg);
  const double begin = stage.leg.eps_vol[0];
  return between(std::log(*wanted.nu / nu_start_), begin, begin + strain[0] + strain[1] + strain[2]);
}

void Recorder::leave(const Dynamics& dynamics, const Stage& stage, const LegState& leg) {
  const double strain = stage.leg.controlled() ? eps_dev(dynamics, stage, leg) : stage.leg.eps_dev[1];
  if (next_row_ != stage.rows.end() || rows_done_ < stage.row_count) write_row(dynamics, stage, strain);
  if (next_snapshot_ != stage.snapshots.end()) take_snapshot(dynamics, stage, strain);
  for (; next_moduli_ != stage.moduli.end(); ++next_moduli_)
    moduli_.append(dynamics.state(), stage.segment.value(), strain);
  Steps at_end;
  for (const std::uint64_t i : wanted_)
    (requests_[i].nu || requests_[i].eps_dev ? missed_ : at_end).push_back(i);
  take(at_end, dynamics, stage, strain);
  wanted_.clear();
}

std::vector<std::string> Recorder::warnings() const {
  std::vector<std::string> list = rows_.warnings();
  list.insert(list.end(), moduli_.warnings().begin(), moduli_.warnings().end());
  for (const std::uint64_t i : missed_) {
    const StateRequest& missed = requests_[i];
    list.push_back("segment " + std::to_string(missed.segment) + " never came to " +
                   (missed.nu ? "nu = " + to_text(*missed.nu) : "eps_dev = " + to_text(*missed.eps_dev)) +
                   (wants_moduli(i) ? ", so there are no moduli of it" : ", so there is no snapshot of it"));
  }
  return list;
}

void Recorder::flush() const {
  if (snapshots_) bring_to_disk(snapshot_file());
  if (begun()) record().write_csv(dir_ / rows_file);
}

void Recorder::write_row(const Dynamics& dynamics, const Stage& stage, double eps_dev) {
  rows_.append(dynamics, stage.segment.value(), eps_dev, dynamics.time() - path_begin_);
}

void Recorder::take_snapshot(const Dynamics& dynamics, const Stage& stage, double eps_dev) {
  const State state = dynamics.state();
  if (!snapshots_) snapshots_ = std::make_unique<SnapshotWriter>(snapshot_file(), state.radius);
  const std::size_t segment = stage.segment.value();
  const double nu = state.volume_fraction();
  snapshots_->append(state, {nu, std::log(nu / nu_start_), eps_dev, segment});
  ++frames_;
}

}  // namespace grainlaw::dem
