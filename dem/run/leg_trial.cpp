#include "grainlaw/dem/run/leg_trial.hpp"

#include <cmath>
#include <variant>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double part_seconds = 0.5, warm_up = 0.3, whole_seconds = 1.5;
constexpr std::uint64_t fewest_looks = 20, steps_per_look = 10;

Control kept_at_start(Control control) {
  for (ComponentControl& component : control.component)
    if (auto* target = std::get_if<StressTarget>(&component)) target->stress.reset();
  if (control.mean) control.mean->stress.reset();
  return control;
}

/// The share of the leg that was done.
double done(const Stage& stage, const LegState& state) {
  if (stage.leg.controlled()) return state.control.progress;
  return static_cast<double>(state.step) / static_cast<double>(stage.stepping.steps);
}

double minimiser_bytes(const Material& material, const State& state) {
  const double before = heap_bytes();
  StaticPacking packing(material, state);
  packing.find_contacts();
  return heap_bytes() - before;
}

}  // namespace

std::optional<LegCost> try_leg(const Material& material, const State& grains, const Stage& wanted,
                               Likeness like) {
  if (wanted.leg.controlled() && !wanted.leg.drives()) return std::nullopt;
  Stage stage = wanted;
  if (like == Likeness::density) stage.leg.control = kept_at_start(stage.leg.control);
  Dynamics dynamics(material, grains);
  LegState state;
  const bool by_increments = stage.leg.minimises();
  const double begin = thread_seconds();
  double warm = begin, share_then = 0;  // the way into the leg is not what it is like
  const auto go_on = [&](std::uint64_t step) {
    if (!by_increments && (step % steps_per_look != 0 || step < fewest_looks * steps_per_look)) return true;
    const double now = thread_seconds();
    if (warm == begin && now - begin > warm_up * part_seconds) warm = now, share_then = done(stage, state);
    return now - begin < (like == Likeness::all ? whole_seconds : part_seconds);
  };
  try {
    drive(dynamics, stage.leg, stage.stepping, state, go_on);
  } catch (const Error&) {  // an increment that cannot be brought into balance, grains that do not hold
    return std::nullopt;
  }
  const double end = thread_seconds(), share = done(stage, state);
  if (!(share > share_then) || (like == Likeness::all && share < 1)) return std::nullopt;
  LegCost cost{share < 1 ? (end - warm) / (share - share_then) : end - begin, 0};
  if (by_increments) cost.bytes = minimiser_bytes(material, grains);
  return cost;
}

}  // namespace grainlaw::dem
