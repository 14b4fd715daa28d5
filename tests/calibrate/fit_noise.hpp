// For the tests of the fits: reproducible noise, and counting how often a stated interval covers the truth.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_errors.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// Stationary first-order autoregressive noise of unit variance; correlation 0 is white noise.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_(seed) {}
  std::vector<double> series(std::size_t n, double correlation) {
    std::vector<double> out;
    double now = normal_(generator_);
    for (std::size_t i = 0; i < n; ++i) {
      out.push_back(now);
      now = correlation * now + std::sqrt(1 - correlation * correlation) * normal_(generator_);
    }
    return out;
  }
  double one() { return normal_(generator_); }

 private:
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
};

/// Coverage is about errors; that several starts find the minimum is tested elsewhere.
inline FitProblem few_starts(FitProblem problem) {
  problem.starts = 2;
  return problem;
}

/// How often value +- stderr and interval95 hold the truth, over many fits.
class Coverage {
 public:
  void count(const FitResult& result, const std::string& parameter, double truth) {
    const FitEstimate& e = result[parameter];
    ++fits_;
    if (!e.stderr_ || !e.determined) return;
    within_one_ += std::abs(e.value - truth) <= *e.stderr_ ? 1 : 0;
    within_95_ += e.interval95->first <= truth && truth <= e.interval95->second ? 1 : 0;
    claimed_one_ += student_t_probability(1, result.degrees_of_freedom);
  }

  /// Both fractions must be what is claimed, to three standard deviations of the binomial distribution plus
  /// `allowance`: what is known to be lost to the estimate of the correlation itself.
  void expect_as_claimed(const std::string& name, double allowance = 0) const {
    const double n = fits_, one = claimed_one_ / n;
    EXPECT_NEAR(within_one_ / n, one, 3 * std::sqrt(one * (1 - one) / n) + allowance)
        << name << ", one stderr";
    EXPECT_NEAR(within_95_ / n, 0.95, 3 * std::sqrt(0.95 * 0.05 / n) + allowance) << name << ", 95 %";
  }

 private:
  double fits_ = 0, within_one_ = 0, within_95_ = 0, claimed_one_ = 0;
};

}  // namespace grainlaw::calibrate
