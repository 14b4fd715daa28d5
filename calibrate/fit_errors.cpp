#include "grainlaw/calibrate/fit_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace grainlaw::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Applies `block` to the rows of each run.
template <class Block>
MatrixXd by_runs(const MatrixXd& v, const std::vector<std::size_t>& run_lengths, Block block) {
  MatrixXd out(v.rows(), v.cols());
  Index begin = 0;
  for (const std::size_t length : run_lengths) {
    const auto n = static_cast<Index>(length);
    out.middleRows(begin, n) = block(MatrixXd(v.middleRows(begin, n)));
    begin += n;
  }
  return out;
}

/// R v with R_ij = rho^|i-j| within each run, by one sweep in each direction.
MatrixXd correlate(const MatrixXd& v, double rho, const std::vector<std::size_t>& run_lengths) {
  return by_runs(v, run_lengths, [rho](const MatrixXd& b) -> MatrixXd {
    MatrixXd forward = b, backward = b;
    for (Index i = 1; i < b.rows(); ++i) forward.row(i) += rho * forward.row(i - 1);
    for (Index i = b.rows() - 2; i >= 0; --i) backward.row(i) += rho * backward.row(i + 1);
    return forward + backward - b;
  });
}

/// The symmetric half-sum of both neighbours, so that r' L r = sum r_i r_(i+1).
MatrixXd neighbours(const MatrixXd& v, const std::vector<std::size_t>& run_lengths) {
  return by_runs(v, run_lengths, [](const MatrixXd& b) -> MatrixXd {
    MatrixXd out = MatrixXd::Zero(b.rows(), b.cols());
    out.topRows(b.rows() - 1) += 0.5 * b.bottomRows(b.rows() - 1);
    out.bottomRows(b.rows() - 1) += 0.5 * b.topRows(b.rows() - 1);
    return out;
  });
}

/// Moments of the residuals r = M e, M = I - QQ', when e has the correlation R(rho) and unit variance.
struct Moments {
  double square;       ///< E r'r = tr(M R)
  double lag;          ///< E sum r_i r_(i+1)
  double square_of_R;  ///< tr((M R)^2), for the degrees of freedom
};

Moments moments(const MatrixXd& q, double rho, const std::vector<std::size_t>& run_lengths) {
  const MatrixXd rq = correlate(q, rho, run_lengths);
  const MatrixXd lq = neighbours(q, run_lengths);
  const MatrixXd qrq = q.transpose() * rq;
  double rows = 0, pairs = 0, squares = 0;
  for (const std::size_t length : run_lengths) {
    const auto n = static_cast<double>(length);
    rows += n;
    pairs += n - 1;
    squares += n;
    double power = 1;  // rho^(2 lag)
    for (double lag = 1; lag < n && power > 1e-18; ++lag) {
      power *= rho * rho;
      squares += 2 * (n - lag) * power;
    }
  }
  return {rows - qrq.trace(),
          pairs * rho - 2 * rq.cwiseProduct(lq).sum() + (qrq * (q.transpose() * lq)).trace(),
          squares - 2 * rq.squaredNorm() + (qrq * qrq).trace()};
}

/// The lag-1 correlation whose expected residual ratio is the observed one, between -1/2 and `limit`.
double matched_correlation(const MatrixXd& q, double observed, double limit,
                           const std::vector<std::size_t>& run_lengths) {
  const auto excess = [&](double rho) {
    const Moments m = moments(q, rho, run_lengths);
    return m.lag / m.square - observed;
  };
  double low = -0.5, high = limit;
  if (!(high > low) || excess(low) >= 0) return low;
  if (excess(high) <= 0) return high;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

double effective_points(double rho, const std::vector<std::size_t>& run_lengths) {
  double sum = 0;
  for (const std::size_t length : run_lengths) {
    const auto n = static_cast<double>(length);
    double inflation = 1;
    double power = 1;
    for (double lag = 1; lag < n && std::abs(power) > 1e-18; ++lag) {
      power *= rho;
      inflation += 2 * (1 - lag / n) * power;
    }
    sum += n / std::max(inflation, 1 / n);
  }
  return sum;
}

/// Continued fraction of the incomplete beta function (Lentz).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  double c = 1, d = 1 / std::max(std::abs(1 - (a + b) * x / (a + 1)), tiny);
  if (1 - (a + b) * x / (a + 1) < 0) d = -d;
  double h = d;
  for (int m = 1; m <= 500; ++m) {
    for (const bool even : {true, false}) {
      const double k = even ? m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
                            : -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
      d = 1 + k * d;
      c = 1 + k / c;
      if (std::abs(d) < tiny) d = tiny;
      if (std::abs(c) < tiny) c = tiny;
      d = 1 / d;
      h *= d * c;
    }
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return h;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

}  // namespace

CorrelatedErrors correlated_errors(const MatrixXd& jacobian, const VectorXd& residuals,
                                   const std::vector<std::size_t>& run_lengths) {
  const Index rows = jacobian.rows(), columns = jacobian.cols();
  const Eigen::HouseholderQR<MatrixXd> qr(jacobian);
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(rows, columns);
  // Below this many independent points, the residuals cannot tell the noise from the law.
  const double fewest = static_cast<double>(columns) + 1;
  const double n = static_cast<double>(rows);
  const double limit = std::max(0.0, (n - fewest) / (n + fewest));

  CorrelatedErrors out;
  const double sum = residuals.squaredNorm();
  const double lag = residuals.dot(neighbours(residuals, run_lengths).col(0));
  out.correlation = sum > 0 ? matched_correlation(q, lag / sum, limit, run_lengths) : 0;
  out.at_limit = out.correlation >= limit;
  const Moments m = moments(q, out.correlation, run_lengths);
  const double variance = sum / m.square;
  out.degrees_of_freedom = m.square * m.square / m.square_of_R;
  out.n_effective = std::min(n, effective_points(out.correlation, run_lengths));
  // With J = Q T: A J' R J A = T^-1 (Q' R Q) T^-T.
  const MatrixXd t = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  const MatrixXd inverse = t.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(columns, columns));
  const MatrixXd middle = q.transpose() * correlate(q, out.correlation, run_lengths);
  out.covariance = variance * inverse * middle * inverse.transpose();
  return out;
}

SeriesMean mean_of_series(const std::vector<double>& values) {
  SeriesMean out;
  const auto n = static_cast<Index>(values.size());
  if (n == 0) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), 0};
  const Eigen::Map<const VectorXd> y(values.data(), n);
  out.mean = y.mean();
  out.error = std::numeric_limits<double>::quiet_NaN();
  out.n_effective = static_cast<double>(n);
  if (n < 3) return out;
  const VectorXd residuals = y.array() - out.mean;
  const CorrelatedErrors e = correlated_errors(MatrixXd::Ones(n, 1), residuals, {values.size()});
  out.error = std::sqrt(e.covariance(0, 0));
  out.n_effective = e.n_effective;
  return out;
}

double student_t_probability(double t, double dof) {
  return 1 - incomplete_beta(0.5 * dof, 0.5, dof / (dof + t * t));
}

double student_t_quantile(double probability, double dof) {
  double low = 0, high = 1;
  while (student_t_probability(high, dof) < probability && high < 1e12) high *= 2;
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (student_t_probability(middle, dof) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace grainlaw::calibrate
