// The servo alone, on a packing that answers linearly: the error falls as promised, a ramp is followed,
// limits hold.
#include "grainlaw/dem/drive/servo.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw::dem {
namespace {

const Material material;
constexpr double elapsed = 0.2;  // us between two looks

Control mean_control(double target, double rate) {
  Control control;
  control.mean = StressTarget{target};
  control.servo = {1e-3, rate, 2000};
  return control;
}

/// A packing with stress and bulk modulus over k*, under an isotropic strain.
struct Linear {
  double P, bulk;
  Glance seen() const {
    Glance glance;
    const double unit = material.stress_unit();
    glance.stress = {P * unit, P * unit, P * unit};
    glance.bulk = bulk * unit;
    return glance;
  }
  void strain(const Vec3& rates, double time) { P += bulk * (rates[0] + rates[1] + rates[2]) * time; }
};

TEST(Servo, ErrorFallsByEInAResponseTime) {
  const Servo servo(material, mean_control(0.05, 1));
  Linear packing{0.04, 0.4};
  ServoState state = servo.start(packing.seen());
  const int looks = static_cast<int>(std::lround(servo.response() / elapsed));
  for (int i = 0; i < looks; ++i) {
    servo.look(state, packing.seen(), elapsed, 0);
    packing.strain(servo.rates(state), elapsed);
  }
  const double time = looks * elapsed / servo.response();
  // (1 - dt/response)^n of explicit steps against exp(-n dt/response)
  EXPECT_NEAR(std::log(0.01 / (0.05 - packing.P)), time, 0.6 * elapsed / servo.response());
}

TEST(Servo, FollowsARampWithoutALag) {
  Control control;
  control.axis[0] = StressTarget{};  // as at the start
  control.servo = {1e-2, 1, 2000};
  const Servo servo(material, control);
  Linear packing{0.05, 0.4};
  ServoState state = servo.start(packing.seen());
  const double driven = 3e-5;
  for (int i = 0; i < 3000; ++i) {
    servo.look(state, packing.seen(), elapsed, driven);
    // x answers to its own strain, and the driven axis loads it by half as much; stiffness 9/5 of the bulk.
    packing.P += 1.8 * 0.4 * (servo.rates(state)[0] + 0.5 * driven * state.throttle) * elapsed;
  }
  EXPECT_NEAR(state.follow[0], -0.5, 1e-6);
  EXPECT_NEAR(packing.P, 0.05, 1e-10);
  EXPECT_EQ(state.throttle, 1);
  EXPECT_EQ(servo.rates(state)[1], 0);
}

TEST(Servo, RateIsBoundedAndDrivenAxesWait) {
  const Servo servo(material, mean_control(0.05, 2e-4));
  ServoState state = servo.start(Linear{0, 0}.seen());
  servo.look(state, Linear{0, 0}.seen(), elapsed, 3e-5);
  EXPECT_EQ(servo.rates(state), (Vec3{2e-4, 2e-4, 2e-4}));
  EXPECT_EQ(state.throttle, 0);
  EXPECT_EQ(state.off, elapsed);
  EXPECT_FALSE(servo.within_tolerance(state));
  servo.look(state, Linear{0.05 * (1 + 7.5e-4), 0.4}.seen(), elapsed, 3e-5);
  EXPECT_NEAR(state.throttle, 0.5, 1e-10);  // half way between half the tolerance and all of it
  EXPECT_TRUE(servo.within_tolerance(state));
  EXPECT_EQ(state.off, 0);
}

TEST(Servo, AStressOfZeroAtTheStartCannotBeKept) {
  Control control;
  control.axis[2] = StressTarget{};
  control.servo = {1e-3, 1, 2000};
  const Servo servo(material, control);
  EXPECT_FALSE(servo.possible(servo.start(Linear{0, 0}.seen())));
  EXPECT_TRUE(servo.possible(servo.start(Linear{1e-9, 0}.seen())));
}

}  // namespace
}  // namespace grainlaw::dem
