// Compression in the form with memory: cycles by Eqs. 5.1 and 5.5, decompression that leaves phi_J, and what
// compression gives back of what shear has taken.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

TEST(MemoryCompression, CyclesOfOverCompressionFollowEquation5_1) {
  for (const double phi_max : {0.68, 0.73, 0.82}) {
    State start = isotropic(0.64, over().phi_SJ, 0.64);
    MaterialPoint point = point_at(start);
    for (int M = 1; M <= 20; ++M) {
      ASSERT_FALSE(point.walk(std::log(phi_max / 0.64), 0).failed());
      EXPECT_NEAR(point.state().history.phi_H, jamming_density_after(over(), phi_max, M), 1e-6) << M;
      EXPECT_NEAR(point.state().history.phi_max, phi_max, 1e-12);
      ASSERT_FALSE(point.walk(-std::log(phi_max / 0.64), 0).failed());
      EXPECT_FALSE(point.state().jammed);
      EXPECT_NEAR(point.events().back().nu, jamming_density_after(over(), phi_max, M), 1e-6) << M;
    }
  }
}

TEST(MemoryCompression, OverCompressionMayBeCutIntoPieces) {
  const State start = isotropic(0.64, 0.6567, 0.64);
  const double up = std::log(0.73 / 0.64);
  const auto compress = [&](int pieces) {
    MaterialPoint point = point_at(start);
    for (int cycle = 0; cycle < 3; ++cycle)
      for (const double way : {up, -up})
        for (int i = 0; i < pieces; ++i) EXPECT_FALSE(point.walk(way / pieces, 0).failed());
    return point.state().history.phi_H;
  };
  // ln(phi_max/phi_H) is that of the piece: phi_H moves by 1e-3 of itself within a cycle.
  EXPECT_NEAR(compress(1), compress(100), 2e-5);
}

TEST(MemoryCompression, BeyondTheLargestDensityACycleIsAFirstOneAgain) {
  const double five = jamming_density_after(over(), 0.70, 5.0);
  History history{five, 0.70, 0.64};
  history = compressed<double, double>(over(), history, 0.7001);
  EXPECT_GE(history.phi_H, five);  // what cycles have left is not lost
  history = compressed<double, double>(over(), history, 0.82);
  EXPECT_EQ(history.phi_H, jamming_density_after(over(), 0.82, 1.0));
  EXPECT_EQ(history.phi_max, 0.82);
  history = compressed<double, double>(over(), history, 0.7);
  EXPECT_EQ(history.phi_H, jamming_density_after(over(), 0.82, 1.0));
}

/// As one does that starts from a measured pressure: the least compression must not bring it to the mean
/// packing.
TEST(MemoryCompression, APackingThatJamsEarlierThanTheMeanOneGoesOnFromThere) {
  const double below = 0.002, mean = jamming_density_after(over(), 0.70, 1.0);
  const History start{mean - below, 0.70, 0.70};
  const History least = compressed<double, double>(over(), start, 0.70 * (1 + 1e-9));
  EXPECT_NEAR(least.phi_H, start.phi_H, 1e-9);
  const History once = compressed<double, double>(over(), start, 0.82);
  EXPECT_NEAR(once.phi_H, jamming_density_after(over(), 0.82, 1.0) - below, 1e-15);
  History pieces = start;
  for (int i = 1; i <= 12; ++i) pieces = compressed<double, double>(over(), pieces, 0.70 + 0.01 * i);
  EXPECT_NEAR(pieces.phi_H, once.phi_H, 1e-14);
}

TEST(MemoryCompression, CompressionBelowTheShearJammingDensityLeavesNone) {
  History history{over().phi_SJ, 0.64, 0.64};
  history = compressed<double, double>(over(), history, 0.656);
  EXPECT_EQ(history.phi_H, over().phi_SJ);
  history = compressed<double, double>(over(), history, over().phi_SJ);
  EXPECT_EQ(history.phi_H, over().phi_SJ);
  history = compressed<double, double>(over(), history, 0.99);
  EXPECT_EQ(history.phi_H, jamming_density_after(over(), 0.99, 1.0));
}

TEST(MemoryCompression, AFirstCompressionMayBeginAtTheLowestDensity) {
  const History h = compressed<double, double>(over(), {over().phi_SJ, 0.73, 0.64}, 0.73);
  EXPECT_NEAR(h.phi_H, jamming_density_after(over(), 0.73, 1.0), 1e-12);
}

TEST(MemoryCompression, DecompressionLeavesTheJammingDensity) {
  for (const WalkedBy integrator : integrators)
    for (const double e : {0.03, 0.3}) {
      State state = isotropic(0.73);
      ASSERT_FALSE(walk_by(integrator, state, 0, e).failed());
      const double phi_J = state.phi_J;
      for (const double v : {-1e-9, -0.01, -0.05}) {
        ASSERT_FALSE(walk_by(integrator, state, v, 0).failed());
        EXPECT_EQ(state.phi_J, phi_J) << name_of(integrator);
        EXPECT_EQ(state.P, form().pressure_of(state.nu, phi_J));
      }
      State lost = state;  // and there the contacts end
      ASSERT_FALSE(walk_by(integrator, lost, std::log(phi_J / state.nu) + 1e-5, 0).failed());
      EXPECT_TRUE(lost.jammed);
      ASSERT_FALSE(walk_by(integrator, lost, -2e-5, 0).failed());
      EXPECT_FALSE(lost.jammed);
    }
}

TEST(MemoryCompression, OfAnIsotropicPackingAsksNothingOfShear) {
  // m = 0: cycles are those of Eq. 5.1 whatever has been compressed, also in pieces within a cycle.
  for (const WalkedBy integrator : integrators) {
    State state = isotropic(0.64, over().phi_SJ, 0.64);
    for (int M = 1; M <= 3; ++M) {
      for (int i = 0; i < 10; ++i)
        ASSERT_FALSE(walk_by(integrator, state, std::log(0.73 / 0.64) / 10, 0).failed());
      EXPECT_EQ(memory_in(state), 0);
      EXPECT_EQ(state.phi_J, state.history.phi_H);
      EXPECT_NEAR(state.phi_J, jamming_density_after(over(), 0.73, M), 2e-5);
      ASSERT_FALSE(walk_by(integrator, state, -std::log(0.73 / 0.64), 0).failed());
    }
  }
}

/// phi_J along one compression from far shear at nu to 0.82, in so many steps.
std::vector<double> given_back(double nu, int steps) {
  State state = isotropic(nu, jamming_density_after(over(), 0.82, 1.0), 0.82);
  EXPECT_FALSE(walk_by(WalkedBy::bdf, state, 0, 2).failed());
  std::vector<double> phi_J{state.phi_J};
  for (int i = 0; i < steps; ++i) {
    EXPECT_FALSE(walk_by(WalkedBy::bdf, state, std::log(0.82 / nu) / steps, 0).failed());
    phi_J.push_back(state.phi_J);
  }
  return phi_J;
}

TEST(MemoryCompression, GivesBackWhatShearHasTaken) {
  const double first = jamming_density_after(over(), 0.82, 1.0);
  for (const double nu : {0.66, 0.68, 0.70}) {
    const std::vector<double> phi_J = given_back(nu, 1);
    EXPECT_NEAR(phi_J.front(), form().steady_density(nu), 1e-9);
    EXPECT_GT(phi_J.back(), (phi_J.front() + first) / 2) << nu;  // most of it
    EXPECT_LE(phi_J.back(), first);
  }
}

TEST(MemoryCompression, GivesBackWithoutAJump) {
  const auto most = [](const std::vector<double>& phi_J) {
    double step = 0;
    for (std::size_t i = 1; i < phi_J.size(); ++i) {
      EXPECT_GE(phi_J[i], phi_J[i - 1]) << "it never takes";
      step = std::max(step, phi_J[i] - phi_J[i - 1]);
    }
    return step;
  };
  const std::vector<double> coarse = given_back(0.68, 100), fine = given_back(0.68, 400);
  EXPECT_NEAR(most(coarse) / most(fine), 4, 0.2);
  EXPECT_NEAR(coarse.back(), fine.back(), 1e-7) << "and it may be cut into pieces";
}

TEST(MemoryCompression, GrowsByEquations5_1And5_5WhateverHasLoweredIt) {
  for (const double nu : {0.67, 0.70, 0.75}) {
    State state = isotropic(nu);
    ASSERT_FALSE(walk_by(WalkedBy::bdf, state, 0, 0.2, {1e-11, 1e-14}).failed());
    const double h = 1e-6, before = state.phi_J;
    const double expected = growth_by_compression(over(), before, nu, 0.82) * h;
    ASSERT_FALSE(walk_by(WalkedBy::bdf, state, h, 0, {1e-11, 1e-14}).failed());
    EXPECT_NEAR(state.phi_J - before, expected, 1e-2 * expected) << nu;
  }
}

/// Sheared at the largest density it has seen and compressed on for the first time: phi_J goes up as that of
/// a packing that was never sheared.
TEST(MemoryCompression, AFirstOneAfterShearIsAFirstOne) {
  for (const WalkedBy integrator : integrators) {
    const double first = jamming_density_after(over(), 0.68, 1.0);
    State state = isotropic(0.68, first, 0.68);
    ASSERT_FALSE(walk_by(integrator, state, 0, 0.5).failed());
    const double sheared = state.phi_J;
    EXPECT_LT(sheared, first - 5e-4);
    ASSERT_FALSE(walk_by(integrator, state, std::log(0.82 / 0.68), 0).failed());
    const double grown = jamming_density_after(over(), 0.82, 1.0) - first;
    EXPECT_NEAR(state.phi_J - sheared, grown, 0.2 * grown) << name_of(integrator);
    ASSERT_FALSE(walk_by(integrator, state, std::log(0.68 / 0.82), 0).failed());
    EXPECT_GT(state.phi_J, sheared + 0.8 * grown) << "and keeps it";
  }
}

/// Turned round at another density than that of the shear, phi_J has no jump.
TEST(MemoryCompression, AReversalAfterDecompressionHasNoJump) {
  State state = isotropic(0.82);
  ASSERT_FALSE(walk_by(WalkedBy::light, state, 0, 0.5).failed());
  ASSERT_FALSE(walk_by(WalkedBy::light, state, std::log(0.68 / 0.82), 0).failed());
  const double before = state.phi_J;
  ASSERT_FALSE(walk_by(WalkedBy::light, state, 0, -0.003).failed());
  EXPECT_LT(std::abs(state.phi_J - before), 0.2 * (before - form().steady_density(0.68)));
}

TEST(MemoryCompression, OfWhatBothDirectionsRemember) {
  // States that shear comes near, and at worst: m falls as it should, whichever direction has it.
  for (const WalkedBy integrator : integrators)
    for (const auto& [plus, minus] :
         {std::pair{1.0, 0.0}, {0.3, 0.3}, {0.9, 0.9}, {0.999, 0.999}, {1.0, 1.0}}) {
      SCOPED_TRACE(std::string(name_of(integrator)) + ' ' + to_text(plus) + ' ' + to_text(minus));
      State state = isotropic(0.68);
      state.shear.plus = plus;
      state.shear.minus = minus;
      state.phi_J = form().jamming_density_of(state);
      state.P = form().pressure_of(state.nu, state.phi_J);
      const double before = memory_in(state), phi_J = state.phi_J;
      const Status status = walk_by(integrator, state, 0.05, 0);
      ASSERT_FALSE(status.failed()) << status.message;
      EXPECT_LT(memory_in(state), before);
      EXPECT_GE(memory_in(state), 0);
      EXPECT_GT(state.phi_J, phi_J);
    }
}

TEST(MemoryCompression, UniaxialCyclesSlideAlongFirstCompressions) {
  for (const WalkedBy integrator : integrators) {
    State state = isotropic(0.64, over().phi_SJ, 0.64);
    const double way = std::log(0.82 / 0.64);
    double low = 1, high = 0;
    for (int i = 0; i < 100; ++i) {
      for (const double q : {1.0, -1.0}) {
        const Status status = walk_by(integrator, state, q * way, q * way);
        ASSERT_FALSE(status.failed()) << name_of(integrator) << i << status.message;
        ASSERT_TRUE(is_finite(state));
        ASSERT_EQ(state.jammed, q > 0);
        ASSERT_LE(memory_in(state), 1 + 1e-8);
        if (q > 0 && i > 20) low = std::min(low, state.P), high = std::max(high, state.P);
      }
    }
    // P at 0.82 lies between those of the isotropic and the sheared packing and hardly changes any more.
    EXPECT_GT(low, 0.95 * form().pressure_of(0.82, state.history.phi_H));
    EXPECT_LT(high / low, 1.02);
  }
}

}  // namespace
}  // namespace grainlaw::model
