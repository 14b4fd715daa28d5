#include "grainlaw/dem/drive/stage.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "grainlaw/dem/drive/controlled_drive.hpp"
#include "grainlaw/dem/drive/quasistatic.hpp"
#include "grainlaw/dem/packing/least_width.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

namespace {

constexpr double relaxation_share = 0.3;  // of its longest duration that a relaxation takes

constexpr std::uint64_t least_steps_per_row = 2;
constexpr double coarse_look = 1.0 / 32, fine_look = 1e-6;  // strain between looks at the width of a box
constexpr double largest_skew = 67'108'864;                 // 2^26: half of the bits of a number

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

StepPlan planned(const Scene& scene, const std::string& key, const std::function<StepPlan()>& plan) {
  try {
    return plan();
  } catch (const Error& error) {
    throw Error(scene.file, key, std::string(error.what()) + "; give it less time, or longer time steps");
  }
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
  stage.stepping = planned(scene, scene.path.segments[index].key, [&] {
    return leg.minimises() ? plan_increments(leg, rows)
                           : plan_steps(leg, longest_step, rests ? 1 : least * rows);
  });
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

Stage stage_of_preparation(const Scene& scene, const std::string& name, const std::string& key,
                           const Leg& leg, double longest_step) {
  const StepPlan plan = planned(scene, key, [&] { return plan_steps(leg, longest_step, 1); });
  return {name, leg, {}, plan, {}, {}, {}, 0};
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
    stages.push_back(stage_of_preparation(scene, "compress the gas", "preparation.rate",
                                          compression_leg(*packing), longest.preparation));
    stages.push_back(stage_of_preparation(scene, "relax the packing", "preparation.relax.duration",
                                          relaxation_leg(packing->relax), longest.preparation));
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

/// Whether the product of the edges is not too large for the volume between them to be told from 0: their
/// rounding errors are some 1e-16 of that product.
bool holds(const Mat3& edges) {
  double product = 1;
  for (std::size_t c = 0; c < 3; ++c) product *= norm(edges.column(c));
  return determinant(edges) > product / largest_skew;  // false for what is not a number
}

/// The box as far as it is known before anything follows the path: an axis that a stress strains, and that
/// goes with no other, is as wide as can be.
class KnownBox {
 public:
  explicit KnownBox(const Mat3& edges) : edges_(edges) {}

  /// Whether anything is still known on this leg. Then `narrowest_on_leg` may be asked for, and `leave` is
  /// next.
  bool enter(const Leg& leg) {
    if (leg.control.mean || leg.control.shear_by_stress()) return false;
    for (std::size_t c = 0; c < 3; ++c)
      open_[c] = open_[c] || leg.control.by_stress(c) || (leg.to_eps_dev && leg.strain[c] != 0);
    known_ = leg;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!open_[c]) continue;
      if (!is_alone(c)) return false;
      edges_(c, c) = far;
      known_.strain[c] = 0;
    }
    return !(open_[0] && open_[1] && open_[2]);
  }

  /// Distance between faces of the box where they are nearest on the leg, mm, as far as that is less than
  /// `least` or not; none where the numbers of its edges no longer hold the box. A box that glides is
  /// narrowest where its edges lean by half of one, and as wide again where they lean by a whole; one that is
  /// tilted otherwise may be narrow between its ends, too.
  std::optional<double> narrowest_on_leg(double least) const {
    const Drive drive(edges_, known_);
    const Mat3 end = drive.edges(known_.duration);
    if (!holds(edges_) || !holds(end)) return std::nullopt;
    const double first = Cell(edges_).narrowest(), last = Cell(end).narrowest();
    if (!known_.gamma && edges_.is_diagonal() && end.is_diagonal()) return last;
    return narrowest_between(drive, least, {0, first}, {1, last});
  }

  void leave() { edges_ = Drive(edges_, known_).edges(known_.duration); }

 private:
  static constexpr double far = 1e9;  // mm

  struct Look {
    double share, narrowest;  ///< of the leg's strain; mm
  };

  /// No distance between planes of a lattice changes faster than by exp of the strain, so that between two
  /// looks it cannot fall below exp(-strain/2) of the less.
  double narrowest_between(const Drive& drive, double least, const Look& a, const Look& b) const {
    const double strain = (b.share - a.share) * size(), seen = std::min(a.narrowest, b.narrowest);
    const bool fine_enough = strain < (seen < least ? coarse_look : fine_look);
    if (fine_enough || seen * std::exp(-0.5 * strain) >= least) return seen;
    const double share = 0.5 * (a.share + b.share);
    const Look middle{share, Cell(drive.edges(known_.time_at(share))).narrowest()};
    return std::min(narrowest_between(drive, least, a, middle), narrowest_between(drive, least, middle, b));
  }

  /// At least the largest principal strain of the leg.
  double size() const {
    double squares = 0;
    for (std::size_t c = 0; c < 6; ++c) squares += (c < 3 ? 1 : 2) * known_.strain[c] * known_.strain[c];
    return known_.gamma ? std::abs(*known_.gamma) : std::sqrt(squares);
  }

  /// Whether edge c is at a right angle to the others and stays so.
  bool is_alone(std::size_t c) const {
    if (known_.gamma && c != 2) return false;
    const Mat3 strain = matrix_of(known_.strain);
    for (const std::size_t other : {(c + 1) % 3, (c + 2) % 3})
      if (edges_(c, other) != 0 || edges_(other, c) != 0 || strain(c, other) != 0) return false;
    return true;
  }

  Mat3 edges_;
  Leg known_{};
  std::array<bool, 3> open_{};
};

}  // namespace

void check_width(const std::vector<Stage>& stages, const State& start, const Scene& scene) {
  const double largest = *std::max_element(start.radius.begin(), start.radius.end()),
               least = least_width(largest, scene.material.r_mean);
  KnownBox box(start.box);
  std::map<std::string, int> times;  // that a segment has been run, for those that are repeated
  for (const Stage& stage : stages) {
    if (!box.enter(stage.leg)) return;
    const std::string key = stage.segment ? scene.path.segments.at(*stage.segment).key : "preparation";
    const int time = ++times[key];
    const std::optional<double> narrowest = box.narrowest_on_leg(least);
    const auto refuse = [&](const std::string& why) {
      throw Error(scene.file, key, (time > 1 ? "in its repetition " + std::to_string(time) + " " : "") + why);
    };
    if (!narrowest)
      refuse("tilts the box until its edges, which are never flipped, span more than " +
             short_text(largest_skew, 2) +
             " times its volume, so that their numbers no longer hold it; strain less");
    if (stage.segment && *narrowest < least)
      refuse("makes the box " + short_text(*narrowest, 6) + " mm wide, too narrow for a grain of diameter " +
             short_text(2 * largest, 6) + " mm (it would touch its own image); must stay >= " +
             short_text(least, 6) + " mm: take more grains or less strain");
    box.leave();
  }
}

}  // namespace grainlaw::dem
