// The two reduced forms: closed against rate form, against Eqs. 2.17, 2.18 written out, and on UNI as the
// thesis uses them.
#include <gtest/gtest.h>

#include <array>
#include <boost/numeric/odeint.hpp>

#include "grainlaw/model/forms/law.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

constexpr const char* d2 = R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.2}]})";
constexpr const char* uni =
    R"({"start": {"nu": 0.671}, "segments": [{"mode": "uni", "controls": {"nu": 0.82}}]})";

double table_2_2(double Q_max, double Q_v, double alpha, double nu) {
  return Q_max + Q_v * std::exp(-alpha * (nu / 0.6653 - 1));
}

TEST(Reduced, FirstLoadingIsEquations2_17And2_18) {
  const double s_max = table_2_2(0.1137, 0.09166, 7.916, 0.711), beta_s = table_2_2(30.76, 57, 16.86, 0.711);
  const double F_max = table_2_2(0, 0.1694, 4.562, 0.711), beta_F = table_2_2(0, 57.89, 5.366, 0.711);
  for (const Form form : {Form::reduced_closed, Form::reduced}) {
    const Prediction p = walk(d2, form);
    for (std::size_t i = 0; i < p.record.rows(); ++i) {
      const double e = p.record["eps_dev"][i];
      EXPECT_NEAR(p.record["s_dev"][i], s_max * (1 - std::exp(-beta_s * e)), 1e-11);
      EXPECT_NEAR(p.record["F_dev"][i], F_max * (1 - std::exp(-beta_F * e)), 1e-11);
    }
  }
}

TEST(Reduced, FormsAgreeAtConstantVolumeThroughReversals) {
  const std::string cycle =
      R"({"start": {"nu": 0.695, "P": 0.017, "sigma_dev": 0.0005, "F_dev": -0.02}, "segments": [
      {"mode": "d2", "amount": 0.03}, {"mode": "d2", "amount": -0.05}, {"mode": "relax"}, {"mode": "d2", "amount": -0.01},
      {"mode": "d2", "amount": 0.2}]})";
  const Prediction closed = walk(cycle, Form::reduced_closed), rates = walk(cycle, Form::reduced);
  EXPECT_GT(rates.record.rows(), 80U);
  for (const char* column : {"P", "sigma_dev", "s_dev", "F_dev"})
    EXPECT_LT(difference(closed, rates, column), 1e-10) << column;
}

TEST(Reduced, FormsDifferWhereVolumeMoves) {
  EXPECT_NEAR(last(walk(uni, Form::reduced_closed), "F_dev"), 0.057, 5e-4);
  EXPECT_NEAR(last(walk(uni, Form::reduced), "F_dev"), 0.077, 5e-4);
}

TEST(Reduced, PressureIsThePressureLaw) {
  const ContactCurve contacts{6, 8.2720, 0.5814, 0.6646, 0.1216, 15.8950};
  const PressureCurve law{contacts, 0.04172, 0.06228, 0.6649};
  const Prediction p = walk(uni, Form::reduced);
  for (std::size_t i = 0; i < p.record.rows(); ++i)
    EXPECT_DOUBLE_EQ(p.record["P"][i], pressure(law, p.record["nu"][i]));
}

TEST(Reduced, RateFormAgainstAnIndependentIntegration) {
  // d/d eps_dev along UNI, where d ln nu = d eps_dev.
  using Vector = std::vector<double>;
  const auto rates = [](const Vector& y, Vector& dy, double e) {
    const double nu = 0.671 * std::exp(e);
    dy[0] = table_2_2(30.76, 57, 16.86, nu) * (table_2_2(0.1137, 0.09166, 7.916, nu) - y[0]);
    dy[1] = table_2_2(0, 57.89, 5.366, nu) * (table_2_2(0, 0.1694, 4.562, nu) - y[1]);
  };
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Vector>>(1e-14, 1e-14);
  const Prediction p = walk(uni, Form::reduced);
  Vector y{0, 0};
  double e = 0;
  for (std::size_t i = 0; i < p.record.rows(); ++i) {
    const double to = p.record["eps_dev"][i];
    if (to > e) odeint::integrate_adaptive(stepper, rates, y, e, to, 1e-4);
    e = to;
    EXPECT_NEAR(p.record["s_dev"][i], y[0], 1e-9);
    EXPECT_NEAR(p.record["F_dev"][i], y[1], 1e-9);
  }
}

TEST(Reduced, IsotropicStretchesKeepTheAnisotropy) {
  const std::string path = R"({"start": {"nu": 0.711}, "segments": [
      {"mode": "d2", "amount": 0.05}, {"mode": "iso", "controls": {"nu": 0.75}}]})";
  for (const Form form : {Form::reduced_closed, Form::reduced}) {
    const Prediction p = walk(path, form, 1);
    EXPECT_NEAR(p.record["s_dev"][2], p.record["s_dev"][1], 1e-12);
    EXPECT_NEAR(p.record["F_dev"][2], p.record["F_dev"][1], 1e-12);
    EXPECT_GT(p.record["P"][2], 1.5 * p.record["P"][1]);
  }
}

TEST(Reduced, Jacobian) {
  const Reduced law{laws_of(thesis(), Form::reduced)};
  const Stretch stretch{0.7, 0.1, -0.3};
  std::array<double, 2> y{0.1, 0.05}, up{}, base{};
  std::array<double, 4> J{};
  ASSERT_TRUE(jacobian_of(law, stretch, {}, 0.4, y.data(), J.data()));
  ASSERT_TRUE(rate_at(law, stretch, {}, 0.4, y.data(), base.data()));
  for (std::size_t j = 0; j < 2; ++j) {  // linear: exact for any step
    auto moved = y;
    moved[j] += 0.125;
    ASSERT_TRUE(rate_at(law, stretch, {}, 0.4, moved.data(), up.data()));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(J[i + 2 * j], (up[i] - base[i]) / 0.125, 1e-12);
  }
}

}  // namespace
}  // namespace grainlaw::model
