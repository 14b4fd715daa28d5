#include "grainlaw/dem/drive/drive.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/drive/controlled_drive.hpp"
#include "grainlaw/dem/drive/quasistatic.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::dem {

namespace {
constexpr double most_steps = 9e15;                  // doubles count to 2^53, a little more
constexpr std::uint64_t relax_check_interval = 100;  // steps between two looks at the energies

/// gamma e_x (x) e_y
Mat3 glide(double gamma) { return {{0, gamma, 0}, {0, 0, 0}, {0, 0, 0}}; }
}  // namespace

Drive::Drive(const Mat3& start_edges, const Leg& leg)
    : start_(start_edges), strain_(matrix_of(leg.strain)), principal_{}, leg_(leg) {
  if (!leg.gamma && !strain_.is_diagonal()) principal_ = spectrum(strain_);
}

Mat3 Drive::edges(double t) const {
  const double p = leg_.progress(t);
  if (leg_.gamma) return (Mat3::identity() + glide(p * *leg_.gamma)) * start_;
  const auto stretch = [p](double strain) { return std::exp(-strain * p); };
  if (!strain_.is_diagonal()) return apply(principal_, stretch) * start_;
  return Mat3::diagonal({stretch(strain_(0, 0)), stretch(strain_(1, 1)), stretch(strain_(2, 2))}) * start_;
}

Mat3 Drive::gradient(double t, double dt) const {
  const double from = std::max(t - 0.5 * dt, 0.0), to = std::min(t + 0.5 * dt, leg_.duration);
  const double speed = (leg_.progress(to) - leg_.progress(from)) / (to - from);
  return leg_.gamma ? glide(speed * *leg_.gamma) : -speed * strain_;
}

std::uint64_t whole_steps(double wanted) {
  const double steps = std::ceil(wanted * (1 - 1e-12));
  if (!(steps <= most_steps))
    throw Error("must not take more than " + short_text(most_steps, 2) + " steps, but takes " +
                short_text(steps, 2));
  return static_cast<std::uint64_t>(steps);
}

StepPlan plan_steps(const Leg& leg, double longest_step, std::uint64_t least_steps) {
  StepPlan plan;
  plan.steps = std::max({std::uint64_t{1}, least_steps, whole_steps(leg.duration / longest_step)});
  plan.dt = leg.duration / static_cast<double>(plan.steps);
  return plan;
}

void follow(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
            const AfterStep& after_step) {
  if (state.step == 0) state.start_edges = dynamics.cell().edges();
  const Drive box(state.start_edges, leg);
  if (state.step == 0) dynamics.start_flow(plan.dt, box.gradient(0, plan.dt));
  while (state.step < plan.steps) {
    const std::uint64_t n = ++state.step;
    const double t = n == plan.steps ? leg.duration : static_cast<double>(n) * plan.dt;
    dynamics.step(box.edges(t), box.gradient(t, plan.dt));
    if (!after_step(n)) return;
  }
}

void relax(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
           const AfterStep& after_step) {
  if (state.step == 0) {
    dynamics.start(plan.dt, {});
    state.kinetic_at_start = dynamics.energies().kinetic;
  }
  const auto at_rest = [&] {
    if (state.step == 0 || state.step % relax_check_interval != 0) return false;
    const Energies e = dynamics.energies();
    if (e.kinetic > leg.tolerance * std::max(e.elastic, state.kinetic_at_start)) return false;
    const bool bears = dynamics.measure(Wanted{.coordination = true}).f_NR > 0;
    return e.kinetic <= leg.tolerance * (bears ? e.elastic : state.kinetic_at_start);
  };
  while (state.step < plan.steps && !at_rest()) {
    dynamics.step();
    if (!after_step(++state.step)) return;
  }
}

void drive(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
           const AfterStep& after_step, const std::atomic<bool>* stop) {
  if (leg.controlled())
    follow_controlled(dynamics, leg, plan, state, after_step);
  else if (leg.minimises())
    follow_quasistatic(dynamics, leg, plan, state, after_step, stop);
  else if (leg.mode == Mode::relax)
    relax(dynamics, leg, plan, state, after_step);
  else
    follow(dynamics, leg, plan, state, after_step);
}

void drive(Dynamics& dynamics, const Leg& leg, const StepPlan& plan) {
  LegState state;
  drive(dynamics, leg, plan, state, [](std::uint64_t) { return true; });
}

}  // namespace grainlaw::dem
