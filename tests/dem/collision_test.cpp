// Two grains colliding: the closed solution of Eq. 2.1 (contact duration t_c, restitution e), and the order
// of the scheme.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

double reduced_mass(const Material& m, double r1, double r2) {
  const double a = m.rho * sphere_volume(r1), b = m.rho * sphere_volume(r2);
  return a * b / (a + b);
}

struct Approach {
  double overlap, closing;
};

Approach approach(const Dynamics& dynamics) {
  const auto& g = dynamics.grains();
  const auto v = dynamics.velocities();
  const Vec3 d{g.place[0].x - g.place[1].x, g.place[0].y - g.place[1].y, g.place[0].z - g.place[1].z};
  const Vec3 u{v[0].x - v[1].x, v[0].y - v[1].y, v[0].z - v[1].z};
  return {g.place[0].w + g.place[1].w - norm(d), -dot(d, u) / norm(d)};
}

/// delta(t) = v0/omega e^(-eta t) sin(omega t), and its derivative.
Approach exact(const Material& m, double m12, double v0, double t) {
  const double eta = m.gamma / (2 * m12), omega = std::sqrt(m.k / m12 - eta * eta),
               decay = std::exp(-eta * t);
  return {v0 / omega * decay * std::sin(omega * t),
          v0 * decay * (std::cos(omega * t) - eta / omega * std::sin(omega * t))};
}

Material without_background() {
  Material m;
  m.gamma_b = 0;
  return m;
}

struct Outcome {
  double duration, restitution;
};

/// Steps until the grains part; the end lies within the last step and is found by its Taylor series.
Outcome collide(const Material& m, double r1, double r2, double steps_per_contact) {
  const double m12 = reduced_mass(m, r1, r2), v0 = 0.01;
  const double eta = m.gamma / (2 * m12), omega = std::sqrt(m.k / m12 - eta * eta);
  Dynamics dynamics(m, test::two_grains(r1, r2, v0));
  dynamics.start(std::numbers::pi / omega / steps_per_contact, {});
  Approach last{0, v0};
  double t = 0;
  for (Approach now = last; now.overlap >= 0 || t == 0; now = approach(dynamics)) {
    last = now;
    t = dynamics.time();
    dynamics.step();
  }
  const double a = -(m.k * last.overlap + m.gamma * last.closing) / m12,
               j = -(m.k * last.closing + m.gamma * a) / m12;
  double rest = 0;
  for (int i = 0; i < 50; ++i)
    rest -= (last.overlap + rest * (last.closing + rest * (a / 2 + rest * j / 6))) /
            (last.closing + rest * (a + rest * j / 2));
  return {t + rest, -(last.closing + rest * (a + rest * j / 2)) / v0};
}

TEST(Collision, ThesisNumbers) {
  const Material m;
  EXPECT_NEAR(m.contact_duration(0.5), 0.2279, 5e-5);
  EXPECT_NEAR(m.contact_duration(1.0), 0.6432, 5e-5);
  const Outcome small = collide(without_background(), 0.5, 0.5, 500),
                mean = collide(without_background(), 1, 1, 500);
  EXPECT_NEAR(small.duration, 0.2279, 5e-5);
  EXPECT_NEAR(small.restitution, 0.804, 5e-4);
  EXPECT_NEAR(mean.duration, 0.6432, 5e-5);
  EXPECT_NEAR(mean.restitution, 0.926, 5e-4);
}

class SizePair : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(SizePair, DurationAndRestitution) {
  const auto [r1, r2] = GetParam();
  const Material m = without_background();
  const double m12 = reduced_mass(m, r1, r2), eta = m.gamma / (2 * m12);
  const double t_c = std::numbers::pi / std::sqrt(m.k / m12 - eta * eta), e = std::exp(-eta * t_c);
  const Outcome fine = collide(m, r1, r2, 500);
  EXPECT_NEAR(fine.duration / t_c, 1, 2e-6);
  EXPECT_NEAR(fine.restitution / e, 1, 5e-7);
}

TEST_P(SizePair, SecondOrderInPositionAndVelocity) {
  const auto [r1, r2] = GetParam();
  const Material m = without_background();
  const double m12 = reduced_mass(m, r1, r2), v0 = 0.01, eta = m.gamma / (2 * m12);
  const double t_c = std::numbers::pi / std::sqrt(m.k / m12 - eta * eta), end = 0.8 * t_c;
  double before_x = 0, before_v = 0;
  for (const int steps : {80, 160, 320, 640}) {
    Dynamics dynamics(m, test::two_grains(r1, r2, v0));
    dynamics.start(end / steps, {});
    for (int n = 0; n < steps; ++n) dynamics.step();
    const Approach is = approach(dynamics), should = exact(m, m12, v0, end);
    const double x = std::abs(is.overlap - should.overlap), v = std::abs(is.closing - should.closing);
    if (before_x > 0) {
      EXPECT_NEAR(std::log2(before_x / x), 2, 0.15) << steps;
      EXPECT_NEAR(std::log2(before_v / v), 2, 0.15) << steps;
    }
    before_x = x;
    before_v = v;
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, SizePair,
                         testing::Values(std::pair{0.5, 0.5}, std::pair{1.0, 1.0}, std::pair{0.5, 1.5},
                                         std::pair{1.5, 1.5}));

TEST(Collision, MayPullBeforeParting) {
  // Eq. 2.1 is not clipped: at delta = 0+ on the way out the force is gamma d(delta)/dt < 0.
  const LinearContact law = LinearContact::of(Material{});
  EXPECT_LT(law.force(1e-9, -0.01), 0);
  EXPECT_DOUBLE_EQ(law.force(0.01, 0), 1000);
  EXPECT_DOUBLE_EQ(law.force(0, 0.01), 10);
  EXPECT_NEAR((law.energy(0.0101) - law.energy(0.0099)) / 2e-4, law.force(0.01, 0), 1e-6);
  EXPECT_NEAR((law.force(0.0101, 0) - law.force(0.0099, 0)) / 2e-4, law.stiffness(0.01), 1e-6);
}

TEST(Collision, StepAsFractionOfContactDuration) {
  EXPECT_NEAR(time_step(Material{}, 0.5, 0.1), 0.02279, 5e-6);
  Material overdamped;
  overdamped.gamma = 1e6;
  EXPECT_THROW(time_step(overdamped, 0.5, 0.1), Error);
}

/// Duration of an undamped contact at steps of this fraction of it, over the exact one: its overlaps are an
/// oscillation whose frequency the last three of them tell, and with it where in the last step they vanish.
double simulated_duration(const Material& elastic, double fraction) {
  const double exact = elastic.contact_duration(0.5), dt = fraction * exact;
  Dynamics dynamics(elastic, test::two_grains(0.5, 0.5, 0.01));
  dynamics.start(dt, {});
  std::vector<double> overlap{0};
  while (overlap.size() == 1 || overlap.back() >= 0) {
    dynamics.step();
    overlap.push_back(approach(dynamics).overlap);
  }
  const auto last = overlap.end() - 1;
  const double before = last[-2], at = last[-1], after = last[0];
  const double phase = std::acos((before + after) / (2 * at));
  const double rest = std::atan2(at, (at * std::cos(phase) - after) / std::sin(phase)) / phase;
  return (static_cast<double>(overlap.size() - 2) + rest) * fraction;
}

// measure.time_step of a wanted error: a contact simulated at that step is too short by as much as was asked.
TEST(Collision, StepOfAWantedContactError) {
  Material elastic = without_background();
  elastic.gamma = 0;
  for (const double error : {9.99e-7, 1.01e-6, 1e-5, 1e-3, 0.01, 0.0169}) {
    const double fraction = step_of_contact_error(error);
    EXPECT_NEAR(contact_error_of(fraction), error, 1e-13);
    EXPECT_NEAR(fraction, std::sqrt(24 * error) / std::numbers::pi, error * fraction);
    // Places are rounded to 2e-15 mm, a step moves them by 1e-5 mm, and the phase of a step is 0.016 at the
    // least: to 5e-9 of t_c.
    EXPECT_NEAR(1 - simulated_duration(elastic, fraction), error, 1e-6 * error + 5e-9);
  }
  EXPECT_LT(step_of_contact_error(0.0169), 0.2);
  EXPECT_NEAR(step_of_contact_error(1e-12) * std::numbers::pi / std::sqrt(24e-12), 1, 1e-11);
}

}  // namespace
}  // namespace grainlaw::dem
