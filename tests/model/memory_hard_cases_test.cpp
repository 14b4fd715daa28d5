// Hard cases of the form with memory, each in every integrator: CVODE by BDF and by Adams, and the light
// path. docs/model.md has the table of outcomes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr double alpha = 1.37, eps0 = 0.102, phi_H = 0.6649,
                 nothing = std::numeric_limits<double>::quiet_NaN();

double phi_s() { return form().laws.shear_pressure.nu_c; }
/// P* of steady shear.
double steady_pressure(double nu) { return pressure(form().laws.shear_pressure, nu); }

class MemoryHardCases : public testing::TestWithParam<WalkedBy> {
 protected:
  static Status walk(State& state, double eps_vol, double eps_dev) {
    return walk_by(GetParam(), state, eps_vol, eps_dev);
  }
  static void expect_walk(State& state, double eps_vol, double eps_dev) {
    const Status status = walk(state, eps_vol, eps_dev);
    ASSERT_FALSE(status.failed()) << status.message;
    ASSERT_TRUE(is_finite(state));
    ASSERT_EQ(state.jammed, state.P > 0);
    for (const double part : {state.shear.plus, state.shear.minus, state.shear.packed, memory_in(state)}) {
      ASSERT_GE(part, -1e-8);
      ASSERT_LE(part, 1 + 1e-8);
    }
  }
};

TEST_P(MemoryHardCases, ExactlyAtTheJammingDensity) {
  for (const double nu : {std::nextafter(phi_H, 0.0), phi_H, std::nextafter(phi_H, 1.0)}) {
    State state = isotropic(nu);
    EXPECT_FALSE(state.jammed);
    expect_walk(state, 0, 1e-7);  // by Eq. 5.3 m is 6e-9: too little to jam
    EXPECT_FALSE(state.jammed);
    expect_walk(state, 0, 0.05);
    EXPECT_TRUE(state.jammed);  // any shear worth the name jams what is at phi_J
    State compressed = isotropic(nu);
    expect_walk(compressed, 1e-3, 0);
    EXPECT_TRUE(compressed.jammed);
    expect_walk(compressed, -2e-3, 0);
    EXPECT_FALSE(compressed.jammed);
  }
}

TEST_P(MemoryHardCases, ExactlyAtTheJammingDensityThatShearHasLeft) {
  State state = isotropic(0.68);
  expect_walk(state, 0, 0.1);
  const double phi_J = state.phi_J;
  expect_walk(state, std::log(phi_J / 0.68), 0);
  EXPECT_FALSE(state.jammed);
  EXPECT_NEAR(state.nu, phi_J, 1e-15);
  State sheared = state;
  expect_walk(sheared, 0, 0.1);  // on: phi_J falls below nu
  EXPECT_TRUE(sheared.jammed);
  expect_walk(state, 1e-3, 0);
  EXPECT_TRUE(state.jammed);
}

TEST_P(MemoryHardCases, ShearLeavesZeroStrainByItself) {
  State state = isotropic(0.7);
  ASSERT_EQ(memory_in(state), 0);
  double e = 0;
  for (const double step : {1e-12, 1e-9, 1e-6, 1e-3}) {
    expect_walk(state, 0, step);
    e += step;
    const double a = remembered(state.shear.plus, alpha);
    EXPECT_NEAR(a, std::pow(e / eps0, alpha), 0.01 * a) << e;
    EXPECT_GT(a, 0);
  }
  EXPECT_LT(state.phi_J, phi_H);
}

TEST_P(MemoryHardCases, AtAndBelowTheDensityOfSteadyShearNothingJams) {
  for (const double nu : {0.60, 0.6567, std::nextafter(phi_s(), 0.0), phi_s()}) {
    State state = isotropic(nu);
    for (const double e : {0.1, -0.3, 1.0, -10.0, 1000.0}) {
      expect_walk(state, 0, e);
      EXPECT_FALSE(state.jammed) << nu << " " << e;
      EXPECT_EQ(state.P, 0);
    }
  }
  State above = isotropic(phi_s() + 1e-4);
  expect_walk(above, 0, 10);
  EXPECT_TRUE(above.jammed);
  EXPECT_NEAR(above.P, steady_pressure(above.nu), 1e-8);
}

/// Whether a reversal of steady shear at nu takes the contacts away at any time.
template <class Walk>
bool reversal_unjams(double nu, Walk walk) {
  State state = isotropic(nu);
  walk(state, 0, 0.5);
  EXPECT_TRUE(state.jammed);
  for (int i = 0; i < 40; ++i) {
    walk(state, 0, -0.005);
    if (!state.jammed) return true;
  }
  return false;
}

/// phi_cr is no number of the law: it is where the largest phi_J after a reversal is nu. Packings have 0.6629
/// +- 0.0003 (docs/memory.md), with numbers of their own.
TEST_P(MemoryHardCases, AtTheCriticalDensityOfReversal) {
  double low = 0.66, high = 0.666;
  const auto unjams = [&](double nu) {
    return reversal_unjams(nu, [](State& s, double v, double e) { expect_walk(s, v, e); });
  };
  ASSERT_TRUE(unjams(low));
  ASSERT_FALSE(unjams(high));
  for (int i = 0; i < 24; ++i) {
    const double middle = (low + high) / 2;
    (unjams(middle) ? low : high) = middle;
  }
  EXPECT_NEAR(low, 0.6629, 3 * 0.0003);
  double most = 0;
  State reversed = isotropic(high);
  expect_walk(reversed, 0, 0.5);
  for (int i = 0; i < 400; ++i) {
    expect_walk(reversed, 0, -0.0005);
    most = std::max(most, reversed.phi_J);
  }
  EXPECT_NEAR(most, high, 5e-6);  // contacts have been looked for every 0.005
  State state = isotropic(low);   // at it, both outcomes are sound, and the way on is the same
  expect_walk(state, 0, 0.5);
  expect_walk(state, 0, -1.5);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.P, steady_pressure(low), 0.02 * state.P);
}

TEST_P(MemoryHardCases, NoCompressionYet) {  // M = 0
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  expect_walk(state, std::log(over().phi_SJ / state.nu), 0);  // 5.5 begins with an infinite slope
  EXPECT_FALSE(state.jammed);
  expect_walk(state, 1e-9, 0);
  EXPECT_GE(state.history.phi_H, over().phi_SJ);
  expect_walk(state, std::log(0.70 / state.nu), 0);
  EXPECT_NEAR(state.phi_J, jamming_density_after(over(), state.nu, 1.0), 1e-12);
  EXPECT_TRUE(state.jammed);
}

TEST_P(MemoryHardCases, ShearBeforeAnyCompression) {
  // Steady shear has its own density, above phi_SJ; compression then brings phi_J to that of the isotropic
  // packing that it leaves.
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  expect_walk(state, 0, 2);
  EXPECT_FALSE(state.jammed);
  EXPECT_NEAR(state.phi_J, phi_s(), 1e-8);
  for (int i = 1; i <= 20; ++i) {
    const double before = state.phi_J;
    expect_walk(state, std::log(0.70 / 0.64) / 20, 0);
    EXPECT_EQ(state.jammed, state.nu > state.phi_J);
    EXPECT_GE(state.phi_J, before);
    EXPECT_LE(state.phi_J, std::max(state.history.phi_H, before));
  }
  const double first = jamming_density_after(over(), 0.70, 1.0);
  EXPECT_GT(state.phi_J, (phi_s() + first) / 2);
  EXPECT_LT(state.phi_J, first);
}

TEST_P(MemoryHardCases, CompressionThatEndsBelowTheShearJammingDensity) {
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  for (int i = 0; i < 3; ++i) {
    expect_walk(state, std::log(0.655 / 0.64), 0);
    EXPECT_FALSE(state.jammed);
    expect_walk(state, 0, 0.3);
    EXPECT_FALSE(state.jammed);
    expect_walk(state, std::log(0.64 / 0.655), 0);
    EXPECT_EQ(state.history.phi_H, over().phi_SJ);
  }
}

TEST_P(MemoryHardCases, TenThousandCyclesOfCompression) {
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  const double up = std::log(0.73 / 0.64), limit = jamming_density_limit(over(), 0.73);
  for (int M = 1; M <= 10'000; ++M) {
    const double before = state.history.phi_H;
    expect_walk(state, up, 0);
    expect_walk(state, -up, 0);
    ASSERT_GE(state.history.phi_H, before);
    ASSERT_LE(state.history.phi_H, limit);
    ASSERT_FALSE(state.jammed);
  }
  EXPECT_NEAR(state.history.phi_H, jamming_density_after(over(), 0.73, 1e4), 2e-6);
}

TEST_P(MemoryHardCases, TenThousandCyclesOfShear) {
  State state = isotropic(0.685);
  double early = 0, settled = 0;  // what packs goes on as the inverse of the number of cycles
  for (int i = 1; i <= 10'000; ++i) {
    expect_walk(state, 0, 0.03);
    expect_walk(state, 0, -0.03);
    if (i == 50) early = state.P;
    if (i == 1000) settled = state.P;
  }
  EXPECT_NEAR(state.P, early, 1e-3 * early);
  EXPECT_NEAR(state.P, settled, 5e-5 * settled);
}

TEST_P(MemoryHardCases, ReversalInTheFragileRegime) {
  // At 0.6605 a reversal takes the contacts; the next comes before they are back, again and again.
  State state = isotropic(0.6605);
  expect_walk(state, 0, 0.3);
  ASSERT_TRUE(state.jammed);
  expect_walk(state, 0, -0.05);
  ASSERT_FALSE(state.jammed);
  EXPECT_GT(memory_in(state), 0.2);  // it is not forgotten
  for (int i = 0; i < 5; ++i) {
    expect_walk(state, 0, 0.004);
    EXPECT_FALSE(state.jammed);
    expect_walk(state, 0, -0.004);
    EXPECT_FALSE(state.jammed);
  }
  expect_walk(state, 0, 3);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.P, steady_pressure(0.6605), 1e-6 * state.P + 1e-9);
}

TEST_P(MemoryHardCases, HugeCompressionInOneStep) {
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  expect_walk(state, std::log(0.99 / 0.64), 0);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.phi_J, jamming_density_after(over(), state.nu, 1.0), 1e-12);
  EXPECT_NEAR(state.P, form().pressure_of(state.nu, state.phi_J), 1e-9);
  expect_walk(state, 0, 0.4);
  const double sheared = state.phi_J;
  EXPECT_NEAR(state.P, form().pressure_of(state.nu, sheared), 1e-9);
  expect_walk(state, std::log(0.64 / 0.99), 0);
  EXPECT_FALSE(state.jammed);
  EXPECT_EQ(state.phi_J, sheared);
  State again = state;
  expect_walk(again, std::log(0.99 / 0.64), 0);  // and all of it at once: back towards the isotropic packing
  EXPECT_TRUE(again.jammed);
  EXPECT_LT(std::abs(again.phi_J - again.history.phi_H), std::abs(sheared - state.history.phi_H));
  const State before = state;
  EXPECT_THAT(walk(state, 101, 0).message, HasSubstr("at most"));
  EXPECT_EQ(state.nu, before.nu);
}

TEST_P(MemoryHardCases, WhatIsNoNumberIsRefused) {
  for (const double bad : {nothing, std::numeric_limits<double>::infinity()}) {
    State state = isotropic(0.7);
    const State before = state;
    const auto told = testing::AnyOf(HasSubstr("not a number"), HasSubstr("must be finite"));
    EXPECT_THAT(walk(state, bad, 0).message, told);
    EXPECT_THAT(walk(state, 0, bad).message, told);
    EXPECT_EQ(state.nu, before.nu);
    EXPECT_EQ(state.P, before.P);
    for (double State::*member : {&State::nu, &State::P, &State::sigma_dev, &State::F_dev}) {
      State spoilt = before;
      spoilt.*member = bad;
      EXPECT_TRUE(walk(spoilt, 0.01, 0.01).failed());
    }
    for (double ShearHistory::*member :
         {&ShearHistory::plus, &ShearHistory::minus, &ShearHistory::packed, &ShearHistory::steady}) {
      State spoilt = before;
      spoilt.shear.*member = bad;
      EXPECT_TRUE(walk(spoilt, 0.01, 0.01).failed());
    }
  }
}

/// UNI from 0.64 through jamming to 0.82, to and fro, of packings that have not been compressed, or once and
/// more: at no tolerance does a step become too small, and the error is what was asked.
TEST_P(MemoryHardCases, UniaxialCompressionThroughJammingAtAnyTolerance) {
  const double up = std::log(0.82 / 0.64);
  for (const State& start :
       {isotropic(0.64, over().phi_SJ, 0.64), isotropic(0.64), isotropic(0.64, 0.66, 0.73)}) {
    const auto follow = [&](WalkedBy integrator, Tolerance tolerance) {
      std::vector<State> states{start};
      for (const double part : {1.0, -1.0, 1.0, -0.5, 0.5}) {
        State state = states.back();
        const Status status = walk_by(integrator, state, part * up, part * up, tolerance);
        EXPECT_FALSE(status.failed()) << tolerance.rtol << ": " << status.message;
        states.push_back(state);
      }
      return states;
    };
    const std::vector<State> exact = follow(WalkedBy::adams, {1e-11, 1e-14});
    for (const double rtol : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
      SCOPED_TRACE(rtol);
      const std::vector<State> states = follow(GetParam(), {rtol, 1e-3 * rtol});
      for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_EQ(states[i].jammed, exact[i].jammed) << i;
        EXPECT_NEAR(states[i].P, exact[i].P, 4 * rtol * exact[1].P) << i;
        EXPECT_NEAR(states[i].sigma_dev, exact[i].sigma_dev, 4 * rtol * exact[1].sigma_dev) << i;
        EXPECT_NEAR(states[i].F_dev, exact[i].F_dev, 4 * rtol * exact[1].F_dev) << i;
        EXPECT_NEAR(states[i].phi_J, exact[i].phi_J, 4 * rtol * exact[1].phi_J) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, MemoryHardCases,
                         testing::Values(WalkedBy::bdf, WalkedBy::adams, WalkedBy::light),
                         [](const auto& p) { return name_of(p.param); });

}  // namespace
}  // namespace grainlaw::model
