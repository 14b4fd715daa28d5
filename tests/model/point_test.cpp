// A material point through loss of contact and back, beyond what the laws admit, and against the tolerance it
// was asked.
#include "grainlaw/model/walk/point.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled};

MaterialPoint point_at(double nu, Form form, ParameterSet parameters = thesis(),
                       Tolerance tolerance = {1e-10, 1e-13}) {
  const Law law = make_law(parameters, form);
  State state;
  state.nu = nu;
  state.P = pressure(laws_of(law).pressure, nu);
  state.phi_J = jamming_density(laws_of(law).pressure);
  state.jammed = state.P > 0;
  return MaterialPoint(law, state, tolerance);
}

void expect_unjammed(const State& state) {
  EXPECT_FALSE(state.jammed);
  EXPECT_EQ(state.P, 0);
  EXPECT_EQ(state.sigma_dev, 0);
  EXPECT_EQ(state.F_dev, 0);
  EXPECT_TRUE(std::isnan(state.s_dev()));
}

TEST(Point, DecompressionUnjamsAndCompressionJamsAgain) {
  for (const Form form : forms)
    for (const double shear : {0.0, 1.0}) {  // ISO and UNI
      SCOPED_TRACE(name_of(form) + (shear == 0 ? " iso" : " uni"));
      MaterialPoint point = point_at(0.7, form);
      ASSERT_EQ(point.walk(-0.06, -0.06 * shear).code, Status::Code::ok);
      expect_unjammed(point.state());
      ASSERT_EQ(point.events().size(), 1U);
      EXPECT_FALSE(point.events()[0].jammed);
      const double lost_at = point.events()[0].nu;
      if (form != Form::coupled) {
        EXPECT_NEAR(lost_at, 0.6649, 1e-12);
      }
      ASSERT_EQ(point.walk(0.06, 0.06 * shear).code, Status::Code::ok);
      EXPECT_TRUE(point.state().jammed);
      EXPECT_NEAR(point.state().nu, 0.7, 1e-14);
      ASSERT_EQ(point.events().size(), 2U);
      EXPECT_TRUE(point.events()[1].jammed);
      EXPECT_NEAR(point.events()[1].nu, lost_at, 1e-7);
      EXPECT_GT(point.state().P, 0.01);
      EXPECT_EQ(point.state().s_dev() > 0, shear > 0);
    }
}

TEST(Point, PressureOfTheCoupledFormVanishesWhereItsIntegralDoes) {
  // Isotropic: P* - P_0 is the integral of B, which is the pressure law with Table 4.1's numbers (Eq. 4.11).
  MaterialPoint point = point_at(0.7, Form::coupled);
  const PressureCurve integral{{6, 7.9219, 0.5769, 0.658, 0.1363, 15.0010}, 0.0425, 0.2, 0.658};
  const double offset = point.state().P - pressure(integral, 0.7);
  ASSERT_FALSE(point.walk(-0.06, 0).failed());
  ASSERT_EQ(point.events().size(), 1U);
  EXPECT_NEAR(pressure(integral, point.events()[0].nu), -offset, 2e-9);
  EXPECT_EQ(point.state().phi_J, point.events()[0].nu);
  ASSERT_FALSE(point.walk(0.1, 0).failed());
  EXPECT_NEAR(point.state().P, pressure(integral, point.state().nu) + offset, 1e-9);
}

TEST(Point, SamplesAroundTheEventBelongToTheirSide) {
  for (const Form form : forms) {
    MaterialPoint point = point_at(0.7, form);
    std::vector<double> samples;
    for (int i = 0; i <= 1000; ++i) samples.push_back(i / 1000.0);
    std::size_t visited = 0;
    ASSERT_FALSE(point
                     .walk(-0.1, -0.1, samples,
                           [&](std::size_t i, const State& state) {
                             EXPECT_EQ(i, visited++);
                             EXPECT_NEAR(state.nu, 0.7 * std::exp(-0.1 * samples[i]), 1e-14);
                             EXPECT_EQ(state.jammed, state.P > 0);
                             if (!state.jammed) expect_unjammed(state);
                           })
                     .failed());
    EXPECT_EQ(visited, samples.size());
    EXPECT_FALSE(point.state().jammed);
  }
}

TEST(Point, AStretchThatEndsAtJammingEndsUnjammed) {
  for (const Form form : {Form::reduced_closed, Form::reduced}) {
    MaterialPoint point = point_at(0.7, form);
    int visited = 0;
    const double end[] = {1.0};
    ASSERT_FALSE(point
                     .walk(std::log(0.6649 / 0.7) - 1e-15, 0, end,
                           [&](std::size_t, const State& state) {
                             expect_unjammed(state);
                             ++visited;
                           })
                     .failed());
    EXPECT_EQ(visited, 1);
  }
}

TEST(Point, ShearAloneMayUnjamTheCoupledFormAndCannotJamIt) {
  // At F_v,min the shear modulus vanishes (Eq. 4.14), while A1 S takes pressure away after a reversal: s_dev
  // grows, not falls.
  const Law law = make_law(thesis(), Form::coupled);
  State state;
  state.nu = 0.6582;
  state.P = 1e-4;
  state.sigma_dev = 2e-5;
  state.F_dev = 0.15;
  state.jammed = true;
  MaterialPoint point(law, state, {1e-10, 1e-13});
  ASSERT_FALSE(point.walk(0, -0.1).failed());
  expect_unjammed(point.state());
  EXPECT_EQ(point.state().phi_J, 0.6582);
  ASSERT_FALSE(point.walk(0, 0.5).failed());
  expect_unjammed(point.state());
  ASSERT_FALSE(point.walk(0.05, 0).failed());
  EXPECT_TRUE(point.state().jammed);
  EXPECT_GT(point.state().P, 0.01);
}

TEST(Point, ContactsMayBeginWithAnInfiniteBulkModulus) {
  ParameterSet set = thesis();
  set.closure.contacts_at_moduli_nu_c = false;  // contacts from 0.6601 on, the strain of B from 0.658
  const Law law = make_law(set, Form::coupled);
  State state;
  state.nu = 0.67;
  state.P = 0.01;
  state.jammed = true;
  MaterialPoint point(law, state, {1e-10, 1e-13});
  const PressureCurve integral{laws_of(law).contacts, 0.0425, 0.2, 0.658};
  ASSERT_FALSE(point.walk(-0.02, 0).failed());
  expect_unjammed(point.state());
  EXPECT_NEAR(point.events()[0].nu, 0.6601, 1e-8);
  ASSERT_FALSE(point.walk(0.02, 0).failed());
  EXPECT_NEAR(point.state().P, pressure(integral, 0.67) - pressure(integral, 0.6601 * (1 + 1e-9)), 3e-8);
}

TEST(Point, JamsOnTheSolutionForVanishingPressure) {
  // The same compression begun at jamming, and begun a little above it from the state the first had there.
  MaterialPoint whole = point_at(0.66, Form::coupled), first = point_at(0.66, Form::coupled);
  const double to_start = std::log(0.665 / 0.66);
  ASSERT_FALSE(whole.walk(0.2, 0.2).failed());
  ASSERT_FALSE(first.walk(to_start, to_start).failed());
  ASSERT_FALSE(first.walk(0.2 - to_start, 0.2 - to_start).failed());
  EXPECT_NEAR(whole.state().P, first.state().P, 1e-10);
  EXPECT_NEAR(whole.state().sigma_dev, first.state().sigma_dev, 1e-10);
  EXPECT_NEAR(whole.state().F_dev, first.state().F_dev, 1e-10);
  // s starts at r g/(1 + r g/s_max) with g = (G/B)_ini and r = d eps_dev/d ln nu = 1, as P* and sigma* grow
  // in proportion.
  MaterialPoint start = point_at(0.66, Form::coupled);
  const double a_little = std::log(0.6649 / 0.66) + 1e-6;
  ASSERT_FALSE(start.walk(a_little, a_little).failed());
  const Laws& laws = laws_of(start.law());
  const double g = initial_shear_ratio(laws.moduli, isotropic_fabric(laws.contacts, laws.g3, 0.6649));
  EXPECT_NEAR(start.state().s_dev(), g / (1 + g / saturation(laws.s_max, 0.6649)), 1e-5);
}

/// Relative L2 error over the path of the worst of P, sigma_dev and F_dev, in units of rtol.
double error_over_tolerance(const std::string& path, Form form, double rtol, Method method) {
  const Prediction reference = predict(thesis(), path_of(path), {form, 1e-12, 1e-15, 100});
  const Prediction p = predict(thesis(), path_of(path), {form, rtol, 1e-3 * rtol, 100, {}, method});
  double worst = 0;
  for (const char* column : {"P", "sigma_dev", "F_dev"}) {
    double square = 0, error = 0;
    for (std::size_t i = 0; i < p.record.rows(); ++i) {
      square += std::pow(reference.record[column][i], 2);
      error += std::pow(p.record[column][i] - reference.record[column][i], 2);
    }
    worst = std::max(worst, std::sqrt(error / square) / rtol);
  }
  return worst;
}

TEST(Point, AchievesTheAskedErrorWithinTenTimes) {
  const char* paths[] = {
      R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "controls": {"eps_dev": 0.4}},
          {"mode": "d2", "controls": {"eps_dev": -0.4}}, {"mode": "d2", "controls": {"eps_dev": 0.4}}]})",
      R"({"start": {"nu": 0.66}, "segments": [{"mode": "uni", "controls": {"nu": 0.82}},
          {"mode": "uni", "controls": {"nu": 0.66}}]})",
      R"({"start": {"nu": 0.711}, "segments": [{"mode": "d3", "amount": 0.2}, {"mode": "iso", "controls": {"nu": 0.675}},
          {"mode": "d3", "amount": 0.2}, {"mode": "relax"}, {"mode": "uni", "amount": 0.1}, {"mode": "d3", "amount": -0.1}]})"};
  for (const char* path : paths)
    for (const Form form : {Form::reduced, Form::coupled})
      for (const Method method : {Method::bdf, Method::adams}) {
        double loosest = 0;
        for (const double rtol : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
          const double ratio = error_over_tolerance(path, form, rtol, method);
          EXPECT_LT(ratio, 10) << name_of(form) << " by " << name_of(method) << " at " << rtol << " on "
                               << path;
          loosest = std::max(loosest, ratio);
        }
        EXPECT_GT(loosest, 1e-3) << "the tolerance does nothing";
      }
}

TEST(Point, FailureIsAStatusAndLeavesTheStateAlone) {
  ParameterSet set = thesis();
  set.shear->s_max->Q_max.value = -0.05;  // s_max(0.9) < 0
  for (const Form form : forms) {
    MaterialPoint point = point_at(0.7, form, set);
    ASSERT_FALSE(point.walk(0, 0.01).failed());
    const State before = point.state();
    const Status status = point.walk(0.2, 0.2);
    EXPECT_TRUE(status.failed());
    EXPECT_THAT(status.message, HasSubstr("s_max is -0.0"));
    EXPECT_EQ(point.state().nu, before.nu);
    EXPECT_EQ(point.state().sigma_dev, before.sigma_dev);
    EXPECT_FALSE(point.walk(0, 0.01).failed());  // and the point can go on
  }
}

TEST(Point, FailureOnTheWayGoesBackToTheStart) {
  ParameterSet set = thesis();
  set.shear->beta_F->Q_max.value = 1e308;  // the rate of F_dev overflows as soon as there is contact
  MaterialPoint point = point_at(0.66, Form::coupled, set);
  const Status status = point.walk(0.1, 0.1);
  EXPECT_TRUE(status.failed());
  EXPECT_THAT(status.message, HasSubstr("CVODE"));
  EXPECT_EQ(point.state().nu, 0.66);
  EXPECT_FALSE(point.state().jammed);
  EXPECT_TRUE(point.events().empty());
  ASSERT_FALSE(point.walk(-0.1, 0).failed());
}

TEST(Point, AStretchMayBeCutAnywhere) {
  for (const Form form : forms) {
    MaterialPoint whole = point_at(0.68, form), pieces = point_at(0.68, form);
    ASSERT_FALSE(whole.walk(0.1, 0.1).failed());
    for (int i = 0; i < 7; ++i) ASSERT_FALSE(pieces.walk(0.1 / 7, 0.1 / 7).failed());
    EXPECT_NEAR(whole.state().P, pieces.state().P, 1e-10) << name_of(form);
    EXPECT_NEAR(whole.state().sigma_dev, pieces.state().sigma_dev, 1e-10) << name_of(form);
    EXPECT_NEAR(whole.state().F_dev, pieces.state().F_dev, 1e-10) << name_of(form);
  }
}

TEST(Point, AStretchOfNothingChangesNothing) {
  for (const Form form : forms) {
    MaterialPoint point = point_at(0.7, form);
    ASSERT_FALSE(point.walk(0, 0.02).failed());
    const State before = point.state();
    const double samples[] = {0, 0.5, 1};
    int visited = 0;
    ASSERT_FALSE(point.walk(0, 0, samples, [&](std::size_t, const State&) { ++visited; }).failed());
    EXPECT_EQ(visited, 3);
    EXPECT_EQ(point.state().P, before.P);
    EXPECT_EQ(point.state().direction.q, before.direction.q);
  }
}

TEST(Point, TinyAndHugeIncrements) {
  for (const Form form : forms) {
    MaterialPoint point = point_at(0.711, form);
    for (int i = 0; i < 100; ++i) ASSERT_FALSE(point.walk(0, 1e-12).failed());
    EXPECT_NEAR(point.state().eps_dev, 1e-10, 1e-22);
    EXPECT_GT(point.state().sigma_dev, 0);
    ASSERT_FALSE(point.walk(0, 100).failed());
    EXPECT_NEAR(point.state().s_dev(), 0.16691, 1e-5);
  }
}

TEST(Point, ReversalInEveryIncrement) {
  MaterialPoint point = point_at(0.711, Form::coupled, thesis(), {1e-8, 1e-11});
  for (int i = 0; i < 2000; ++i) {
    ASSERT_FALSE(point.walk(0, i % 2 == 0 ? 1e-3 : -1e-3).failed());
    ASSERT_LE(std::abs(point.state().s_dev()), 0.167);
    ASSERT_LE(std::abs(point.state().F_dev), 0.124);
  }
}

}  // namespace
}  // namespace grainlaw::model
