// Paths of vanishing rate: from one balance to the next.
#include "grainlaw/dem/drive/quasistatic.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Leg d2(double strain, double increment) {
  Leg leg{};
  leg.mode = Mode::d2;
  leg.strain = {-strain, strain, 0};
  leg.duration = 1;
  leg.profile = Profile::quasistatic;
  leg.increment = increment;
  leg.residual = 1e-9;
  return leg;
}

Dynamics balanced(const Material& material) {
  StaticPacking packing(material, test::squeezed(material, 200, 3, 0.75));
  MinimiseOptions options;
  options.residual = 1e-10;
  EXPECT_TRUE(minimise(packing, options).converged());
  return Dynamics(material, packing.state());
}

TEST(Quasistatic, IncrementsAreShortEnoughAndAsManyForEachRow) {
  EXPECT_EQ(plan_increments(d2(0.01, 1e-3), 1).steps, 10u);
  EXPECT_EQ(plan_increments(d2(0.01, 1e-3), 4).steps, 12u);
  EXPECT_EQ(plan_increments(d2(0.01, 1), 7).steps, 7u);
  Leg rest = d2(0, 1e-3);
  rest.mode = Mode::relax;
  EXPECT_EQ(plan_increments(rest, 5).steps, 1u);
}

TEST(Quasistatic, EachStepEndsInBalanceAndTakesNoTime) {
  const Material material;
  Dynamics dynamics = balanced(material);
  const double before = dynamics.time(), volume = dynamics.cell().volume();
  const Leg leg = d2(2e-3, 5e-4);
  LegState state;
  int steps = 0;
  follow_quasistatic(dynamics, leg, plan_increments(leg, 1), state, [&](std::uint64_t) {
    ++steps;
    EXPECT_GT(state.passes, 1u);
    StaticPacking packing(material, dynamics.state());
    packing.find_contacts();
    EXPECT_LE(packing.balance().residual, 1.01e-9);
    EXPECT_EQ(dynamics.energies().kinetic, 0);
    return true;
  });
  EXPECT_EQ(steps, 4);
  EXPECT_EQ(dynamics.time(), before);
  EXPECT_NEAR(dynamics.cell().volume(), volume, 1e-12 * volume);
}

TEST(Quasistatic, WhileNoContactOpensOrClosesItIsASlowFlow) {
  const Material material;
  Dynamics still = balanced(material), flowing = still;
  const Sym6 start = still.static_stress();
  Leg leg = d2(1e-6, 1e-6);
  LegState state;
  follow_quasistatic(still, leg, plan_increments(leg, 1), state, [](std::uint64_t) { return true; });
  leg.residual.reset();
  leg.profile = Profile::cosine;
  leg.duration = 4000;
  const double dt = time_step(material, flowing.grains().smallest_radius(), 0.2);
  drive(flowing, leg, plan_steps(leg, dt, 1));
  const Sym6 a = still.static_stress(), b = flowing.static_stress();
  const double change = (a[1] - a[0]) - (start[1] - start[0]);
  EXPECT_GT(change, 0);
  EXPECT_NEAR((b[1] - b[0]) - (start[1] - start[0]), change, 1e-3 * change);
}

TEST(Quasistatic, AnIncrementThatIsStoppedHasNotBegun) {
  const Material material;
  Dynamics dynamics = balanced(material);
  const State before = dynamics.state();
  const Leg leg = d2(1e-2, 1e-2);
  LegState state;
  std::atomic<bool> stop = true;
  const auto never = [](std::uint64_t) {
    ADD_FAILURE() << "no increment ends";
    return true;
  };
  follow_quasistatic(dynamics, leg, plan_increments(leg, 1), state, never, &stop);
  EXPECT_EQ(state.step, 0u);
  EXPECT_EQ(dynamics.state(), before);
}

TEST(Quasistatic, RoundingInTheWayIsNoError) {
  const Material material;
  Dynamics dynamics = balanced(material);
  Leg leg = d2(1e-3, 1e-3);
  leg.residual = 1e-300;  // out of reach
  LegState state;
  follow_quasistatic(dynamics, leg, plan_increments(leg, 1), state, [](std::uint64_t) { return true; });
  StaticPacking packing(material, dynamics.state());
  packing.find_contacts();
  EXPECT_LT(packing.balance().residual, 1e-10);
}

}  // namespace
}  // namespace grainlaw::dem
