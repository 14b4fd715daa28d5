#include "grainlaw/model/point.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace grainlaw::model {

namespace {

/// A stretch along which contact is lost and found again more often than this is given up.
constexpr int most_phases = 1000;

/// Fraction of the stretch at which its volume fraction is nu; its eps_vol is not 0.
double fraction_at(const Stretch& stretch, double nu) {
  return std::log(nu / stretch.nu_0) / stretch.eps_vol;
}

State moved(State state, const Stretch& stretch, double t) {
  state.nu = stretch.nu(t);
  state.eps_vol += stretch.eps_vol * t;
  state.eps_dev += stretch.eps_dev * t;
  return state;
}

template <class Form>
System system_of(const Form& form, const Stretch& stretch, const Direction& direction) {
  System system;
  system.rate = [&](double t, const double* y, double* dydt) {
    return form.rate(stretch, direction, t, y, dydt);
  };
  system.jacobian = [&](double t, const double* y, double* J) {
    return form.jacobian(stretch, direction, t, y, J);
  };
  if constexpr (std::is_same_v<Form, Coupled>)
    system.event = [](double, const double* y) { return y[0] - smallest_pressure; };
  return system;
}

/// Where an integration got to.
struct Reached {
  Status status;
  double t = 0;
  bool lost_pressure = false;
};

/// Carries `state` along the stretch to `end`, or to where its pressure vanishes. `next_sample` gives the
/// next t to be visited before that (anything beyond `end` if none), `visit` is told of it.
template <class NextSample, class Visit>
Reached integrate(const ReducedClosed& form, std::optional<Integrator>&, State& state, const Stretch& stretch,
                  double end, NextSample next_sample, Visit visit) {
  const State begin = state;
  for (double t = next_sample(); t <= end; t = next_sample()) visit(form.at(begin, stretch, t));
  state = form.at(begin, stretch, end);
  return {{}, end, false};
}

template <class Form, class NextSample, class Visit>
Reached integrate(const Form& form, std::optional<Integrator>& integrator, State& state,
                  const Stretch& stretch, double end, NextSample next_sample, Visit visit) {
  const State begin = state;
  const System system = system_of(form, stretch, begin.direction);
  Variables y = form.variables(begin);
  if (Status status = integrator->start(system, 0, end, y.data()); status.failed()) return {status, 0, false};
  for (bool last = false; !last;) {
    const double t = next_sample();
    last = !(t <= end);
    const auto arrival = integrator->advance(last ? end : t, y.data());
    if (arrival.status.failed()) return {arrival.status, arrival.t, false};
    state = form.state(begin, stretch, arrival.t, y.data());
    if (arrival.event) return {{}, arrival.t, true};
    if (!last) visit(state);
  }
  return {{}, end, false};
}

}  // namespace

struct MaterialPoint::Walk {
  Stretch whole;
  std::span<const double> samples;
  const Visit& visit;
  std::size_t next = 0;  // sample
  double t = 0;          // fraction of the whole that is done

  bool done() const { return t >= 1 && next == samples.size(); }
  Stretch rest() const { return whole.rest(t); }
  /// The next sample as a fraction of rest(); beyond 1 if none is left.
  double next_sample() const {
    if (next == samples.size()) return 2;
    return t < 1 ? std::clamp((samples[next] - t) / (1 - t), 0.0, 1.0) : 1;
  }
  void visited(const State& state) { visit(next++, state); }
  void advance(double fraction_of_rest) { t = fraction_of_rest < 1 ? t + fraction_of_rest * (1 - t) : 1; }
};

MaterialPoint::MaterialPoint(Law law, const State& start, Tolerance tolerance)
    : law_(std::move(law)), state_(start) {
  std::visit(
      [&]<class Form>(const Form&) {
        if constexpr (!std::is_same_v<Form, ReducedClosed>) integrator_.emplace(Form::size, tolerance);
      },
      law_);
}

Status MaterialPoint::walk(double eps_vol, double eps_dev, std::span<const double> samples,
                           const Visit& visit) {
  Walk walk{{state_.nu, eps_vol, eps_dev}, samples, visit};
  if (eps_vol == 0 && eps_dev == 0) {
    while (walk.next < samples.size()) walk.visited(state_);
    return {};
  }
  if (auto reason = objection(law_, walk.whole)) return {Status::Code::failed, *reason};
  const State before = state_;
  const std::size_t events_before = events_.size();
  const double q = walk.whole.q();
  if (state_.jammed && q != 0 && q != state_.direction.q) begin_direction(law_, state_, q);
  Status status;
  for (int phase = 0; !walk.done() && !status.failed(); ++phase) {
    if (phase == most_phases)
      status = {Status::Code::failed, "contact is lost and found again without end"};
    else if (state_.jammed)
      status = walk_jammed(walk);
    else
      walk_unjammed(walk);
  }
  if (status.failed()) {
    status.message += " (nu = " + shown(state_.nu) + ", eps_dev = " + shown(state_.eps_dev) + ")";
    state_ = before;
    events_.resize(events_before);
    return status;
  }
  if (q == 0) state_.direction.q = 0;  // shear after an isotropic stretch begins a new direction
  return {};
}

void MaterialPoint::walk_unjammed(Walk& walk) {
  const Stretch rest = walk.rest();
  double end = 1;
  bool jams = false;
  if (rest.eps_vol > 0) {
    const double t = std::max(0.0, fraction_at(rest, jamming_density(law_, state_)));
    jams = t < 1;
    end = std::min(t, 1.0);
  }
  for (double t = walk.next_sample(); jams ? t < end : t <= 1; t = walk.next_sample())
    walk.visited(moved(state_, rest, t));
  state_ = moved(state_, rest, end);
  walk.advance(end);
  if (!jams) return;
  jam(law_, state_, rest);
  note(true);
}

Status MaterialPoint::walk_jammed(Walk& walk) {
  const Stretch rest = walk.rest();
  double end = 1;
  bool leaves = false;
  if (rest.eps_vol < 0) {
    const double t = fraction_at(rest, unjamming_density(law_));
    leaves = t <= 1;
    end = std::clamp(t, 0.0, 1.0);
  }
  // Where the contacts are lost at `end`, the state there belongs to the unjammed phase that follows.
  const auto next_sample = [&] {
    const double t = walk.next_sample();
    return leaves && t >= end ? 2.0 : t;
  };
  const auto visit = [&](const State& state) { walk.visited(state); };
  const Reached reached = std::visit(
      [&](const auto& form) { return integrate(form, integrator_, state_, rest, end, next_sample, visit); },
      law_);
  walk.advance(reached.t);
  if (reached.status.failed()) return reached.status;
  if (!leaves && !reached.lost_pressure) return {};
  unjam(law_, state_);
  note(false);
  return {};
}

void MaterialPoint::note(bool jammed) {
  events_.push_back({jammed, state_.nu, state_.eps_vol, state_.eps_dev});
}

}  // namespace grainlaw::model
