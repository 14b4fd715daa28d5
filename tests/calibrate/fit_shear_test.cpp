#include "grainlaw/calibrate/fit_shear.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fit_noise.hpp"
#include "grainlaw/model/laws/saturation.hpp"

namespace grainlaw::calibrate {
namespace {

/// Table 2.2 at nu_c = 0.6653.
struct Row {
  ShearQuantity quantity;
  double Q_max, Q_v, alpha;
};
constexpr double nu_c = 0.6653;
constexpr Row table[] = {{ShearQuantity::s_max, 0.1137, 0.09166, 7.916},
                         {ShearQuantity::beta_s, 30.76, 57.00, 16.86},
                         {ShearQuantity::F_max, 0, 0.1694, 4.562},
                         {ShearQuantity::beta_F, 0, 57.89, 5.366}};

double value_of(const Row& row, double nu) {
  return model::saturation(model::Saturation{row.Q_max, row.Q_v, row.alpha, nu_c}, nu);
}

/// The D2 test of the thesis at nu: s_dev or F_dev over strain up to 0.4, as 2.17 and 2.18 have it.
ShearCurve curve_at(double nu, bool stress, double initial, int rows = 100) {
  const double saturated = value_of(table[stress ? 0 : 2], nu), beta = value_of(table[stress ? 1 : 3], nu);
  ShearCurve curve{"d2", "1", nu, {}, {}};
  for (int i = 0; i < rows; ++i) {
    const double strain = 0.4 * i / (rows - 1);
    curve.strain.push_back(strain);
    curve.value.push_back(model::approach(saturated, initial, beta, strain));
  }
  return curve;
}

TEST(ShearFits, ReturnTheThesisCurvesFromNoiseFreeData) {
  for (const double nu : {0.671, 0.695, 0.711, 0.728, 0.75, 0.80}) {
    for (const bool stress : {true, false}) {
      const FitResult r = fit_approach(curve_at(nu, stress, 0.013));
      const double saturated = value_of(table[stress ? 0 : 2], nu),
                   beta = value_of(table[stress ? 1 : 3], nu);
      EXPECT_NEAR(r.value("max"), saturated, 1e-6 * saturated);
      EXPECT_NEAR(r.value("beta"), beta, 1e-6 * beta);
      EXPECT_NEAR(r.value("initial"), 0.013, 1e-8);
      EXPECT_TRUE(r.determined());
    }
  }
}

TEST(ShearFits, ReturnTable22FromNoiseFreeData) {
  for (const Row& row : table) {
    SCOPED_TRACE(name_of(row.quantity));
    std::vector<RunValue> values;
    for (const double nu : {0.671, 0.695, 0.711, 0.728, 0.75, 0.80}) {
      values.push_back({"d2", "1", nu, value_of(row, nu), 0});
    }
    const FitResult r = fit(density_problem(row.quantity, values, nu_c, 0, {}));
    EXPECT_NEAR(r.value("Q_max"), row.Q_max, 1e-6 * std::max(row.Q_max, 1e-3));
    EXPECT_NEAR(r.value("Q_v"), row.Q_v, 1e-6 * row.Q_v);
    EXPECT_NEAR(r.value("alpha"), row.alpha, 1e-6 * row.alpha);
    EXPECT_TRUE(r.determined());
    EXPECT_GT(r.starts, 1);
    EXPECT_GE(r.best_found, 1);
  }
}

constexpr int replicates = 400;

void expect_coverage_of_curve(bool stress, double nu, double correlation, double allowance) {
  const ShearCurve clean = curve_at(nu, stress, 0);
  Noise noise(21);
  Coverage saturated, beta;
  for (int i = 0; i < replicates; ++i) {
    ShearCurve curve = clean;
    const std::vector<double> z = noise.series(curve.value.size(), correlation);
    for (std::size_t k = 0; k < z.size(); ++k) curve.value[k] += 0.01 * z[k];
    const FitResult r = fit(few_starts(approach_problem(curve)));
    saturated.count(r, "max", value_of(table[stress ? 0 : 2], nu));
    beta.count(r, "beta", value_of(table[stress ? 1 : 3], nu));
  }
  saturated.expect_as_claimed("max", allowance);
  beta.expect_as_claimed("beta", allowance);
}

TEST(ShearFits, ErrorsOfStressRatioCoverTheTruth) {
  expect_coverage_of_curve(true, 0.711, 0, 0);
  expect_coverage_of_curve(true, 0.711, 0.7, 0.02);
}

TEST(ShearFits, ErrorsOfFabricCoverTheTruth) {
  expect_coverage_of_curve(false, 0.75, 0, 0);
  expect_coverage_of_curve(false, 0.75, 0.7, 0.02);
}

TEST(ShearFits, ErrorsOverDensityCoverTheTruth) {
  // Three runs at each of six densities: an error of their own, known to 20 %, and a scatter between runs
  // that nobody knows. Small enough for the law to be linear over the interval, which is where a standard
  // error means something.
  for (const Row& row : table) {
    SCOPED_TRACE(name_of(row.quantity));
    Noise noise(22);
    Coverage Q_v, alpha, Q_max;
    const double between = 0.007 * value_of(row, 0.72);
    for (int i = 0; i < replicates; ++i) {
      std::vector<RunValue> values;
      for (const double nu : {0.671, 0.685, 0.70, 0.72, 0.75, 0.80}) {
        for (int run = 0; run < 3; ++run) {
          const double truth = value_of(row, nu), own = 0.007 * truth;
          values.push_back({"d2", std::to_string(run), nu, truth + own * noise.one() + between * noise.one(),
                            own * std::exp(0.2 * noise.one())});
        }
      }
      const FitResult r = fit(few_starts(density_problem(row.quantity, values, nu_c, 0, {})));
      Q_v.count(r, "Q_v", row.Q_v);
      alpha.count(r, "alpha", row.alpha);
      if (row.Q_max > 0) Q_max.count(r, "Q_max", row.Q_max);
    }
    Q_v.expect_as_claimed("Q_v");
    alpha.expect_as_claimed("alpha");
    if (row.Q_max > 0) Q_max.expect_as_claimed("Q_max");
  }
}

TEST(ShearFits, TwoDensitiesHoldAlphaAtWhatIsKnown) {
  const Row& row = table[0];
  std::vector<RunValue> values;
  for (const double nu : {0.70, 0.7004, 0.75}) values.push_back({"d2", "1", nu, value_of(row, nu), 0});
  const FitResult r = fit(density_problem(row.quantity, values, nu_c, 0,
                                          {{"Q_max", 0.1137}, {"Q_v", 0.09166}, {"alpha", 7.916}}));
  EXPECT_FALSE(r["alpha"].determined);
  EXPECT_EQ(r.value("alpha"), 7.916);
  EXPECT_NE(r["alpha"].reason.find("2 different x for 3 parameters"), std::string::npos) << r["alpha"].reason;
  EXPECT_NEAR(r.value("Q_max"), row.Q_max, 1e-6);
  EXPECT_NEAR(r.value("Q_v"), row.Q_v, 1e-6);
}

TEST(ShearFits, AStraightTrendPressesTheLimitAgainstZero) {
  // On a line, the best exponential decays slowly towards a limit as low as is allowed; the fit must say that
  // this is no measurement of the limit.
  Noise noise(23);
  std::vector<RunValue> values;
  for (int i = 0; i < 8; ++i) {
    const double nu = 0.68 + 0.015 * i;
    values.push_back({"d2", "1", nu, 0.2 - 0.5 * (nu - 0.68) + 0.002 * noise.one(), 0.002});
  }
  const FitResult r = fit(density_problem(ShearQuantity::s_max, values, nu_c, 0, {}));
  EXPECT_TRUE(r["Q_max"].at_bound);
  EXPECT_NEAR(r.value("Q_max"), 0, 1e-6);
  EXPECT_FALSE(r["Q_max"].stderr_);
  EXPECT_TRUE(r["alpha"].determined);
}

TEST(ShearFits, AFitThatRestsOnABoundIsStillAtItsMinimum) {
  // With Q_max on its bound 0, the other two must be those of the law without Q_max, from every start.
  const double nu[] = {0.67, 0.68, 0.70, 0.72, 0.75, 0.78, 0.81},
               beta[] = {76.4, 44.2, 70.3, 62.7, 45.9, 23.2, 25.9};
  std::vector<RunValue> values;
  for (int i = 0; i < 7; ++i) values.push_back({"d2", "1", nu[i], beta[i], 1});
  const FitResult stress = fit(density_problem(ShearQuantity::beta_s, values, nu_c, 0, {}));
  const FitResult fabric =
      fit(density_problem(ShearQuantity::beta_F, values, nu_c, 0, {}));  // Q_max is held at 0
  EXPECT_TRUE(stress["Q_max"].at_bound);
  EXPECT_EQ(stress.value("Q_max"), 0);
  EXPECT_NEAR(stress.value("Q_v"), fabric.value("Q_v"), 1e-5 * fabric.value("Q_v"));
  EXPECT_NEAR(stress.value("alpha"), fabric.value("alpha"), 1e-5 * fabric.value("alpha"));
  EXPECT_EQ(stress.best_found, stress.starts);
}

TEST(ShearFits, ScatterAsLargeAsTheTrendLeavesTheExponentialOpen) {
  Noise noise(25);
  std::vector<RunValue> values;
  for (int i = 0; i < 6; ++i) {
    const double nu = 0.68 + 0.02 * i;
    values.push_back({"d2", "1", nu, value_of(table[0], nu) + 0.03 * noise.one(), 0.03});
  }
  const FitResult open = fit(density_problem(ShearQuantity::s_max, values, nu_c, 0, {}));
  EXPECT_FALSE(open.determined());
  const KnownValues thesis{{"Q_max", 0.1137}, {"Q_v", 0.09166}, {"alpha", 7.916}};
  const FitResult held = fit(density_problem(ShearQuantity::s_max, values, nu_c, 0, thesis));
  EXPECT_EQ(held.value("alpha"), 7.916);
  EXPECT_FALSE(held["alpha"].reason.empty());
  EXPECT_TRUE(held["Q_max"].determined) << "the rest goes on";
}

TEST(ShearFits, ATestThatStopsTooSoonDoesNotDetermineItsSaturation) {
  ShearCurve curve = curve_at(0.75, true, 0);
  Noise noise(24);
  curve.strain.resize(6);
  curve.value.resize(6);
  for (std::size_t i = 0; i < 6; ++i) {
    curve.strain[i] = 1e-4 * static_cast<double>(i);
    curve.value[i] = 5 * curve.strain[i] + 1e-4 * noise.one();
  }
  const FitResult r = fit_approach(curve);
  EXPECT_FALSE(r["max"].determined);
  EXPECT_FALSE(r["max"].reason.empty());
}

TEST(ShearFits, ARateWhoseErrorExceedsItIsNotDetermined) {
  // A rise no larger than the noise: the error of its rate is below 100, and beyond the rate.
  ShearCurve curve{"d2", "1", 0.75, {}, {}};
  for (int i = 0; i < 60; ++i) {
    curve.strain.push_back(0.4 * i / 59);
    curve.value.push_back(model::approach(0.15, 0.14, 40, curve.strain.back()) +
                          (i / 3 % 2 == 0 ? -0.01 : 0.01));
  }
  const FitEstimate beta = fit_approach(curve)["beta"];
  EXPECT_FALSE(beta.determined) << beta.value << " +- " << beta.stderr_.value_or(0);
  EXPECT_NE(beta.reason.find("exceeds its value"), std::string::npos) << beta.reason;
}

TEST(ShearFits, TheErrorOfAValueThatAlphaIsHeldAtGoesIntoTheOthers) {
  const Row& row = table[0];
  std::vector<RunValue> values;
  for (const double nu : {0.70, 0.7004, 0.75}) values.push_back({"d2", "1", nu, value_of(row, nu), 0});
  const auto error_of = [&](double alpha_error) {
    const KnownValues known{{"Q_max", 0.1137}, {"Q_v", 0.09166}, {"alpha", {7.916, alpha_error}}};
    const FitResult r = fit(density_problem(row.quantity, values, nu_c, 0, known));
    EXPECT_EQ(r["alpha"].stderr_.value_or(0), alpha_error);
    return *r["Q_v"].stderr_;
  };
  EXPECT_LT(error_of(0), 1e-6);
  EXPECT_GT(error_of(0.5), 1e-3);
}

TEST(ShearFits, TrendSaysWhetherValuesFallWithoutAnyLaw) {
  std::vector<RunValue> values;
  for (const double nu : {0.68, 0.70, 0.72, 0.75})
    values.push_back({"d2", "1", nu, 0.2 - 0.5 * (nu - 0.7), 0.001});
  const Trend falls = trend_of(values);
  EXPECT_TRUE(falls.known);
  EXPECT_NEAR(falls.slope, -0.5, 1e-8);
  EXPECT_LT(falls.slope + 2 * falls.error, 0);
  values.resize(2);
  EXPECT_FALSE(trend_of(values).known);
}

}  // namespace
}  // namespace grainlaw::calibrate
