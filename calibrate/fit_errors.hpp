// Standard errors of least squares when successive residuals are correlated, and Student's t.
// Internal to the fits (needs Eigen).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace grainlaw::calibrate {

/// Errors of a least squares fit whose residuals follow a first-order autoregressive process within each run
/// and are independent between runs.
struct CorrelatedErrors {
  Eigen::MatrixXd covariance;     ///< of the parameters
  double correlation = 0;         ///< of successive residuals
  bool at_limit = false;          ///< correlated over so much of a run that the errors are a lower bound
  double n_effective = 0;         ///< N/N_eff = 1 + 2 sum over the lags of the autocorrelation
  double degrees_of_freedom = 0;  ///< of the residual variance (Satterthwaite)
};

/// `jacobian` (rows x parameters, of full column rank) and `residuals` at the minimum; `run_lengths` sum to
/// the number of rows. The correlation is chosen such that the expected lag-1 ratio of the residuals, which
/// the fit itself lowers, equals the observed one; covariance = A J' S J A with A = (J'J)^-1 and S the
/// covariance of that process. For slowly varying columns of J this is the inflation by N/N_eff.
CorrelatedErrors correlated_errors(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals,
                                   const std::vector<std::size_t>& run_lengths);

/// Mean of successive values of one run, and its standard error by the same estimator. The error is NaN for
/// fewer than three.
struct SeriesMean {
  double mean = 0, error = 0, n_effective = 0;
};
SeriesMean mean_of_series(const std::vector<double>& values);

/// P(|T| <= t) of Student's t distribution, and the t for which it equals `probability`. dof > 0, not
/// necessarily whole.
double student_t_probability(double t, double dof);
double student_t_quantile(double probability, double dof);

}  // namespace grainlaw::calibrate
