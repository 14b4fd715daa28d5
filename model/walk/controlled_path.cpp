#include "grainlaw/model/walk/controlled_path.hpp"

#include <cmath>
#include <utility>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/walk/controlled.hpp"
#include "grainlaw/model/walk/path_control.hpp"

namespace grainlaw::model {

namespace {

/// A mix of strains and stresses, whose axis its strains alone do not show.
bool is_mix(const Leg& leg) {
  return leg.mode == Mode::control && (leg.control.axis_by_stress() || leg.control.shear_by_stress());
}

/// The axis that stress and fabric have along the whole path, if any segment says it. Throws Error where two
/// say different ones.
std::optional<StrainTensor> axis_of(const Path& path, const std::vector<Leg>& legs) {
  const Leg* first = nullptr;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (!legs[i].axis || is_mix(legs[i])) continue;
    if (first == nullptr) first = &legs[i];
    if (!coaxial(*legs[i].axis, *first->axis))
      throw Error(path.file, path.segments[i].key,
                  "mode " + name_of(legs[i].mode) + " is not coaxial with " + name_of(first->mode) +
                      " before it: the law carries stress and fabric along one direction of shear only");
  }
  return first != nullptr ? first->axis : std::nullopt;
}

class PathWalk {
 public:
  PathWalk(MaterialPoint& point, Tolerance tolerance, const Path& path, int rows,
           const std::function<void(std::size_t, const State&)>& visit)
      : point_(point),
        controlled_(point, tolerance),
        path_(path),
        visit_(visit),
        nu_start_(point.state().nu),
        nominal_(path.nominal_legs(nu_start_, false)),
        sign_(nominal_),
        axis_(axis_of(path, nominal_)) {
    for (int row = 1; row <= rows; ++row) fractions_.push_back(static_cast<double>(row) / rows);
    for (std::size_t i = 0; i < path.segments.size(); ++i)
      if (path.segments[i].by_stress())
        controls_.emplace_back(std::in_place, path, i, axis(i));
      else
        controls_.emplace_back();
  }

  WalkedPath run() {
    for (std::size_t i = 0; i < path_.segments.size() && !ends(walked_.status); ++i) {
      const State begin = point_.state();
      walked_.status = walk(i);
      if (ends(walked_.status))
        walked_.status.message = path_.segments[i].key + ": " + walked_.status.message;
      note_leg(i, begin);
    }
    return std::move(walked_);
  }

 private:
  static bool ends(const Status& status) { return status.failed() || status.code == Status::Code::limit; }
  const StrainTensor& axis(std::size_t i) const { return axis_ ? *axis_ : sign_.axis(i); }
  MaterialPoint::Visit visits(std::size_t i) const {
    return [this, i](std::size_t, const State& state) { visit_(i, state); };
  }
  void warn(std::size_t i, const std::string& text) {
    walked_.warnings.push_back(path_.segments[i].key + ": " + text);
  }

  void note_leg(std::size_t i, const State& begin) {
    Leg leg = nominal_[i];
    const State& end = point_.state();
    leg.eps_vol[0] = begin.eps_vol;
    leg.eps_vol[1] = end.eps_vol;
    leg.eps_dev[0] = begin.eps_dev;
    leg.eps_dev[1] = end.eps_dev;
    walked_.legs.push_back(std::move(leg));
    walked_.P_at_ends.push_back(end.P);
  }

  Status walk(std::size_t i) {
    const Segment& segment = path_.segments[i];
    if (segment.mode == Mode::relax) {
      point_.relax();
      visit_(i, point_.state());
      return {};
    }
    return controls_[i] ? walk_controls(i, *controls_[i]) : walk_strain(i);
  }

  /// A segment of known strain, from where the path stands.
  Status walk_strain(std::size_t i) {
    const State& state = point_.state();
    Waypoint at(nu_start_);
    at.nu = state.nu;
    at.eps_vol = state.eps_vol;
    at.eps_dev = state.eps_dev;
    at.axis = axis(i);
    const Leg leg = path_.leg(i, at, false);  // a target that is there already is no mistake now
    if (const double nu = nu_start_ * std::exp(leg.eps_vol[1]); !(nu > 0 && nu < 1))
      return {Status::Code::failed,
              "takes the volume fraction to " + to_text(nu) + "; it must stay > 0 and < 1"};
    const double eps_vol = leg.eps_vol[1] - leg.eps_vol[0], eps_dev = leg.eps_dev[1] - leg.eps_dev[0];
    if (!path_.segments[i].stop) return point_.walk(eps_vol, eps_dev, fractions_, visits(i));
    return walk_to_end(i, {Prescribed::strain("eps_vol", 1, 0).from(state, &leg.eps_vol[1]),
                           Prescribed::strain("eps_dev", 0, 1).from(state, &leg.eps_dev[1])});
  }

  Status walk_controls(std::size_t i, const PathControl& control) {
    const State begin = point_.state();
    if (!control.remark().empty()) warn(i, control.remark());
    if (const auto approach = control.approach(begin)) {
      const auto ended = controlled_.walk(*approach, stop_of(i), {}, {});
      if (ended.stopped || ends(ended.status)) return end_early(i, ended);
      if (control.passed_by_approach(point_.state(), begin)) {
        warn(i, "the way to its stress used up its strain: it ends there");
        visit_(i, point_.state());
        return {};
      }
    }
    return walk_to_end(i, control.controls(point_.state(), begin));
  }

  std::optional<StopCondition> stop_of(std::size_t i) const {
    const auto& stop = path_.segments[i].stop;
    if (!stop) return std::nullopt;
    return StopCondition{stop->column, stop->above, stop->value};
  }

  Status walk_to_end(std::size_t i, const PathControl::Controls& controls) {
    const auto stop = stop_of(i);
    const auto ended = controlled_.walk(controls, stop, fractions_, visits(i));
    if (ended.stopped || ends(ended.status)) return end_early(i, ended);
    if (stop)
      warn(i, "does not stop before its end: " + stop->column + " stays " +
                  (stop->above ? "below " : "above ") + shown(stop->value));
    return ended.status;
  }

  Status end_early(std::size_t i, const Controlled::Ended& ended) {
    if (!ended.status.failed()) visit_(i, point_.state());
    if (ended.stopped && ended.t == 0) warn(i, "stops where it begins: its condition holds there");
    return ended.status;
  }

  MaterialPoint& point_;
  Controlled controlled_;
  const Path& path_;
  const std::function<void(std::size_t, const State&)>& visit_;
  double nu_start_;
  std::vector<Leg> nominal_;
  SignConvention sign_;
  std::optional<StrainTensor> axis_;
  std::vector<double> fractions_;
  std::vector<std::optional<PathControl>> controls_;  // of the segments whose strain is not known
  WalkedPath walked_;
};

}  // namespace

WalkedPath walk_controlled(MaterialPoint& point, Tolerance tolerance, const Path& path, int rows,
                           const std::function<void(std::size_t, const State&)>& visit) {
  return PathWalk(point, tolerance, path, rows, visit).run();
}

}  // namespace grainlaw::model
