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

/// A packing with stress and bulk modulus over k*, under an isotropic strain; its shear stress is sxy.
struct Linear {
  double P, bulk, sxy = 0;
  Glance seen() const {
    Glance glance;
    const double unit = material.stress_unit();
    glance.stress = {P * unit, P * unit, P * unit, 0, 0, sxy * unit};
    glance.bulk = bulk * unit;
    return glance;
  }
  void strain(const Sym6& rates, double time) { P += bulk * (rates[0] + rates[1] + rates[2]) * time; }
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
  control.component[0] = StressTarget{};  // as at the start
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
  EXPECT_EQ(servo.rates(state), (Sym6{2e-4, 2e-4, 2e-4}));
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
  control.component[2] = StressTarget{};
  control.servo = {1e-3, 1, 2000};
  const Servo servo(material, control);
  EXPECT_FALSE(servo.possible(servo.start(Linear{0, 0}.seen())));
  EXPECT_TRUE(servo.possible(servo.start(Linear{1e-9, 0}.seen())));
}

Control shear_control(std::optional<double> target) {
  Control control;
  control.component[5] = StressTarget{target};
  control.servo = {1e-3, 1, 2000};
  return control;
}

TEST(Servo, AShearErrorFallsByEInAResponseTime) {
  // Of an affine network the shear stress answers to a component of the strain with 2G = 6/5 K.
  const Servo servo(material, shear_control(-0.002));
  Linear packing{0.04, 0.4, 0.003};
  ServoState state = servo.start(packing.seen());
  const int looks = static_cast<int>(std::lround(servo.response() / elapsed));
  for (int i = 0; i < looks; ++i) {
    servo.look(state, packing.seen(), elapsed, 0);
    const Sym6 rates = servo.rates(state);
    for (std::size_t c = 0; c < 5; ++c) EXPECT_EQ(rates[c], 0);
    packing.sxy += 1.2 * 0.4 * rates[5] * elapsed;
  }
  const double time = looks * elapsed / servo.response();
  EXPECT_NEAR(std::log(0.005 / (packing.sxy + 0.002)), time, 0.6 * elapsed / servo.response());
}

TEST(Servo, ToleranceOfAShearStressIsOfThePressureOrOfItself) {
  const auto error = [](std::optional<double> target, double P, double sxy) {
    const Servo servo(material, shear_control(target));
    ServoState state = servo.start(Linear{0.1, 0.4, 0.01}.seen());
    servo.look(state, Linear{P, 0.4, sxy}.seen(), elapsed, 0);
    EXPECT_TRUE(servo.possible(state));
    return servo.error(state, 0);
  };
  EXPECT_NEAR(error(0.0, 0.04, 0.002), 0.05, 1e-12);  // of the pressure that there is now
  EXPECT_NEAR(error(-0.01, 0.04, 0.002), 0.3, 1e-12);
  EXPECT_NEAR(error(-0.05, 0.04, -0.052), -0.04, 1e-12);  // larger than the pressure: of the target
  EXPECT_NEAR(error(std::nullopt, 0.04, 0.008), -0.05, 1e-12);
  EXPECT_EQ(error(0.0, 0, 0), 0);  // no contacts: no shear stress, either
  EXPECT_EQ(error(0.01, 0, 0), -1);
  EXPECT_NEAR(error(0.0, 3.3e-16, 1.75e-16), 1.75e-4, 1e-12);  // an unjammed packing's rounding
}

}  // namespace
}  // namespace grainlaw::dem
