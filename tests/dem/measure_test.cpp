// Stress as the derivative of energy, contacts counted by hand, and invariance under what must not matter.
#include "grainlaw/dem/step/measure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "grainlaw/dem/numbers/random.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Measurement measured(const Material& m, const State& state) { return Dynamics(m, state).measure(); }

/// The packing after l -> (1 - e) l.
State strained(State state, const Mat3& compression) {
  const Mat3 f = Mat3::identity() + -1.0 * compression;
  state.box = f * state.box;
  for (auto& x : state.position) x = f * x;
  return state;
}

Material elastic() {
  Material m;
  m.gamma = 0;
  return m;
}

TEST(Measure, StressIsDerivativeOfEnergyInAnyBox) {
  // Box and grains strained together, all six components, of a box that is upright and of one that is tilted.
  const Material m = elastic();
  const State upright = test::squeezed(m, 150, 21, 0.75);
  const State tilted = strained(upright, {{0.02, 0.3, -0.2}, {0.1, -0.05, 0.25}, {0, 0.1, 0.02}});
  for (const State& state : {upright, tilted}) {
    const Measurement here = measured(m, state);
    const std::size_t axis_a[6] = {0, 1, 2, 1, 0, 0}, axis_b[6] = {0, 1, 2, 2, 2, 1};
    const double h = 1e-6;
    for (std::size_t c = 0; c < 6; ++c) {
      Mat3 e;
      e(axis_a[c], axis_b[c]) = e(axis_b[c], axis_a[c]) = h;
      const double slope =
          (measured(m, strained(state, e)).elastic - measured(m, strained(state, -1.0 * e)).elastic) /
          (2 * h);
      const double twice = c < 3 ? 1 : 2;  // both ab and ba are strained
      EXPECT_NEAR(here.stress[c], slope / (twice * determinant(state.box)), 1e-6 * trace(here.stress) / 3)
          << c;
    }
  }
}

TEST(Measure, AllStressComponentsAreDerivativesOfEnergy) {
  // Strain the branch vectors of the contacts: l -> (1 - e) l with a symmetric e.
  const Material m = elastic();
  const State state = test::squeezed(m, 150, 22, 0.75);
  Dynamics dynamics(m, state);
  const Measurement here = dynamics.measure();
  const int axis_a[6] = {0, 1, 2, 1, 0, 0}, axis_b[6] = {0, 1, 2, 2, 2, 1};
  const double h = 1e-6;
  for (std::size_t c = 0; c < 6; ++c) {
    const auto energy = [&](double e) {
      double sum = 0;
      for_each_contact(
          dynamics.neighbours().pairs(), dynamics.grains(), dynamics.cell(), [&](const Contact& contact) {
            const auto a = static_cast<std::size_t>(axis_a[c]), b = static_cast<std::size_t>(axis_b[c]);
            Vec3 l = contact.branch;
            l[a] -= 0.5 * e * contact.branch[b];
            l[b] -= 0.5 * e * contact.branch[a];
            const double overlap = contact.overlap + contact.distance - norm(l);
            sum += 0.5 * m.k * overlap * overlap;
          });
      return sum;
    };
    const double slope = (energy(h) - energy(-h)) / (2 * h);
    const double scale = std::abs(trace(here.stress)) / 3;
    EXPECT_NEAR(here.stress[c], slope / dynamics.cell().volume(), 1e-6 * scale) << c;
  }
}

TEST(Measure, OneContactByHand) {
  const Material m = elastic();
  State state;
  state.box = Mat3::diagonal({10, 10, 10});
  state.radius = {1, 0.5};
  state.position = {{0.2, 5, 5}, {9.0, 5, 5}};  // touch through the face x = 0; overlap 0.3
  state.velocity = {{0, 0, 0.1}, {0, 0, 0}};
  const Measurement one = measured(m, state);
  EXPECT_EQ(one.contacts, 1u);
  EXPECT_NEAR(one.stress[0], 1e5 * 0.3 * 1.2 / 1000, 1e-9);
  for (std::size_t c = 1; c < 6; ++c) EXPECT_NEAR(one.stress[c], 0, 1e-12);
  const double v1 = sphere_volume(1), v2 = sphere_volume(0.5);
  EXPECT_NEAR(one.fabric[0], (v1 + v2) / 1000, 1e-12);
  EXPECT_NEAR(one.nu, (v1 + v2) / 1000, 1e-15);
  EXPECT_NEAR(one.elastic, 0.5e5 * 0.09, 1e-8);
  EXPECT_NEAR(one.kinetic, 0.5 * 2000 * v1 * 0.01, 1e-9);
  EXPECT_NEAR(one.kinetic_stress[2], 2000 * v1 * 0.01 / 1000, 1e-12);
  EXPECT_EQ(one.C, 0);
  EXPECT_EQ(one.f_NR, 0);
  EXPECT_TRUE(std::isnan(one.C_star));
}

/// Grains that have begun to flow.
Dynamics flowing(const Material& m) {
  Dynamics dynamics(m, test::squeezed(m, 150, 24, 0.75));
  dynamics.start(1e-3, {1e-3, -1e-3, 0});
  dynamics.step(dynamics.cell().length(), {1e-3, -1e-3, 0});
  return dynamics;
}

TEST(Measure, TheCheapOnesAgreeWithTheWhole) {
  const Dynamics dynamics = flowing(Material{});
  const Measurement whole = dynamics.measure();
  EXPECT_EQ(dynamics.energies().kinetic, whole.kinetic);
  EXPECT_EQ(dynamics.energies().elastic, whole.elastic);
  EXPECT_EQ(static_stress(dynamics.law(), dynamics.grains(), dynamics.velocities(), dynamics.cell(),
                          dynamics.neighbours().pairs()),
            whole.stress);
  // This one takes the velocity that the forces saw.
  const Sym6 seen = dynamics.static_stress();
  Sym6 forces{};
  const auto& grains = dynamics.grains();
  for_each_contact(dynamics.neighbours().pairs(), grains, dynamics.cell(), [&](const Contact& c) {
    const double f = dynamics.law().force(c.overlap, closing_speed(c, grains.motion, dynamics.cell()));
    forces[0] += f / c.distance * c.branch[0] * c.branch[0];
  });
  EXPECT_NEAR(seen[0], forces[0] / dynamics.cell().volume(), 1e-12 * seen[0]);
  EXPECT_NEAR(seen[0] / whole.stress[0], 1, 1e-5);
}

/// Each of the 32 choices: what is wanted is there to the same bit, and nothing else was computed.
TEST(Measure, WhatIsNotWantedIsNotComputed) {
  const Dynamics dynamics = flowing(Material{});
  const Measurement whole = dynamics.measure();
  for (unsigned choice = 0; choice < 32; ++choice) {
    const auto chosen = [&](unsigned bit) { return (choice >> bit & 1U) != 0; };
    const Wanted wanted{chosen(0), chosen(1), chosen(2), chosen(3), chosen(4)};
    const Measurement part = dynamics.measure(wanted);
    const auto expect = [&](double found, double should, bool is_wanted, const char* what) {
      if (is_wanted)
        EXPECT_EQ(found, should) << what << " of choice " << choice;
      else
        EXPECT_TRUE(std::isnan(found)) << what << " of choice " << choice << ": " << found;
    };
    expect(part.nu, whole.nu, true, "nu");
    for (std::size_t c = 0; c < 6; ++c) {
      expect(part.stress[c], whole.stress[c], wanted.stress, "stress");
      expect(part.kinetic_stress[c], whole.kinetic_stress[c], wanted.kinetic_stress, "kinetic stress");
      expect(part.fabric[c], whole.fabric[c], wanted.fabric, "fabric");
    }
    expect(part.contacts, whole.contacts, wanted.coordination, "contacts");
    expect(part.C, whole.C, wanted.coordination, "C");
    expect(part.C_star, whole.C_star, wanted.coordination, "C_star");
    expect(part.f_NR, whole.f_NR, wanted.coordination, "f_NR");
    expect(part.kinetic, whole.kinetic, wanted.energies, "kinetic");
    expect(part.elastic, whole.elastic, wanted.energies, "elastic");
  }
}

TEST(Measure, RattlersAreLeftOutOfCAndKeptInFabric) {
  // A face-centred cubic crystal (12 contacts each) and one grain more in a hole, touching three of its walls
  // only.
  const Material m = elastic();
  State state = test::crystal(0.99, 0);
  const double a = 0.5 * state.box(0, 0);
  // The hole's centre is 0.99 sqrt(2) = 1.400 from six grains; r = 0.3 leaves 0.1 of room: push it into a
  // corner.
  state.position.push_back({a / 2 + 0.12, 0.12, 0.12});
  state.radius.push_back(0.3);
  state.velocity.push_back({0, 0, 0});
  const Measurement crystal = measured(m, state);
  EXPECT_DOUBLE_EQ(crystal.f_NR, 32.0 / 33);
  EXPECT_EQ(crystal.contacts, 32u * 6 + 3);
  // Three of the grains count the contact with the rattler as their thirteenth.
  EXPECT_DOUBLE_EQ(crystal.C, (32.0 * 12 + 3) / 33);
  EXPECT_DOUBLE_EQ(crystal.C_star, (32.0 * 12 + 3) / 32);
  double fabric = (32 * 12 + 3) * sphere_volume(1) + 3 * sphere_volume(0.3);
  EXPECT_NEAR(trace(crystal.fabric), fabric / (8 * a * a * a), 1e-12);
}

void expect_same(const Sym6& a, const Sym6& b, double scale) {
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(a[c], b[c], 1e-11 * scale) << c;
}

class Invariance : public testing::Test {
 protected:
  Material m;
  State state = test::squeezed(m, 200, 23, 0.72);
  Measurement here = measured(m, state);
  void expect_equal(const Measurement& other, const Sym6& stress, const Sym6& fabric) {
    EXPECT_EQ(other.contacts, here.contacts);
    EXPECT_DOUBLE_EQ(other.C, here.C);
    EXPECT_DOUBLE_EQ(other.C_star, here.C_star);
    EXPECT_DOUBLE_EQ(other.f_NR, here.f_NR);
    EXPECT_NEAR(other.nu, here.nu, 1e-14);
    EXPECT_NEAR(other.elastic / here.elastic, 1, 1e-11);
    EXPECT_NEAR(other.kinetic / here.kinetic, 1, 1e-12);
    expect_same(other.stress, stress, here.stress[0]);
    expect_same(other.fabric, fabric, here.fabric[0]);
  }
};

TEST_F(Invariance, Permutation) {
  const State other = test::permuted(state, test::shuffled(state.count(), 1));
  expect_equal(measured(m, other), here.stress, here.fabric);
}

TEST_F(Invariance, TranslationAndImages) {
  State other = state;
  for (std::size_t i = 0; i < other.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      other.position[i][c] += 1.234 * static_cast<double>(c + 1) +
                              state.box(c, c) * static_cast<double>(i % 5) - 2 * state.box(c, c);
  expect_equal(measured(m, other), here.stress, here.fabric);
}

TEST_F(Invariance, AxisSwap) {
  State other = state;
  for (std::size_t i = 0; i < other.count(); ++i) {
    other.position[i] = {state.position[i][1], state.position[i][2], state.position[i][0]};
    other.velocity[i] = {state.velocity[i][1], state.velocity[i][2], state.velocity[i][0]};
  }
  other.box = Mat3::diagonal({state.box(1, 1), state.box(2, 2), state.box(0, 0)});
  // x' = y, y' = z, z' = x, so yz' = zx, xz' = yx, xy' = yz
  const auto swapped = [](const Sym6& q) { return Sym6{q[1], q[2], q[0], q[4], q[5], q[3]}; };
  expect_equal(measured(m, other), swapped(here.stress), swapped(here.fabric));
}

}  // namespace
}  // namespace grainlaw::dem
