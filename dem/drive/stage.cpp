#include "grainlaw/dem/drive/stage.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/drive/controlled_drive.hpp"
#include "grainlaw/dem/drive/quasistatic.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double relaxation_share = 0.3;  // of its longest duration that a relaxation takes

constexpr std::uint64_t least_steps_per_row = 2;
constexpr double looks_per_gamma = 32, most_looks = 100'000;

/// The share of a leg's strain at which a wanted snapshot lies.
double wanted_progress(const StateRequest& wanted, const Leg& leg, double nu_start) {
  const auto share = [](double x, const double(&ends)[2]) {
    return std::clamp((x - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0);
  };
  if (wanted.nu) return share(std::log(*wanted.nu / nu_start), leg.eps_vol);
  if (wanted.eps_dev) return leg.fraction_at(*wanted.eps_dev);
  return 1;
}

std::vector<std::uint64_t> row_steps(const Leg& leg, std::uint64_t rows, std::uint64_t steps) {
  std::vector<std::uint64_t> list;
  for (std::uint64_t k = 1; k <= rows; ++k) {
    const double share = leg.time_at(static_cast<double>(k) / static_cast<double>(rows)) / leg.duration;
    const auto step =
        k == rows ? steps : static_cast<std::uint64_t>(std::lround(share * static_cast<double>(steps)));
    if (step > 0 && (list.empty() || step > list.back())) list.push_back(step);
  }
  return list;
}

/// The steps on which requests of a segment fall, rising.
std::vector<std::uint64_t> request_steps(const Leg& leg, std::size_t segment,
                                         const std::vector<StateRequest>& requests, double nu_start,
                                         std::uint64_t steps) {
  std::vector<std::uint64_t> list;
  for (const StateRequest& wanted : requests) {
    if (wanted.segment != segment) continue;
    const double share =
        leg.mode == Mode::relax ? 1 : leg.time_at(wanted_progress(wanted, leg, nu_start)) / leg.duration;
    const double step = std::ceil(share * static_cast<double>(steps) * (1 - 1e-12));
    list.push_back(std::min(steps, static_cast<std::uint64_t>(step)));
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<std::uint64_t> each_once(std::vector<std::uint64_t> rising) {
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());
  return rising;
}

Stage stage_of_path(const Scene& scene, const Leg& leg, std::size_t index, double nu_start,
                    double longest_step) {
  Stage stage;
  stage.leg = leg;
  stage.segment = index;
  stage.name = name_of(leg.mode) + " (" + std::to_string(index + 1) + " of " +
               std::to_string(scene.path.segments.size()) + ")";
  const bool rests = !leg.drives();
  const auto rows = rests ? std::uint64_t{1} : static_cast<std::uint64_t>(scene.measure.rows);
  const std::uint64_t least = leg.controlled() ? look_interval : least_steps_per_row;
  stage.stepping =
      leg.minimises() ? plan_increments(leg, rows) : plan_steps(leg, longest_step, rests ? 1 : least * rows);
  if (leg.controlled()) {
    stage.row_count = rows;
  } else if (leg.duration > 0) {
    stage.rows = row_steps(leg, rows, stage.stepping.steps);
    const std::uint64_t steps = stage.stepping.steps;
    stage.snapshots = each_once(request_steps(leg, index, scene.measure.snapshots, nu_start, steps));
    stage.moduli = request_steps(leg, index, scene.measure.moduli, nu_start, steps);
  }
  return stage;
}

Stage stage_of_preparation(const std::string& name, const Leg& leg, double longest_step) {
  return {name, leg, {}, plan_steps(leg, longest_step, 1), {}, {}, {}, 0};
}

}  // namespace

double Stage::progress(std::uint64_t step) const {
  return step >= stepping.steps ? 1.0 : leg.progress(static_cast<double>(step) * stepping.dt);
}

LongestSteps::LongestSteps(const Scene& scene, double smallest_radius)
    : path(time_step(scene.material, smallest_radius, scene.measure.time_step)),
      preparation(time_step(scene.material, smallest_radius, scene.measure.time_step_gas)) {}

double expected_passes(const std::vector<Leg>& legs, const Measure& measure, double contact_duration) {
  double passes = 0;
  for (const Leg& leg : legs)
    if (leg.minimises())
      passes += static_cast<double>(plan_increments(leg, static_cast<std::uint64_t>(measure.rows)).steps *
                                    Stage::passes_per_increment);
    else
      passes += leg.duration * (leg.mode == Mode::relax ? relaxation_share : 1.0) /
                (measure.time_step * contact_duration);
  return passes;
}

std::vector<Stage> plan_stages(const Scene& scene, double nu_start, const LongestSteps& longest) {
  std::vector<Stage> stages;
  if (const auto* packing = std::get_if<NewPacking>(&scene.preparation)) {
    stages.push_back(
        stage_of_preparation("compress the gas", compression_leg(*packing), longest.preparation));
    stages.push_back(
        stage_of_preparation("relax the packing", relaxation_leg(packing->relax), longest.preparation));
  }
  const std::vector<Leg> legs = scene.legs(nu_start);
  for (std::size_t i = 0; i < legs.size(); ++i)
    stages.push_back(stage_of_path(scene, legs[i], i, nu_start, longest.path));
  return stages;
}

Stage stage_from(const Scene& scene, std::size_t i, const Waypoint& from, const LongestSteps& longest) {
  return stage_of_path(scene, scene.path.leg(i, from), i, from.nu_start, longest.path);
}

namespace {

/// Distance between faces of the box where they are nearest on a leg, mm. A box that glides is narrowest
/// where its edges lean by half of one, and as wide again where they lean by a whole.
double narrowest_along(const Drive& drive, const Leg& leg) {
  double least = Cell(drive.edges(leg.duration)).narrowest();
  if (!leg.gamma) return least;
  const double looks = std::min(std::ceil(looks_per_gamma * (1 + std::abs(*leg.gamma))), most_looks);
  for (double k = 1; k < looks; ++k)
    least = std::min(least, Cell(drive.edges(leg.time_at(k / looks))).narrowest());
  return least;
}

}  // namespace

void check_width(const std::vector<Stage>& stages, const State& start, const Scene& scene) {
  const double widest = 2 * *std::max_element(start.radius.begin(), start.radius.end()),
               least = widest + 0.02 * scene.material.r_mean;
  Mat3 edges = start.box;
  for (const Stage& stage : stages) {
    if (stage.leg.control.by_stress()) return;
    const Drive drive(edges, stage.leg);
    const double narrowest = narrowest_along(drive, stage.leg);
    edges = drive.edges(stage.leg.duration);
    if (stage.segment && narrowest < least)
      throw Error(scene.file, "path.segments[" + std::to_string(*stage.segment) + "]",
                  "makes the box " + to_text(narrowest) + " mm wide, too narrow for a grain of diameter " +
                      to_text(widest) + " mm (it would touch its own image); must stay >= " + to_text(least) +
                      " mm: take more grains or less strain");
  }
}

}  // namespace grainlaw::dem
