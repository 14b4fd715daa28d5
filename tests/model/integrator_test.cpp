// The integrator on problems with known solutions: accuracy, exact ends, events, failures, and reuse.
#include "grainlaw/model/walk/integrator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

/// y' = -lambda (y - cos t) - sin t, y = cos t + (y_0 - 1) exp(-lambda t): stiff where lambda is large.
System relaxation(double lambda) {
  System system;
  system.rate = [=](double t, const double* y, double* dy) {
    dy[0] = -lambda * (y[0] - std::cos(t)) - std::sin(t);
    return true;
  };
  system.jacobian = [=](double, const double*, double* J) {
    J[0] = -lambda;
    return true;
  };
  return system;
}

TEST(Integrator, AchievesTheAskedErrorStiffOrNot) {
  for (const double lambda : {1.0, 40.0, 1e6})
    for (const double rtol : {1e-4, 1e-7, 1e-10}) {
      Integrator integrator(1, {rtol, rtol});
      const System system = relaxation(lambda);
      double y = 2;
      ASSERT_FALSE(integrator.start(system, 0, 1, &y).failed());
      for (int i = 1; i <= 20; ++i) {
        const auto arrival = integrator.advance(0.05 * i, &y);
        ASSERT_FALSE(arrival.status.failed()) << arrival.status.message;
        EXPECT_NEAR(y, std::cos(0.05 * i) + std::exp(-lambda * 0.05 * i), 10 * rtol) << lambda;
      }
    }
}

TEST(Integrator, AdamsAchievesTheAskedErrorInFewerStepsWhereNothingIsStiff) {
  for (const double lambda : {1.0, 40.0})
    for (const double rtol : {1e-4, 1e-7, 1e-10}) {
      const System system = relaxation(lambda);
      const auto steps = [&](Method method) {
        Integrator integrator(1, {rtol, rtol}, method);
        double y = 2;
        EXPECT_FALSE(integrator.start(system, 0, 1, &y).failed());
        EXPECT_FALSE(integrator.advance(1, &y).status.failed());
        EXPECT_NEAR(y, std::cos(1) + std::exp(-lambda), 10 * rtol) << name_of(method);
        return integrator.steps();
      };
      if (rtol < 1e-5) {
        EXPECT_LT(steps(Method::adams), steps(Method::bdf)) << rtol;
      }
    }
  EXPECT_EQ(method_of("adams"), Method::adams);
  EXPECT_THAT(refusal([] { method_of("euler"); }), HasSubstr("method: must be one of bdf, adams"));
}

TEST(Integrator, AdamsIsRightWhereItIsStiffInMoreSteps) {
  const System system = relaxation(1e5);
  const auto steps = [&](Method method) {
    Integrator integrator(1, {1e-6, 1e-6}, method);
    double y = 2;
    EXPECT_FALSE(integrator.start(system, 0, 1, &y).failed());
    EXPECT_FALSE(integrator.advance(1, &y).status.failed());
    EXPECT_NEAR(y, std::cos(1), 1e-5);
    return integrator.steps();
  };
  EXPECT_GT(steps(Method::adams), steps(Method::bdf));
}

/// dy/dt = -p_0 y + p_1: y = (1 - p_1/p_0) exp(-p_0 t) + p_1/p_0 from y = 1.
TEST(Integrator, SensitivitiesOfALinearProblem) {
  const double p0 = 3, p1 = 2;
  System system;
  system.rate = [=](double, const double* y, double* dy) {
    dy[0] = -p0 * y[0] + p1;
    return true;
  };
  system.jacobian = [=](double, const double*, double* J) {
    J[0] = -p0;
    return true;
  };
  system.sensitivity_rate = [=](double, const double* y, const double* s, double* ds) {
    ds[0] = -p0 * s[0] - y[0];
    ds[1] = -p0 * s[1] + 1;
    return true;
  };
  for (const Method method : {Method::bdf, Method::adams})
    for (const double rtol : {1e-5, 1e-9}) {
      Integrator integrator(1, {rtol, 1e-3 * rtol}, method, {p0, p1});
      double y = 1, s[] = {0, 0};
      ASSERT_FALSE(integrator.start(system, 0, 1, &y, s).failed());
      for (const double t : {0.3, 1.0}) {
        ASSERT_FALSE(integrator.advance(t, &y, s).status.failed());
        const double fall = std::exp(-p0 * t);
        EXPECT_NEAR(s[0], p1 / p0 / p0 * (fall - 1) - (1 - p1 / p0) * t * fall, 10 * rtol);
        EXPECT_NEAR(s[1], (1 - fall) / p0, 10 * rtol);
      }
    }
  EXPECT_THAT(refusal([] { Integrator(1, {}, Method::bdf, {1, 0}); }), HasSubstr("scales: must be > 0"));
}

TEST(Integrator, LooksNoFurtherThanTheEnd) {
  double furthest = 0;
  System system = relaxation(3);
  system.rate = [&, inner = system.rate](double t, const double* y, double* dy) {
    furthest = std::max(furthest, t);
    return inner(t, y, dy);
  };
  Integrator integrator(1, {});
  double y = 1;
  integrator.start(system, 0, 0.7, &y);
  EXPECT_EQ(integrator.advance(0.7, &y).t, 0.7);
  EXPECT_LE(furthest, 0.7);
}

TEST(Integrator, IsReusedForAnotherProblem) {
  Integrator integrator(1, {1e-10, 1e-12});
  double y = 2;
  const System first = relaxation(5), second = relaxation(500);
  integrator.start(first, 0, 1, &y);
  integrator.advance(1, &y);
  EXPECT_NEAR(y, std::cos(1) + std::exp(-5), 1e-9);
  double z = 3;
  integrator.start(second, 0, 2, &z);
  integrator.advance(2, &z);
  EXPECT_NEAR(z, std::cos(2), 1e-9);
}

TEST(Integrator, SaysWhichOfSeveralEventsCameFirst) {
  System system;
  system.rate = [](double, const double*, double* dy) {
    dy[0] = 1;
    return true;
  };
  system.jacobian = [](double, const double*, double* J) {
    J[0] = 0;
    return true;
  };
  system.others = {[](double, const double* y) { return y[0] - 0.8; },
                   [](double, const double* y) { return 0.3 - y[0]; }};
  system.event = [](double, const double* y) { return y[0] - 0.5; };
  Integrator integrator(1, {1e-10, 1e-12});
  double y = 0;
  ASSERT_FALSE(integrator.start(system, 0, 1, &y).failed());
  for (const auto& [which, place] : {std::pair{1u, 0.3}, std::pair{2u, 0.5}, std::pair{0u, 0.8}}) {
    const auto arrival = integrator.advance(1, &y);
    EXPECT_TRUE(arrival.event);
    EXPECT_EQ(arrival.which, which);
    EXPECT_NEAR(y, place, 1e-12);
  }
  EXPECT_FALSE(integrator.advance(1, &y).event);
}

TEST(Integrator, StopsWhereAnEventCrossesZero) {
  System fall;
  fall.rate = [](double t, const double*, double* dy) {
    dy[0] = -2 * t;
    return true;
  };
  fall.jacobian = [](double, const double*, double* J) {
    J[0] = 0;
    return true;
  };
  fall.event = [](double, const double* y) { return y[0] - 0.36; };
  Integrator integrator(1, {1e-10, 1e-12});
  double y = 1;  // 1 - t^2
  integrator.start(fall, 0, 2, &y);
  EXPECT_FALSE(integrator.advance(0.5, &y).event);
  const auto arrival = integrator.advance(2, &y);
  EXPECT_TRUE(arrival.event);
  EXPECT_NEAR(arrival.t, 0.8, 1e-9);
  EXPECT_NEAR(y, 0.36, 1e-9);
  // The next problem on the same object has no event.
  const System plain = relaxation(1);
  y = 1;
  integrator.start(plain, 0, 3, &y);
  EXPECT_FALSE(integrator.advance(3, &y).event);
}

TEST(Integrator, ManyPointsInOneStepAndNoneBeyondTheFirst) {
  const System system = relaxation(1);
  Integrator integrator(1, {1e-10, 1e-12});
  double y = 1;
  integrator.start(system, 0, 1, &y);
  for (const double t : {0.0, 0.0, 1e-15, 1e-9, 1e-9, 0.3, 0.3, 1.0}) {
    ASSERT_FALSE(integrator.advance(t, &y).status.failed());
    EXPECT_NEAR(y, std::cos(t), 1e-9);
  }
}

TEST(Integrator, FailureIsAStatusAndLeavesTheStateAlone) {
  System wall = relaxation(1);
  wall.rate = [](double, const double* y, double* dy) {
    dy[0] = -1;
    return y[0] > 0.5;  // not defined further on, and nothing stops before it
  };
  Integrator integrator(1, {});
  double y = 1;
  integrator.start(wall, 0, 1, &y);
  const auto arrival = integrator.advance(1, &y);
  EXPECT_TRUE(arrival.status.failed());
  EXPECT_THAT(arrival.status.message, HasSubstr("CVODE"));
  EXPECT_EQ(y, 1);
}

TEST(Integrator, NotANumberIsAFailureNotAResult) {
  System system = relaxation(1);
  system.rate = [](double, const double*, double* dy) {
    dy[0] = std::nan("");
    return true;
  };
  Integrator integrator(1, {});
  double y = 1;
  integrator.start(system, 0, 1, &y);
  EXPECT_TRUE(integrator.advance(1, &y).status.failed());
}

TEST(Integrator, AnExceptionOfTheSystemComesThrough) {
  System system = relaxation(1);
  system.rate = [](double, const double*, double*) -> bool { throw std::runtime_error("from the law"); };
  Integrator integrator(1, {});
  double y = 1;
  integrator.start(system, 0, 1, &y);
  EXPECT_THROW(integrator.advance(1, &y), std::runtime_error);
}

TEST(Integrator, RefusesToleranceThatMeansNothing) {
  EXPECT_THAT(refusal([] { Integrator(1, {0, 1e-9}); }), HasSubstr("rtol: must be > 0"));
  EXPECT_THAT(refusal([] { Integrator(1, {1e-8, 0}); }), HasSubstr("atol: must be > 0"));
  EXPECT_THAT(refusal([] { Integrator(1, {NAN, 1e-9}); }), HasSubstr("rtol"));
}

}  // namespace
}  // namespace grainlaw::model
