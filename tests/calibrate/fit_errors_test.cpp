#include "grainlaw/calibrate/fit_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fit_noise.hpp"

namespace grainlaw::calibrate {
namespace {

TEST(StudentT, AgreesWithTheTables) {
  EXPECT_NEAR(student_t_quantile(0.95, 1), 12.7062047362, 1e-8);
  EXPECT_NEAR(student_t_quantile(0.95, 2), 4.30265272975, 1e-9);
  EXPECT_NEAR(student_t_quantile(0.95, 10), 2.22813885199, 1e-9);
  EXPECT_NEAR(student_t_quantile(0.95, 1e6), 1.959966, 1e-5);
  EXPECT_NEAR(student_t_probability(1, 1), 0.5, 1e-12);                 // 2/pi atan(1)
  EXPECT_NEAR(student_t_probability(1, 2), 1 / std::sqrt(3.0), 1e-12);  // t/sqrt(2 + t^2)
}

TEST(CorrelatedErrors, OfAMeanAreThoseOfTheProcess) {
  // Mean of n values of unit variance and correlation rho^k: variance (1/n)[1 + 2 sum (1 - k/n) rho^k].
  constexpr std::size_t n = 200;
  for (const double rho : {0.0, 0.5, 0.8}) {
    double truth = 1.0 / n;
    for (std::size_t k = 1; k < n; ++k) {
      const auto lag = static_cast<double>(k);
      truth += 2.0 / n * (1 - lag / n) * std::pow(rho, lag);
    }
    Noise noise(31);
    double variance = 0, correlation = 0, effective = 0;
    constexpr int repeats = 600;
    for (int i = 0; i < repeats; ++i) {
      const SeriesMean m = mean_of_series(noise.series(n, rho));
      variance += m.error * m.error / repeats;
      effective += m.n_effective / repeats;
      const std::vector<double> z = noise.series(n, rho);
      const Eigen::Map<const Eigen::VectorXd> y(z.data(), n);
      correlation +=
          correlated_errors(Eigen::MatrixXd::Ones(n, 1), y.array() - y.mean(), {n}).correlation / repeats;
    }
    EXPECT_NEAR(correlation, rho, 0.02);
    EXPECT_NEAR(variance / truth, 1, 0.15) << rho;
    EXPECT_NEAR(effective * truth, 1, 0.15) << rho;
  }
}

TEST(CorrelatedErrors, DoNotRunAcrossRuns) {
  // Two runs with offsets of their own have no correlation at the seam beyond what each has.
  Eigen::VectorXd residuals(8);
  residuals << 1, -1, 1, -1, -1, 1, -1, 1;
  const auto apart = correlated_errors(Eigen::MatrixXd::Ones(8, 1), residuals, {4, 4});
  const auto joined = correlated_errors(Eigen::MatrixXd::Ones(8, 1), residuals, {8});
  EXPECT_LT(apart.correlation, joined.correlation + 1e-12);
  EXPECT_DOUBLE_EQ(apart.n_effective, 8);
}

TEST(CorrelatedErrors, SayWhenARunIsOneLongCorrelation) {
  Eigen::VectorXd residuals(50);
  for (int i = 0; i < 50; ++i) residuals[i] = std::cos(0.063 * i);
  EXPECT_TRUE(correlated_errors(Eigen::MatrixXd::Ones(50, 1), residuals, {50}).at_limit);
}

TEST(MeanOfSeries, HasNoErrorForFewerThanThree) {
  EXPECT_DOUBLE_EQ(mean_of_series({1, 3}).mean, 2);
  EXPECT_TRUE(std::isnan(mean_of_series({1, 3}).error));
  EXPECT_TRUE(std::isnan(mean_of_series({}).mean));
}

}  // namespace
}  // namespace grainlaw::calibrate
