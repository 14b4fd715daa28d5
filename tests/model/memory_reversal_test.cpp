// The form with memory at and after reversals of shear: what small cycles do, smoothness, the fabric that is
// held, and jamming again.
#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/model/forms/memory.hpp"
#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

/// m of a point in steady shear at nu after so many cycles of this size, the first against the shear.
double after_small_cycles(double nu, double size, int cycles) {
  MaterialPoint point = point_at(isotropic(nu, 0.6649));
  EXPECT_FALSE(point.walk(0, 1).failed());
  for (int i = 0; i < 2 * cycles; ++i) EXPECT_FALSE(point.walk(0, i % 2 == 0 ? -size : size).failed());
  return point.state().memory;
}

TEST(MemoryReversal, SmallCyclesLeaveItAlone) {
  // As long in all, 0.1. The fabric of Eq. 4.16 sinks as the root of size and length, and m with it.
  for (const double nu : {0.685, 0.711}) {
    const double steady = after_small_cycles(nu, 0.001, 0);
    const double tiny = steady - after_small_cycles(nu, 1e-5, 5000),
                 small = steady - after_small_cycles(nu, 1e-3, 50),
                 large = steady - after_small_cycles(nu, 1e-2, 5);
    EXPECT_LT(tiny, 0.06);
    EXPECT_NEAR(small / tiny, 10, 5);
    EXPECT_GT(large, 0.4);
  }
}

TEST(MemoryReversal, TheStrainsOfEquations5_3And5_13FollowFromOneRate) {
  // exp[-(eps/0.102)^1.37] of first shear.
  const double nu = 0.711;
  MaterialPoint point = point_at(isotropic(nu, 0.6649));
  double first = 0;
  for (int i = 1; i <= 40; ++i) {
    ASSERT_FALSE(point.walk(0, 0.01).failed());
    first = std::max(first, std::abs(1 - point.state().memory - std::exp(-std::pow(0.01 * i / 0.102, 1.37))));
  }
  EXPECT_LT(first, 0.12);
  // After a reversal phi_J comes back for a while, where Eq. 5.13 has it back at once. Half of the most that
  // it has is taken again at 0.130 by the thesis's 5.13, 0.17 (ln 2)^(1/1.37), and at 0.157 +- 0.011 by our
  // own packings', 0.200 (ln 2)^(1/1.52) (docs/memory.md).
  double most = 0, at_most = 0, half = 0;
  for (int i = 1; i <= 400 && half == 0; ++i) {
    ASSERT_FALSE(point.walk(0, -0.001).failed());
    const double taken_back = 1 - point.state().memory;
    if (taken_back > most) {
      most = taken_back;
      at_most = 0.001 * i;
    } else if (taken_back < most / 2) {
      half = 0.001 * i;
    }
  }
  EXPECT_GT(most, 0.5);
  EXPECT_LT(most, 0.9);
  EXPECT_NEAR(at_most, 0.08, 0.02);
  EXPECT_NEAR(half, 0.157, 2 * 0.011);
}

TEST(MemoryReversal, WhatIsRememberedHoldsTheFabric) {
  ParameterSet set = with_memory();
  const auto slope = [&](double strain_before) {  // -dF_dev/d eps_dev at a reversal
    MaterialPoint point(make_law(set, Form::memory), isotropic(0.711, 0.6649), {1e-10, 1e-13});
    EXPECT_FALSE(point.walk(0, strain_before).failed());
    const double before = point.state().F_dev;
    EXPECT_FALSE(point.walk(0, -1e-6).failed());
    return (before - point.state().F_dev) / 1e-6;
  };
  const double free_first = slope(0.01), free_steady = slope(1);
  set.memory->hold.emplace().value = 0.4;
  EXPECT_NEAR(slope(0.01) / free_first, 1, 0.01);  // little is remembered yet
  EXPECT_NEAR(slope(1) / free_steady, 0.6, 0.001);
}

TEST(MemoryReversal, PressureIsSmoothAtAReversal) {
  const Memory law = form();
  MaterialPoint point = point_at(isotropic(0.711, 0.6649));
  ASSERT_FALSE(point.walk(0, 1).failed());
  const double steady = point.state().P, step = 1e-5;
  ASSERT_FALSE(point.walk(0, -step).failed());
  const double first = (point.state().P - steady) / step;
  ASSERT_FALSE(point.walk(0, step - 1e-3).failed());
  const double later = (point.state().P - steady) / 1e-3;
  const double B = law.stiffness(law.curve_of(0.6649, 1.0), 0.711).B;
  EXPECT_LT(std::abs(first), 0.02 * 0.66 * B * saturation(law.laws.F_max, 0.711));  // of A1
  EXPECT_NEAR(later / first, 100, 10);
}

TEST(MemoryReversal, JammingAgainTakesMoreStrainThanJammingFirst) {
  for (const double nu : {0.659, 0.66}) {
    MaterialPoint point = point_at(isotropic(nu, 0.6649));
    ASSERT_FALSE(point.walk(0, 0.4).failed());
    ASSERT_FALSE(point.walk(0, -0.6).failed());
    ASSERT_EQ(point.events().size(), 3U);
    const double first = point.events()[0].eps_dev, lost = 0.4 - point.events()[1].eps_dev,
                 again = 0.4 - point.events()[2].eps_dev;
    EXPECT_LT(lost, 0.03);
    EXPECT_GT(again, 1.25 * first) << nu;
    EXPECT_LT(again, 2 * first) << nu;
  }
}

TEST(MemoryReversal, ReversalInTheMiddleOfShearJamming) {
  MaterialPoint point = point_at(isotropic(0.6610, 0.6649));
  for (int i = 0; i < 200; ++i) {
    ASSERT_FALSE(point.walk(0, (i % 2 == 0 ? 1 : -1) * (0.001 + 0.002 * (i % 50))).failed()) << i;
    ASSERT_GE(point.state().P, 0);
    ASSERT_GE(point.state().memory, 0);
    ASSERT_LE(point.state().memory, 1);
  }
}

}  // namespace
}  // namespace grainlaw::model
