// The energy account of closed loops: what the law takes in, or gives, round a loop of strain or of stress.
// Per unit of solid volume, dW = (P* d ln nu + (2/3) sigma*_dev d eps_dev)/nu.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/start.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

/// A point with an account.
class Account {
 public:
  /// At nu = 0.711, sheared by `shear`.
  Account(Terms terms, double shear) : Account(Choice{Form::coupled, terms}, shear) {}
  Account(const Choice& choice, double shear) : law_(make_law(set(), choice)), light_(law_, {1e-10, 1e-14}) {
    Path path;
    path.start.nu = 0.711;
    state_ = start_of(set(), path, choice).state;
    EXPECT_FALSE(light_.update(state_, 0, shear).failed());
  }
  const State& state() const { return state_; }
  const Coupled& form() const { return std::get<Coupled>(law_); }
  double memory() const { return std::get<Memory>(law_).memory(state_.shear); }
  double work() const { return work_; }

  void strain(double eps_vol, double eps_dev) {
    constexpr int parts = 5;
    for (int i = 0; i < parts; ++i) step(eps_vol / parts, eps_dev / parts);
  }
  /// Changes the stress: finds the strain by Newton's method, from that of the elastic moduli.
  void stress(double dP, double dsigma) {
    const double target[] = {state_.P + dP, state_.sigma_dev + dsigma};
    std::array<double, 2> e{dP / 0.43, dsigma / 0.15};
    const auto miss = [&](double v, double d) {
      State there = state_;
      EXPECT_FALSE(light_.update(there, v, d).failed());
      return std::array{there.P - target[0], there.sigma_dev - target[1]};
    };
    for (int round = 0; round < 50; ++round) {
      const auto off = miss(e[0], e[1]);
      if (std::abs(off[0]) + std::abs(off[1]) < 1e-15) break;
      const double h = 1e-8, q = e[1] < 0 ? -h : h;  // within the direction
      const auto v = miss(e[0] + h, e[1]), d = miss(e[0], e[1] + q);
      const double a = (v[0] - off[0]) / h, b = (d[0] - off[0]) / q, c = (v[1] - off[1]) / h,
                   g = (d[1] - off[1]) / q, det = a * g - b * c;
      e[0] -= (g * off[0] - b * off[1]) / det;
      e[1] -= (a * off[1] - c * off[0]) / det;
    }
    step(e[0], e[1]);
    EXPECT_NEAR(state_.P, target[0], 1e-13);
    EXPECT_NEAR(state_.sigma_dev, target[1], 1e-13);
  }

 private:
  static ParameterSet set() {
    ParameterSet set = thesis_with_memory();
    set.moduli->a_F = set.moduli->a_s = set.moduli->a_I;
    set.moduli->a_F->value = 3.59;
    set.moduli->a_s->value = 0.149;
    return set;
  }

  /// Simpson's rule.
  void step(double eps_vol, double eps_dev) {
    State middle = state_, end = state_;
    EXPECT_FALSE(light_.update(middle, eps_vol / 2, eps_dev / 2).failed());
    EXPECT_FALSE(light_.update(end, eps_vol, eps_dev).failed());
    const auto power = [&](const State& s) {
      return (s.P * eps_vol + 2.0 / 3 * s.sigma_dev * eps_dev) / s.nu;
    };
    work_ += (power(state_) + 4 * power(middle) + power(end)) / 6;
    state_ = end;
  }

  Law law_;
  LightLaw light_;
  State state_;
  double work_ = 0;
};

/// Round a square of strain of side d: volume first, or shear first.
double round_strain(Account& point, double d, bool volume_first) {
  const double before = point.work();
  for (const double side : {d, -d}) {
    if (volume_first) point.strain(side, 0);
    point.strain(0, side);
    if (!volume_first) point.strain(side, 0);
  }
  return point.work() - before;
}

constexpr Terms plain{}, energy{.energy = true};

TEST(ClosedLoops, Equation4_16CreatesEnergyRoundSmallLoopsOfStrain) {
  // Elastic, a loop of area d^2 takes (2/3 A2 - A1 - 2/3 sigma)/nu d^2 per solid volume. That is 0 for moduli
  // of an energy; Eqs. 4.12 and 4.13 have 0.0067 B F_dev - 2/3 sigma instead.
  constexpr double d = 1e-5;
  Account point(plain, 0.02);
  const State begin = point.state();
  const auto c = point.form().coefficients(begin.nu);
  const double expected =
      (2.0 / 3 * anisotropy_modulus_2(point.form().laws.moduli, c.B, begin.F_dev) -
       anisotropy_modulus_1(point.form().laws.moduli, c.B, begin.F_dev) - 2.0 / 3 * begin.sigma_dev) /
      begin.nu * d * d;
  EXPECT_NEAR(expected / (begin.P * d), -7.5e-7, 2e-8);  // of the work that one side of the loop takes
  for (int loop = 0; loop < 20; ++loop)
    EXPECT_NEAR(round_strain(point, d, true), expected, 0.05 * std::abs(expected)) << "for ever";
  // The other way round, after the first reversal, it swallows as much.
  round_strain(point, d, false);
  EXPECT_NEAR(round_strain(point, d, false), -expected, 0.05 * std::abs(expected));
}

TEST(ClosedLoops, TheEnergyTermCreatesNone) {
  for (const double d : {1e-6, 1e-5, 1e-4})
    for (const bool volume_first : {true, false}) {
      Account point(energy, 0.02);
      round_strain(point, d, volume_first);  // ends the direction that it began in
      for (int loop = 0; loop < 10; ++loop) {
        const double work = round_strain(point, d, volume_first);
        EXPECT_GT(work, 0);
        EXPECT_LT(work, 300 * d * d * point.state().P * d);  // plastic: of third order
      }
    }
}

TEST(ClosedLoops, LargerLoopsDissipate) {
  for (const Terms terms : {plain, energy})
    for (const double d : {1e-3, 1e-2})
      for (const bool volume_first : {true, false}) {
        Account point(terms, 0.02);
        for (int loop = 0; loop < 10; ++loop) EXPECT_GT(round_strain(point, d, volume_first), 0) << d;
      }
}

TEST(ClosedLoops, LoopsOfStressDissipateAndCreep) {
  for (const Terms terms : {plain, energy})
    for (const bool pressure_first : {true, false}) {
      Account point(terms, 0.02);
      const State begin = point.state();
      const double dP = 0.43e-5, dsigma = 0.15e-5;
      double work = 0, eps_dev = 0;
      for (int loop = 0; loop < 5; ++loop) {
        const double before = point.work(), at = point.state().eps_dev;
        for (const double side : {1.0, -1.0}) {
          if (pressure_first) point.stress(side * dP, 0);
          point.stress(0, side * dsigma);
          if (!pressure_first) point.stress(side * dP, 0);
        }
        work = point.work() - before;
        eps_dev = point.state().eps_dev - at;
        EXPECT_GT(work, 0);
        EXPECT_GT(eps_dev, 0);
      }
      EXPECT_NEAR(point.state().P, begin.P, 1e-12);
      EXPECT_NEAR(point.state().sigma_dev, begin.sigma_dev, 1e-12);
      // What it takes in is the stress times the strain by which the loop does not close.
      EXPECT_NEAR(work, 2.0 / 3 * begin.sigma_dev * eps_dev / begin.nu, 0.2 * work);
    }
}

TEST(ClosedLoops, TheFormWithMemoryCreatesMore) {
  // P follows from m, which goes on while a loop closes in strain: its work is of second order in d, taken in
  // where the volume moves first, of either sign where the shear does.
  for (const double d : {1e-6, 1e-5, 1e-4, 1e-3})
    for (const bool volume_first : {true, false}) {
      Account point(Choice{Form::memory, {}}, 0.02);
      round_strain(point, d, volume_first);  // ends the direction that it began in
      for (int loop = 0; loop < 5; ++loop) {
        const double P = point.state().P, m = point.memory();
        const double work = round_strain(point, d, volume_first) / (P * d * d);
        EXPECT_NE(point.memory(), m);
        EXPECT_NEAR(work, volume_first ? 0.6 : 0, volume_first ? 0.26 : 0.12) << d;  // Eq. 4.16: -0.075
      }
    }
  Account point(Choice{Form::memory, {}}, 0.02);
  round_strain(point, 1e-2, true);
  for (int loop = 0; loop < 5; ++loop) EXPECT_GT(round_strain(point, 1e-2, true), 0) << "and in large loops";
}

}  // namespace
}  // namespace grainlaw::model
