// The form with memory at and after reversals of shear: Eq. 5.13, what the direction before loses and what
// comes back denser, small cycles, the fabric that is held, and jamming again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grainlaw/model/forms/memory.hpp"
#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

/// Of the thesis, and of the set.
constexpr double alpha = 1.37, eps0 = 0.102, eps0_R = 0.17, eps_r = 0.145;
constexpr Tolerance tight{1e-11, 1e-14};

double a_of(double u) { return remembered(u, alpha); }

TEST(MemoryReversal, TheNewDirectionFollowsEquation5_13InEveryIntegrator) {
  for (const WalkedBy integrator : integrators)
    for (const double nu : {0.66, 0.685, 0.711, 0.82})
      for (const double q : {1.0, -1.0}) {
        SCOPED_TRACE(std::string(name_of(integrator)) + " at " + to_text(nu));
        State state = isotropic(nu);
        ASSERT_FALSE(walk_by(integrator, state, 0, 3 * q).failed());
        double e = 0;
        for (const double step : {1e-5, 1e-3, 0.01, 0.03, 0.06, 0.1, 0.3}) {
          ASSERT_FALSE(walk_by(integrator, state, 0, -q * step).failed());
          e += step;
          ASSERT_NEAR(state.direction.S_F_I, 2, 1e-6) << "a full reversal";
          const double a = -std::expm1(-std::pow(e / eps0_R, alpha));
          EXPECT_NEAR(a_of(q > 0 ? state.shear.minus : state.shear.plus), a, 1e-6 * a + 1e-12) << e;
        }
      }
}

TEST(MemoryReversal, TheOldDirectionEmptiesByItsClosedForm) {
  // u = u_0 - e/eps_r, and with what smooths its end, d = 0.03, sqrt(u^2 + d^2) - d asinh(d/u) + e/eps_r is
  // constant.
  const double d = 0.03;
  const auto closed = [&](double u) { return std::hypot(u, d) - d * std::asinh(d / u); };
  for (const WalkedBy integrator : integrators)
    for (const double before : {3.0, 0.08}) {
      SCOPED_TRACE(std::string(name_of(integrator)) + ' ' + to_text(before));
      State state = isotropic(0.711);
      ASSERT_FALSE(walk_by(integrator, state, 0, before, tight).failed());
      const double u_0 = state.shear.plus, start = closed(u_0);
      for (int i = 1; i <= 32; ++i) {
        ASSERT_FALSE(walk_by(integrator, state, 0, -0.005, tight).failed());
        const double r = opposition(state.direction.S_F_I), per_strain = (1 - r) / eps0 + r / eps_r;
        EXPECT_GT(r, before > 1 ? 0.999 : 0.95);
        const double u = state.shear.plus, e = 0.005 * i;
        if (u < 1e-6) break;
        EXPECT_NEAR(closed(u), start - e * per_strain, 1e-6) << i;
        const double simple = u_0 - e * per_strain;
        if (simple > 0.2) {
          EXPECT_NEAR(u, simple, 0.01);
        }
      }
      ASSERT_FALSE(walk_by(integrator, state, 0, -0.3, tight).failed());
      EXPECT_LT(state.shear.plus, 1e-6);
      EXPECT_GE(state.shear.plus, -1e-9);
    }
}

TEST(MemoryReversal, BothTogetherAreThePressure) {
  State state = isotropic(0.685);
  ASSERT_FALSE(walk_by(WalkedBy::bdf, state, 0, 3, tight).failed());
  for (int i = 0; i < 30; ++i) {
    ASSERT_FALSE(walk_by(WalkedBy::bdf, state, 0, -0.01, tight).failed());
    const auto& [plus, minus, packed, steady] = state.shear;
    const double m = 1 - (1 - a_of(plus)) * (1 - a_of(minus)), dense = 0.6649 + packed * (0.668 - 0.6649);
    EXPECT_NEAR(state.phi_J, dense + m * (steady - dense), 1e-15);
    EXPECT_NEAR(state.P, form().pressure_of(0.685, state.phi_J), 1e-15);
  }
}

TEST(MemoryReversal, APartOfAReversalHasAPartOfItsStrain) {
  for (const double before : {0.005, 0.02, 0.05}) {
    State state = isotropic(0.711);
    ASSERT_FALSE(walk_by(WalkedBy::light, state, 0, before, tight).failed());
    const double r = state.F_dev / saturation(form().laws.F_max, 0.711);
    ASSERT_GT(r, 0.03);
    ASSERT_LT(r, 0.97);
    ASSERT_FALSE(walk_by(WalkedBy::light, state, 0, -0.04, tight).failed());
    const double strain = 1 / (1 / eps0 + r * (1 / eps0_R - 1 / eps0));
    EXPECT_NEAR(a_of(state.shear.minus), -std::expm1(-std::pow(0.04 / strain, alpha)), 1e-8);
  }
}

TEST(MemoryReversal, WhatOneReversalPacksFollowsItsClosedForm) {
  // dg/du = -pack_rate (u - g) from g = 0 at u = 1: g = u + 1/2 - 3/2 exp(2 (u - 1)), to u = g = 1 - ln(3)/2.
  for (const WalkedBy integrator : integrators) {
    State state = isotropic(0.711);
    ASSERT_FALSE(walk_by(integrator, state, 0, 3, tight).failed());
    for (int i = 0; i < 60; ++i) {
      ASSERT_FALSE(walk_by(integrator, state, 0, -0.005, tight).failed());
      const double u = std::max(state.shear.plus, 1 - std::log(3) / 2);
      EXPECT_NEAR(state.shear.packed, u + 0.5 - 1.5 * std::exp(2 * (u - 1)), 1e-6)
          << name_of(integrator) << i;
    }
    EXPECT_NEAR(state.shear.packed, 1 - std::log(3) / 2, 1e-6);
  }
}

/// After so many cycles of this size from isotropy: the state, and the largest u in the later half of them.
std::pair<State, double> after_cycles(double size, int cycles) {
  State state = isotropic(0.70, 0.662);
  double most = 0;
  for (int i = 0; i < 2 * cycles; ++i) {
    EXPECT_FALSE(walk_by(WalkedBy::light, state, 0, i % 2 == 0 ? size : -size).failed());
    if (i >= cycles) most = std::max({most, state.shear.plus, state.shear.minus});
  }
  return {state, most};
}

TEST(MemoryReversal, ShearToAndFroPacks) {
  double before = 0.662;
  for (const int cycles : {1, 3, 10, 50}) {
    const double dense = form().packed_density(after_cycles(0.08, cycles).first);
    EXPECT_GT(dense, before) << cycles;
    EXPECT_LT(dense, 0.668);
    before = dense;
  }
  const auto [large, most_large] = after_cycles(0.08, 50);
  EXPECT_NEAR(large.shear.packed, most_large, 0.05) << "as far as u allows";
  const auto [small, most_small] = after_cycles(0.005, 50);
  EXPECT_GT(small.shear.packed, 0);
  EXPECT_LT(small.shear.packed, most_small);
  EXPECT_LT(small.shear.packed, large.shear.packed - 0.1);
}

TEST(MemoryReversal, OneDirectionPacksNothing) {
  State state = isotropic(0.70, 0.662);
  for (int i = 0; i < 10; ++i)
    ASSERT_FALSE(walk_by(WalkedBy::light, state, i % 2 ? 0.01 : -0.01, 0.1).failed());
  EXPECT_EQ(state.shear.packed, 0);
}

/// m of a point in steady shear at nu after so many cycles of this size, the first against the shear.
double after_small_cycles(double nu, double size, int cycles) {
  MaterialPoint point = point_at(isotropic(nu));
  EXPECT_FALSE(point.walk(0, 1).failed());
  for (int i = 0; i < 2 * cycles; ++i) EXPECT_FALSE(point.walk(0, i % 2 == 0 ? -size : size).failed());
  return memory_in(point.state());
}

TEST(MemoryReversal, OfSmallCyclesTheirLengthCounts) {
  // As long in all, 0.1: one direction empties and fills, the other fills and hardly empties.
  for (const double nu : {0.685, 0.711}) {
    const double tiny = after_small_cycles(nu, 1e-5, 5000), small = after_small_cycles(nu, 1e-3, 50),
                 large = after_small_cycles(nu, 1e-2, 5);
    EXPECT_NEAR(tiny, small, 0.02);
    EXPECT_NEAR(small, large, 0.1);
    EXPECT_GT(tiny, 0.6);
    EXPECT_LT(tiny, 0.8);
  }
}

TEST(MemoryReversal, WhatOpposesHoldsTheFabric) {
  ParameterSet set = thesis_with_memory();
  const auto slope = [&](double strain_before) {  // -dF_dev/d eps_dev at a reversal
    MaterialPoint point(make_law(set, Form::memory), isotropic(0.711), {1e-10, 1e-13});
    EXPECT_FALSE(point.walk(0, strain_before).failed());
    const double before = point.state().F_dev;
    EXPECT_FALSE(point.walk(0, -1e-6).failed());
    return (before - point.state().F_dev) / 1e-6;
  };
  const double part = slope(0.02), steady = slope(1);
  State state = isotropic(0.711);
  ASSERT_FALSE(walk_by(WalkedBy::bdf, state, 0, 0.02).failed());
  const double r = state.F_dev / saturation(form().laws.F_max, 0.711);
  set.memory->hold->value = 0;
  EXPECT_NEAR(part / slope(0.02), 1 - 0.3 * r, 1e-4);
  EXPECT_NEAR(steady / slope(1), 0.7, 1e-4);
}

TEST(MemoryReversal, PressureGoesOnWithTheSlopeOfWhatEmpties) {
  MaterialPoint point = point_at(isotropic(0.711), {1e-12, 1e-15});
  ASSERT_FALSE(point.walk(0, 3).failed());
  const State steady = point.state();
  for (const double step : {1e-7, 1e-6, 1e-5}) {
    MaterialPoint reversed = point_at(steady, {1e-12, 1e-15});
    ASSERT_FALSE(reversed.walk(0, -step).failed());
    // da = alpha u^(alpha - 1) du, du = -de/eps_r but for its smooth end, at u = 1. What the new direction
    // has by then is of higher order.
    const double lost = alpha * emptying_rate(1.0) / eps_r * step;
    EXPECT_NEAR(1 - a_of(reversed.state().shear.plus), lost, 1e-3 * lost);
    EXPECT_NEAR(reversed.state().phi_J - steady.phi_J, lost * (0.6649 - steady.phi_J), 0.01 * lost * 0.005);
  }
}

TEST(MemoryReversal, JammingAgainTakesMoreStrainThanJammingFirst) {
  for (const double nu : {0.6595, 0.6605}) {
    MaterialPoint point = point_at(isotropic(nu));
    ASSERT_FALSE(point.walk(0, 0.4).failed());
    ASSERT_FALSE(point.walk(0, -0.6).failed());
    ASSERT_EQ(point.events().size(), 3U);
    const double first = point.events()[0].eps_dev, lost = 0.4 - point.events()[1].eps_dev,
                 again = 0.4 - point.events()[2].eps_dev;
    EXPECT_LT(lost, 0.04);
    EXPECT_GT(again, 1.25 * first) << nu;
    EXPECT_LT(again, 2 * first) << nu;
  }
}

TEST(MemoryReversal, ReversalInTheMiddleOfShearJamming) {
  MaterialPoint point = point_at(isotropic(0.6610));
  for (int i = 0; i < 200; ++i) {
    ASSERT_FALSE(point.walk(0, (i % 2 == 0 ? 1 : -1) * (0.001 + 0.002 * (i % 50))).failed()) << i;
    ASSERT_GE(point.state().P, 0);
    ASSERT_GE(memory_in(point.state()), 0);
    ASSERT_LE(memory_in(point.state()), 1);
    ASSERT_LE(point.state().phi_J, 0.668);
    ASSERT_GE(point.state().phi_J, form().laws.shear_pressure.nu_c);
  }
}

}  // namespace
}  // namespace grainlaw::model
