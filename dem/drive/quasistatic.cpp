#include "grainlaw/dem/drive/quasistatic.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {
constexpr std::uint64_t most_passes = 2'000'000;  // an increment near jamming takes some ten thousand
}

StepPlan plan_increments(const Leg& leg, std::uint64_t rows) {
  const std::uint64_t needed = whole_steps(largest_component(leg.strain) / leg.increment);
  StepPlan plan;
  if (leg.drives()) plan.steps = std::max(std::uint64_t{1}, (needed + rows - 1) / rows) * rows;
  plan.dt = leg.duration / static_cast<double>(plan.steps);
  return plan;
}

void follow_quasistatic(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
                        const AfterStep& after_step, const std::atomic<bool>* stop) {
  if (state.step == 0) state.start_edges = dynamics.cell().edges();
  const Drive box(state.start_edges, leg);
  MinimiseOptions options;
  options.residual = *leg.residual;
  options.most_passes = most_passes;
  options.stop = stop;
  while (state.step < plan.steps) {
    const std::uint64_t n = state.step + 1;
    // From the state alone, so that a run that goes on from a checkpoint does the same.
    StaticPacking packing(dynamics.material(), dynamics.state());
    if (leg.drives())
      packing.deform(box.edges(n == plan.steps ? leg.duration : static_cast<double>(n) * plan.dt));
    const MinimiseResult result = minimise(packing, options);
    if (result.outcome == Outcome::stopped) return;
    if (result.outcome == Outcome::gave_up)
      throw Error("the energy was not minimised in increment " + std::to_string(n) + " of " +
                  std::to_string(plan.steps) + ": " + result.text() +
                  (result.balance.jammed ? "; residual must be larger" : ""));
    state.step = n;
    state.passes = result.evaluations + result.products;
    dynamics.begin_anew(packing.state());
    if (!after_step(n)) return;
  }
}

}  // namespace grainlaw::dem
