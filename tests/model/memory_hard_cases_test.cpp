// Hard cases of the form with memory, each in every integrator: CVODE by BDF and by Adams, and the light
// path. docs/model.md has the table of outcomes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "checks.hpp"
#include "grainlaw/model/forms/memory.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr double phi_H = 0.6649, nothing = std::numeric_limits<double>::quiet_NaN();

const Law& law() {
  static const Law made = [] {
    ParameterSet set = thesis();
    set.memory->eps_c.emplace().value = 0.042;
    set.memory->hold.emplace().value = 0.4;
    return make_law(set, Form::memory);
  }();
  return made;
}
const Memory& form() { return std::get<Memory>(law()); }
const OverCompression& over() { return form().laws.memory.over; }
double phi_s() { return form().laws.shear_pressure.nu_c; }

State isotropic(double nu, double phi_J = phi_H, double phi_max = 0.82) {
  State state;
  state.nu = nu;
  state.phi_J = phi_J;
  state.history = {phi_J, phi_max, nu};
  state.P = form().pressure_of(nu, phi_J, 0.0);
  state.jammed = state.P > smallest_pressure;
  if (!state.jammed) state.P = 0;
  return state;
}

enum class Integrator { bdf, adams, light };

class MemoryHardCases : public testing::TestWithParam<Integrator> {
 protected:
  /// Walks the state; says how it went.
  static Status walk(State& state, double eps_vol, double eps_dev) {
    if (GetParam() == Integrator::light) {
      static const LightLaw light(law(), {1e-9, 1e-12});
      return light.update(state, eps_vol, eps_dev);
    }
    MaterialPoint point(law(), state, {1e-9, 1e-12},
                        GetParam() == Integrator::bdf ? Method::bdf : Method::adams);
    const Status status = point.walk(eps_vol, eps_dev);
    state = point.state();
    return status;
  }
  static void expect_walk(State& state, double eps_vol, double eps_dev) {
    const Status status = walk(state, eps_vol, eps_dev);
    ASSERT_FALSE(status.failed()) << status.message;
    ASSERT_TRUE(is_finite(state));
    ASSERT_EQ(state.jammed, state.P > 0);
    ASSERT_GE(state.memory, 0);
    ASSERT_LE(state.memory, 1 + 1e-8);
  }
};

TEST_P(MemoryHardCases, ExactlyAtTheJammingDensity) {
  for (const double nu : {std::nextafter(phi_H, 0.0), phi_H, std::nextafter(phi_H, 1.0)}) {
    State state = isotropic(nu);
    EXPECT_FALSE(state.jammed);
    expect_walk(state, 0, 1e-6);  // m leaves 0 as the cube of strain: too little to jam
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

TEST_P(MemoryHardCases, ShearLeavesZeroStrainByItself) {
  State state = isotropic(0.7);
  ASSERT_EQ(state.memory, 0);
  expect_walk(state, 0, 0.02);
  EXPECT_GT(state.memory, 0.01);
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

/// phi_cr is no number of the law: it is where the reversal's least m brings phi_J to nu. Packings have
/// 0.6629 +- 0.0003 (docs/memory.md).
TEST_P(MemoryHardCases, AtTheCriticalDensityOfReversal) {
  double low = 0.66, high = 0.664;
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
  State state = isotropic(low);  // at it, both outcomes are sound, and the way on is the same
  expect_walk(state, 0, 0.5);
  expect_walk(state, 0, -0.5);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.P, form().pressure_of(low, phi_H, 1.0), 0.02 * state.P);
}

TEST_P(MemoryHardCases, NoCompressionYet) {  // M = 0
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  expect_walk(state, 0, 0.5);  // shear finds nothing to take
  EXPECT_EQ(state.phi_J, over().phi_SJ);
  expect_walk(state, std::log(over().phi_SJ / state.nu), 0);  // 5.5 begins with an infinite slope
  EXPECT_FALSE(state.jammed);
  expect_walk(state, 1e-9, 0);
  EXPECT_GE(state.history.phi_H, over().phi_SJ);
  expect_walk(state, std::log(0.70 / state.nu), 0);
  EXPECT_NEAR(state.history.phi_H, jamming_density_after(over(), state.nu, 1.0), 1e-12);
  EXPECT_TRUE(state.jammed);
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
  double early = 0;
  for (int i = 0; i < 10'000; ++i) {
    expect_walk(state, 0, 0.03);
    expect_walk(state, 0, -0.03);
    if (i == 50) early = state.P;
  }
  EXPECT_NEAR(state.P, early, 1e-5 * early);
}

TEST_P(MemoryHardCases, ReversalInTheFragileRegime) {
  // At 0.6605 a reversal takes the contacts; the next comes before they are back, again and again.
  State state = isotropic(0.6605);
  expect_walk(state, 0, 0.3);
  ASSERT_TRUE(state.jammed);
  expect_walk(state, 0, -0.05);
  ASSERT_FALSE(state.jammed);
  EXPECT_GT(state.memory, 0.2);  // it is not forgotten
  expect_walk(state, 0, 0.02);
  EXPECT_FALSE(state.jammed);
  expect_walk(state, 0, -0.02);
  expect_walk(state, 0, 0.3);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.P, form().pressure_of(0.6605, phi_H, 1.0), 0.05 * state.P);
}

TEST_P(MemoryHardCases, HugeCompressionInOneStep) {
  State state = isotropic(0.64, over().phi_SJ, 0.64);
  expect_walk(state, std::log(0.99 / 0.64), 0);
  EXPECT_TRUE(state.jammed);
  EXPECT_NEAR(state.history.phi_H, jamming_density_after(over(), state.nu, 1.0), 1e-12);
  EXPECT_NEAR(state.P, form().pressure_of(state.nu, state.history.phi_H, 0.0), 1e-9);
  expect_walk(state, 0, 0.4);
  expect_walk(state, std::log(0.64 / 0.99), 0);
  EXPECT_FALSE(state.jammed);
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
    for (double State::*member : {&State::nu, &State::P, &State::sigma_dev, &State::F_dev, &State::memory}) {
      State spoilt = before;
      spoilt.*member = bad;
      EXPECT_TRUE(walk(spoilt, 0.01, 0.01).failed());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, MemoryHardCases,
                         testing::Values(Integrator::bdf, Integrator::adams, Integrator::light),
                         [](const auto& p) {
                           return p.param == Integrator::bdf     ? "Bdf"
                                  : p.param == Integrator::adams ? "Adams"
                                                                 : "Light";
                         });

}  // namespace
}  // namespace grainlaw::model
