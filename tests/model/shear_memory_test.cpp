// Eqs. 5.3 and 5.13 as rates: the closed forms that they integrate to, their ends, and their derivatives.
#include "grainlaw/model/laws/shear_memory.hpp"

#include <gtest/gtest.h>

#include <boost/numeric/odeint.hpp>
#include <cmath>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

/// u(x) from u_0 at x = 0, of a rate du/dx.
template <class Rate>
double integrated(double u, double x, Rate rate) {
  namespace odeint = boost::numeric::odeint;
  const auto stepper = odeint::make_controlled(1e-13, 1e-13, odeint::runge_kutta_dopri5<double>());
  odeint::integrate_adaptive(
      stepper, [&](const double& y, double& dydt, double) { dydt = rate(y); }, u, 0.0, x, 1e-3 * x);
  return u;
}

TEST(ShearMemory, TheFillingRateIsThatOfEquation5_3) {
  for (const double alpha : {1.0, 1.37, 1.7026, 3.0})
    for (const double x : {1e-3, 0.1, 0.5, 1.0, 1.5, 2.0}) {
      const double u = integrated(0, x, [&](double y) { return filling_rate(y, alpha); });
      EXPECT_NEAR(remembered(u, alpha), -std::expm1(-std::pow(x, alpha)), 1e-11) << alpha << ' ' << x;
    }
}

TEST(ShearMemory, TheEmptyingRateIsConstantDownToItsEnd) {
  // sqrt(u^2 + d^2) - d asinh(d/u) + x is constant, d = smooth_end.
  const double d = smooth_end;
  const auto closed = [&](double u) { return std::hypot(u, d) - d * std::asinh(d / u); };
  for (const double begin : {1.0, 0.6, 0.05})
    for (const double x : {0.01, 0.1, 0.3, 0.6, 1.0, 3.0}) {
      const double u = integrated(begin, x, [](double y) { return -emptying_rate(y); });
      EXPECT_NEAR(u, std::max(0.0, begin - x), 0.05) << "without what smooths its end";
      EXPECT_GT(u, -1e-12);
      if (u < 1e-3) continue;  // its logarithm is as exact as u over itself
      EXPECT_NEAR(closed(u) - closed(begin), -x, 1e-8);
    }
  EXPECT_LT(integrated(1, 1.3, [](double y) { return -emptying_rate(y); }), 1e-3);
}

TEST(ShearMemory, BothEndsAreEnds) {
  EXPECT_EQ(filling_rate(0.0, 1.37), 1) << "it leaves 0 as strain does";
  EXPECT_EQ(filling_rate(1.0, 1.37), 0);
  for (const double beyond : {-1e-9, -0.5}) {
    EXPECT_EQ(remembered(beyond, 1.37), 0);
    EXPECT_EQ(filling_rate(beyond, 1.37), 1);
    EXPECT_LT(emptying_rate(beyond), 0) << "it leads back";
  }
  for (const double beyond : {1 + 1e-9, 1.5}) {
    EXPECT_EQ(remembered(beyond, 1.37), 1);
    EXPECT_EQ(filling_rate(beyond, 1.37), 0);
  }
  EXPECT_EQ(emptying_rate(0.0), 0);
  EXPECT_NEAR(emptying_rate(1.0), 1 / std::hypot(1, smooth_end), 1e-15);
  double before = 1;
  for (int i = 1; i <= 1000; ++i) {  // no jump and no hump between, through the series at small a too
    const double rate = filling_rate(i / 1000.0, 1.37);
    EXPECT_LE(rate, before);
    EXPECT_NEAR(rate, before, 0.01);
    before = rate;
  }
  const double u = std::pow(1e-5, 1 / 1.37);  // where the series ends
  EXPECT_NEAR(filling_rate(u * (1 - 1e-12), 1.37), filling_rate(u * (1 + 1e-12), 1.37), 1e-11)
      << "rounding of a logarithm";
}

TEST(ShearMemory, BothDirectionsTogether) {
  EXPECT_EQ(memory_of(0.0, 0.0, 1.37), 0);
  EXPECT_EQ(memory_of(1.0, 0.0, 1.37), 1);
  EXPECT_EQ(memory_of(0.3, 1.0, 1.37), 1);
  EXPECT_NEAR(memory_of(0.5, 0.2, 2.0), 1 - 0.75 * 0.96, 1e-15);
  EXPECT_EQ(memory_of(0.5, 0.2, 1.37), memory_of(0.2, 0.5, 1.37));
}

TEST(ShearMemory, OppositionCountsFromIsotropyToSteadyShearTheOtherWay) {
  EXPECT_EQ(opposition(1e-6), 0);  // in the direction of the fabric
  EXPECT_EQ(opposition(1.0), 0);
  EXPECT_NEAR(opposition(1.3), 0.3, 1e-15);
  EXPECT_EQ(opposition(2.0), 1);
  EXPECT_EQ(opposition(2.4), 1);
}

TEST(ShearMemory, Derivatives) {
  using D = Dual<1>;
  for (const double u : {0.02, 0.5, 0.97}) {
    SCOPED_TRACE(u);
    expect_v_shape([](double x) { return remembered(x, 1.37); }, u, remembered(D(u, 0), 1.37).slope[0], 0.1);
    expect_v_shape([](double x) { return filling_rate(x, 1.37); }, u, filling_rate(D(u, 0), 1.37).slope[0],
                   0.02);
    expect_v_shape([](double x) { return emptying_rate(x); }, u, emptying_rate(D(u, 0)).slope[0], 0.1);
    expect_v_shape([](double x) { return memory_of(x, 0.3, 1.37); }, u,
                   memory_of(D(u, 0), D(0.3), 1.37).slope[0], 0.1);
    expect_v_shape([&](double alpha) { return filling_rate(u, alpha); }, 1.37,
                   filling_rate(D(u), D(1.37, 0)).slope[0], 0.5);
  }
}

TEST(ShearMemory, DerivativesAtTheEnds) {
  using D = Dual<1>;
  // u = 0 belongs to what is below, u = 1 to what is above: a has slope 0 there, and rates are finite.
  EXPECT_EQ(remembered(D(0.0, 0), 1.37).slope[0], 0);
  EXPECT_EQ(remembered(D(1.0, 0), 1.37).slope[0], 0);
  for (const double u : {0.0, 1e-300, 1e-12, 1 - 1e-12, std::nextafter(1.0, 0.0), 1.0}) {
    EXPECT_TRUE(std::isfinite(remembered(D(u, 0), 1.37).slope[0])) << u;
    EXPECT_TRUE(std::isfinite(filling_rate(D(u, 0), 1.37).slope[0])) << u;
    EXPECT_TRUE(std::isfinite(emptying_rate(D(u, 0)).slope[0])) << u;
  }
  // Just inside: alpha u^(alpha - 1); 1/smooth_end of the emptying.
  EXPECT_NEAR(remembered(D(1e-6, 0), 1.37).slope[0], 1.37 * std::pow(1e-6, 0.37), 1e-12);
  EXPECT_NEAR(remembered(D(1 - 1e-6, 0), 1.37).slope[0], 1.37, 1e-5);
  EXPECT_NEAR(emptying_rate(D(1e-9, 0)).slope[0], 1 / smooth_end, 1e-6);
}

}  // namespace
}  // namespace grainlaw::model
