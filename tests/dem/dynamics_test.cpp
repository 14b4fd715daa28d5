// What the equations of motion promise: momentum, energy, and what each damping acts on.
#include "grainlaw/dem/step/dynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Material elastic() {
  Material m;
  m.gamma = 0;
  m.gamma_b = 0;
  return m;
}

Vec3 momentum(const Dynamics& dynamics, double* scale = nullptr) {
  Vec3 p{};
  const auto v = dynamics.velocities();
  for (std::size_t i = 0; i < dynamics.count(); ++i) {
    const double m = 1 / dynamics.grains().acceleration[i].w;
    p[0] += m * v[i].x;
    p[1] += m * v[i].y;
    p[2] += m * v[i].z;
    if (scale) *scale += m * (std::abs(v[i].x) + std::abs(v[i].y) + std::abs(v[i].z));
  }
  return p;
}

TEST(Dynamics, MomentumIsConservedToRounding) {
  Material m;
  m.gamma_b = 0;
  Dynamics dynamics(m, test::squeezed(m, 150, 3, 0.8));
  dynamics.start(0.01, {});
  for (int n = 0; n < 2000; ++n) dynamics.step();
  double scale = 0;
  const Vec3 p = momentum(dynamics, &scale);
  EXPECT_GT(scale, 0);
  EXPECT_LT(norm(p), 1e-12 * scale);
}

TEST(Dynamics, EnergyErrorFallsWithTheSquareOfTheStep) {
  // In a crystal whose contacts stay closed, so that forces are smooth.
  const Material m = elastic();
  std::vector<double> error;
  for (const int steps : {400, 800, 1600}) {
    Dynamics dynamics(m, test::crystal(0.97, 0.03));
    dynamics.start(20.0 / steps, {});
    const auto energy = [&] {
      const Measurement now = dynamics.measure();
      return now.kinetic + now.elastic;
    };
    const double before = energy();
    double worst = 0;
    for (int n = 0; n < steps; ++n) {
      dynamics.step();
      worst = std::max(worst, std::abs(energy() / before - 1));
      ASSERT_EQ(dynamics.measure().contacts, 192u);
    }
    error.push_back(worst);
  }
  EXPECT_GT(error[2], 1e-9);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.1);
}

/// Closing velocities (mm/us) of the contacts there are.
std::map<std::pair<std::uint32_t, std::uint32_t>, double> closing_velocities(const Dynamics& dynamics) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> closing;
  const Quads velocity = dynamics.velocities();
  const Grains& grains = dynamics.grains();
  for_each_contact(dynamics.neighbours().pairs(), grains, dynamics.cell(), [&](const Contact& c) {
    const Quad &a = velocity[c.i], &b = velocity[c.j];
    closing[std::minmax(grains.id[c.i], grains.id[c.j])] =
        -dot(c.branch, {a.x - b.x, a.y - b.y, a.z - b.z}) / c.distance;
  });
  return closing;
}

// Forces are continuous where a contact closes or opens, their derivatives are not: there the scheme has no
// modified energy to conserve. A step at whose share theta a contact of closing velocity v closes changes
// that energy by -k v^2 dt^2/2 theta (1 - theta), one at which it opens by as much with the other sign. The
// means (theta (1 - theta) is 1/6 on average) cancel; what is left has the variance 1/180 of theta (1 -
// theta) if the steps fall by chance. So the energy of a box at rest goes a random walk whose steps follow
// dt^2: its largest deviation over a fixed time, too, and not the smooth dt^2 of a network that stays closed.

/// What a gas of elastic grains did to its energy, ug mm^2/us^2.
struct EnergyWalk {
  double end = 0, largest = 0;  ///< deviation from the start: at the end, and the largest size on the way
  double variance = 0;          ///< foretold for `end`
  std::size_t crossings = 0;    ///< contacts that closed or opened
};

EnergyWalk walk(const Material& m, std::uint64_t seed, double duration, int steps) {
  NewPacking packing;
  packing.count = 128;
  packing.seed = seed;
  packing.nu_gas = 0.4;
  Dynamics dynamics(m, random_gas(m, packing));
  const double dt = duration / steps;
  dynamics.start(dt, {});
  const auto energy = [&] {
    const Energies now = dynamics.energies();
    return now.kinetic + now.elastic;
  };
  const double before = energy();
  EnergyWalk walk;
  auto closed = closing_velocities(dynamics);
  const auto count = [&](const auto& these, const auto& others) {
    for (const auto& [pair, v] : these) {
      if (others.count(pair) > 0) continue;
      ++walk.crossings;
      walk.variance += std::pow(0.5 * m.k * v * v * dt * dt, 2) / 180;
    }
  };
  for (int n = 0; n < steps; ++n) {
    dynamics.step();
    auto now = closing_velocities(dynamics);
    count(now, closed);
    count(closed, now);
    closed = std::move(now);
    walk.end = energy() - before;
    walk.largest = std::max(walk.largest, std::abs(walk.end));
  }
  return walk;
}

TEST(Dynamics, EnergyOfCollisionsGoesARandomWalkWithTheSquareOfTheStep) {
  const Material m = elastic();
  const double t_c = time_step(m, m.r_min(), 1);
  constexpr int gases = 16;
  std::vector<double> largest;
  for (const int per_contact : {10, 20, 40}) {
    double chi_squared = 0, drift = 0, squares = 0;
    for (int seed = 1; seed <= gases; ++seed) {
      const EnergyWalk gas = walk(m, static_cast<std::uint64_t>(seed), 200 * t_c, 200 * per_contact);
      const double sigma = std::sqrt(gas.variance);
      ASSERT_GT(gas.crossings, 500u);
      // By Levy's inequality once in 1e8 gases; contacts that are just closed add less than sigma.
      EXPECT_LT(gas.largest, 7 * sigma);
      chi_squared += std::pow(gas.end / sigma, 2);
      drift += gas.end / sigma / std::sqrt(gases);
      squares += std::pow(gas.largest, 2);
    }
    // Chi squared of 16 degrees lies outside once in 1e6 on either side: another power of dt leaves it on the
    // way from the first step to the last, by a factor 16 in chi squared.
    EXPECT_GT(chi_squared, 1.45) << per_contact;
    EXPECT_LT(chi_squared, 58.3) << per_contact;
    EXPECT_LT(std::abs(drift), 4.9) << per_contact;  // of a normal number, as seldom
    largest.push_back(std::sqrt(squares / gases));
  }
  // The largest deviation of a walk scatters by 0.4 of itself, the mean square of 16 by 0.1: five times what
  // two of these make of the power.
  EXPECT_NEAR(std::log(largest[0] / largest[2]) / std::log(4), 2, 0.5);
}

TEST(Dynamics, WorkOfTheBoxIsThatOfTheTotalStress) {
  // dE/dt = V sum_c (sigma + sigma_kinetic)_cc (-G_cc), without any damping.
  const Material m = elastic();
  const State start = test::crystal(0.97, 0.03);
  const Vec3 rate{1e-3, -2e-3, -5e-4};
  std::vector<double> error;
  for (const int steps : {200, 400, 800}) {
    Dynamics dynamics(m, start);
    const double dt = 10.0 / steps;
    dynamics.start(dt, rate);
    const auto power = [&](const Measurement& now) {
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum -= rate[c] * (now.stress[c] + now.kinetic_stress[c]);
      return sum * dynamics.cell().volume();
    };
    Measurement now = dynamics.measure();
    const double energy = now.kinetic + now.elastic;
    double work = 0, power_before = power(now);
    for (int n = 1; n <= steps; ++n) {
      const double t = n * dt;
      dynamics.step({start.box(0, 0) * std::exp(rate[0] * t), start.box(1, 1) * std::exp(rate[1] * t),
                     start.box(2, 2) * std::exp(rate[2] * t)},
                    rate);
      now = dynamics.measure();
      ASSERT_EQ(now.contacts, 192u);
      work += 0.5 * dt * (power_before + power(now));
      power_before = power(now);
    }
    error.push_back(std::abs((now.kinetic + now.elastic - energy) / work - 1));
  }
  EXPECT_LT(error[2], 1e-4);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.2);
}

TEST(Dynamics, FlightInADeformingBox) {
  // dv/dt = -G v: without forces v L is constant per axis, which is the work of the kinetic stress.
  const Material m = elastic();
  State state = test::two_grains(1, 1, 0);
  state.position[1] = {2, 2, 2};
  state.velocity[0] = {0.01, -0.02, 0.03};
  const Vec3 rate{2e-3, -3e-3, 0};
  Dynamics dynamics(m, state);
  dynamics.start(0.02, rate);
  for (int n = 1; n <= 1000; ++n) {
    const double t = 0.02 * n;
    dynamics.step({20 * std::exp(rate[0] * t), 20 * std::exp(rate[1] * t), 20}, rate);
  }
  const State end = dynamics.state();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(end.velocity[0][c], state.velocity[0][c] * std::exp(-20 * rate[c]), 1e-10);
    // d(x/L)/dt = v/L, so x/L grows by v0/L0 (1 - e^(-2 G t))/(2 G)
    const double g = rate[c], flight = g == 0 ? 20 : (1 - std::exp(-40 * g)) / (2 * g);
    EXPECT_NEAR(end.position[0][c] / end.box(c, c),
                (state.position[0][c] + state.velocity[0][c] * flight) / 20, 1e-9);
  }
}

TEST(Dynamics, BackgroundDampsTheFluctuation) {
  Material m;
  State state = test::two_grains(1, 1, 0.01);
  state.position[1] = {2, 2, 2};  // never touch
  state.velocity = {{0.03, -0.02, 0.01}, {0, 0, 0}};
  Dynamics dynamics(m, state);
  dynamics.start(0.05, {});
  for (int n = 0; n < 400; ++n) dynamics.step();
  const double decay = std::exp(-m.gamma_b / (m.rho * sphere_volume(1)) * 20.0);
  const State end = dynamics.state();
  EXPECT_NEAR(end.velocity[0][0], 0.03 * decay, 1e-9);
  EXPECT_NEAR(end.velocity[0][1], -0.02 * decay, 1e-9);
  EXPECT_NEAR(end.velocity[0][2], 0.01 * decay, 1e-9);
  EXPECT_EQ(end.velocity[1][0], 0);
}

TEST(Dynamics, BackgroundDoesNotHoldBackTheFlow) {
  // Without fluctuation the grains go with the box, x/L constant, however strong the background; damping of
  // the total velocity would leave them behind.
  Material m;
  m.gamma_b = 1e4;
  State state = test::two_grains(1, 1, 0);
  state.position = {{3, 5, 7}, {13, 15, 17}};
  Dynamics dynamics(m, state);
  const Vec3 rate{1e-3, -2e-3, 0};
  dynamics.start(0.05, rate);
  Vec3 length = state.box.diagonal();
  for (int n = 1; n <= 2000; ++n) {
    for (std::size_t c = 0; c < 3; ++c) length[c] = state.box(c, c) * std::exp(rate[c] * 0.05 * n);
    dynamics.step(length, rate);
  }
  const State end = dynamics.state();
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(end.position[i][c] / end.box(c, c), state.position[i][c] / state.box(c, c), 1e-12);
  EXPECT_DOUBLE_EQ(end.box(1, 1), 20 * std::exp(-0.2));
}

TEST(Dynamics, ContactsSeeTheTrueClosingVelocity) {
  // Two grains without fluctuation in a compressing box close at -n.G.d: the viscous force is gamma times
  // that.
  const Material m;
  State state = test::two_grains(1, 1, 0);
  for (auto& x : state.position) x[0] = 10 + (x[0] - 10) * 0.9;
  Dynamics dynamics(m, state);
  const Vec3 rate{-0.01, -0.02, 0.004};
  dynamics.start(0.01, rate);
  const Measurement with = dynamics.measure();
  dynamics.start(0.01, {});
  const Measurement without = dynamics.measure();
  const Vec3 d{state.position[0][0] - state.position[1][0], state.position[0][1] - state.position[1][1],
               state.position[0][2] - state.position[1][2]};
  const double closing = -(rate[0] * d[0] * d[0] + rate[1] * d[1] * d[1] + rate[2] * d[2] * d[2]) / norm(d);
  EXPECT_NEAR(trace(with.stress) - trace(without.stress), m.gamma * closing * norm(d) / 8000, 1e-12);
  EXPECT_NEAR(dynamics.grains().force[0].x + dynamics.grains().force[1].x, 0, 1e-12);
}

TEST(Dynamics, ObserversDoNotChangeTheRun) {
  const Material m;
  const State start = test::squeezed(m, 100, 6, 0.7);
  const auto run = [&](bool observed) {
    Dynamics dynamics(m, start);
    dynamics.start(0.02, {});
    for (int n = 0; n < 300; ++n) {
      dynamics.step();
      if (observed) {
        dynamics.measure();
        dynamics.state();
      }
    }
    return dynamics.state();
  };
  EXPECT_EQ(run(true), run(false));
}

TEST(Dynamics, AMotionThatIsNotFiniteEndsTheRun) {
  const Material m;
  State start = test::squeezed(m, 50, 7, 0.7);
  start.velocity[20][1] = std::numeric_limits<double>::infinity();
  Dynamics dynamics(m, start);
  dynamics.start(0.02, {});
  EXPECT_THROW(dynamics.step(), Error);
}

TEST(Dynamics, StateReturnsInTheOrderItCame) {
  const Material m;
  const State start = test::squeezed(m, 300, 7, 0.7);
  Dynamics dynamics(m, start);
  const State back = dynamics.state();
  EXPECT_EQ(back.radius, start.radius);
  EXPECT_EQ(back.velocity, start.velocity);
  for (std::size_t i = 0; i < start.count(); ++i)
    EXPECT_LT(norm(Cell(start.box).nearest_image({back.position[i][0] - start.position[i][0],
                                                  back.position[i][1] - start.position[i][1],
                                                  back.position[i][2] - start.position[i][2]})),
              1e-12);
}

}  // namespace
}  // namespace grainlaw::dem
