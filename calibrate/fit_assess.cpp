#include "grainlaw/calibrate/fit_assess.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "grainlaw/calibrate/fit_errors.hpp"
#include "grainlaw/calibrate/fit_minimise.hpp"
#include "grainlaw/calibrate/fit_scatter.hpp"

namespace grainlaw::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Singular values below this fraction of the largest are zero to rounding.
constexpr double null_fraction = 1e-9;
/// A parameter takes part in a singular direction from this component on.
constexpr double takes_part = 0.1;

/// Weighted residuals and their Jacobian by all parameters, columns multiplied by the parameters' scales.
struct Linearised {
  VectorXd residuals;
  MatrixXd jacobian;
};

Linearised linearise(const FitProblem& problem, const std::vector<double>& p,
                     const std::vector<double>& weights) {
  const std::vector<FitPoint> points = all_points(problem);
  const auto n = static_cast<Index>(points.size()), m = static_cast<Index>(p.size());
  Linearised out{VectorXd(n), MatrixXd(n, m)};
  std::vector<double> gradient(p.size());
  for (Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    out.residuals[i] = weights[row] * (problem.law(p, points[row], gradient) - points[row].y);
    for (Index k = 0; k < m; ++k) {
      const auto column = static_cast<std::size_t>(k);
      out.jacobian(i, k) = weights[row] * gradient[column] * problem.parameters[column].scale;
    }
  }
  return out;
}

/// Weights 1/sqrt(error^2 + extra^2), or 1 where any error is unknown.
std::vector<double> weights_of(const std::vector<FitPoint>& points, double extra) {
  std::vector<double> weights;
  for (const FitPoint& p : points) weights.push_back(1 / std::hypot(p.error, extra));
  return weights;
}

bool all_errors_known(const std::vector<FitPoint>& points) {
  return std::all_of(points.begin(), points.end(), [](const FitPoint& p) { return p.error > 0; });
}

struct Weighted {
  Minimum minimum;
  std::vector<double> weights;
  double extra = 0;
};

/// Every row counts the same.
Weighted minimise_rows(const FitProblem& problem, const std::vector<std::size_t>& free,
                       const std::vector<double>& start) {
  Weighted out;
  out.weights.assign(all_points(problem).size(), 1.0);
  out.minimum = minimise(problem, free, out.weights, start);
  return out;
}

/// Independent points of known error: the scatter between runs beyond these errors is the one with which the
/// sum of squares equals the degrees of freedom (Paule and Mandel), so that no point counts for more than the
/// scatter allows.
Weighted minimise_runs(const FitProblem& problem, const std::vector<std::size_t>& free,
                       const std::vector<double>& start) {
  const std::vector<FitPoint> points = all_points(problem);
  Weighted out;
  if (!all_errors_known(points)) return minimise_rows(problem, free, start);
  const double dof = static_cast<double>(points.size()) - static_cast<double>(free.size());
  FitProblem again = problem;
  again.starts = 1;
  const auto run = [&](double extra, const FitProblem& with, const std::vector<double>& from) {
    out.extra = extra;
    out.weights = weights_of(points, extra);
    out.minimum = minimise(with, free, out.weights, from);
    return 2 * out.minimum.cost;
  };
  if (run(0, problem, start) <= dof) return out;
  double low = 0, high = 0;
  for (const FitPoint& p : points) high = std::max(high, p.error);
  while (run(high, again, out.minimum.values) > dof) high *= 2;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (run(middle, again, out.minimum.values) > dof ? low : high) = middle;
  }
  run(high, problem, out.minimum.values);  // all starts once more, with the final weights
  return out;
}

/// Covariance of the scaled free parameters, and what it rests on.
struct Errors {
  MatrixXd covariance;
  double degrees_of_freedom = 0;
  double n_effective = 0;
  std::string from;
};

Errors errors_of(const FitProblem& problem, const MatrixXd& jacobian, const VectorXd& residuals) {
  Errors out;
  const Index n = jacobian.rows(), m = jacobian.cols();
  if (problem.points == Points::rows) {
    std::vector<std::size_t> lengths;
    for (const FitSeries& series : problem.series) {
      if (!series.points.empty()) lengths.push_back(series.points.size());
    }
    const CorrelatedErrors e = correlated_errors(jacobian, residuals, lengths);
    out = {e.covariance, e.degrees_of_freedom, e.n_effective, "residual autocorrelation"};
    if (e.at_limit) out.from += " (a lower bound: the residuals are correlated over the whole run)";
    return out;
  }
  out.degrees_of_freedom = static_cast<double>(n - m);
  out.n_effective = static_cast<double>(n);
  out.from = "scatter over runs";
  const MatrixXd normal = jacobian.transpose() * jacobian;
  out.covariance =
      normal.ldlt().solve(MatrixXd::Identity(m, m)) * (residuals.squaredNorm() / out.degrees_of_freedom);
  return out;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Condition of the Jacobian; parameters that take part in a direction along which the data do not change are
/// not determined.
void judge_directions(const std::vector<std::size_t>& inner, const MatrixXd& jacobian, FitResult& result) {
  const Eigen::JacobiSVD<MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& s = svd.singularValues();
  const double smallest = s[s.size() - 1];
  result.condition = smallest > 0 ? s[0] / smallest : std::numeric_limits<double>::infinity();
  for (Index k = 0; k < s.size(); ++k) {
    if (s[k] > null_fraction * s[0]) continue;
    for (std::size_t j = 0; j < inner.size(); ++j) {
      if (std::abs(svd.matrixV()(static_cast<Index>(j), k)) < takes_part) continue;
      FitEstimate& e = result.parameters[inner[j]];
      e.determined = false;
      e.reason = "the data do not change along a direction in which this parameter takes part";
    }
  }
}

/// Columns of `jacobian` that belong to the parameters `wanted`.
MatrixXd columns_of(const MatrixXd& jacobian, const std::vector<std::size_t>& wanted) {
  MatrixXd out(jacobian.rows(), static_cast<Index>(wanted.size()));
  for (std::size_t j = 0; j < wanted.size(); ++j) {
    out.col(static_cast<Index>(j)) = jacobian.col(static_cast<Index>(wanted[j]));
  }
  return out;
}

/// What the errors of the held parameters add to the variance of each free (scaled) one: -(J'J)^-1 J'J_held
/// error.
VectorXd variance_from_held(const FitProblem& problem, const MatrixXd& all, const MatrixXd& inner) {
  VectorXd variance = VectorXd::Zero(inner.cols());
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(inner);
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitParameter& p = problem.parameters[i];
    if (!p.held || p.held_error == 0) continue;
    const VectorXd shift = qr.solve(all.col(static_cast<Index>(i)) * (p.held_error / p.scale));
    variance += shift.cwiseAbs2();
  }
  return variance;
}

/// Its standard error, interval, and whether that is small enough.
void attach_error(const FitParameter& p, double error, double t, FitEstimate& e) {
  e.stderr_ = error;
  e.interval95 = std::pair(e.value - t * error, e.value + t * error);
  const double size = p.judged_by_value ? std::abs(e.value) : p.scale;
  if (error <= size) return;
  e.determined = false;
  e.reason = "its standard error, " + rounded(error) + ", exceeds its " +
             (p.judged_by_value ? "value, " : "natural size, ") + rounded(size);
}

/// Standard errors and intervals of the parameters `inner`, those that are free, off their bounds and not
/// singular.
void attach_errors(const FitProblem& problem, const std::vector<std::size_t>& inner, const Linearised& at,
                   FitResult& result) {
  if (inner.empty()) return;
  const MatrixXd jacobian = columns_of(at.jacobian, inner);
  const Errors errors = errors_of(problem, jacobian, at.residuals);
  result.stderr_from = errors.from;
  result.n_effective = errors.n_effective;
  result.degrees_of_freedom = errors.degrees_of_freedom;
  VectorXd variance = errors.covariance.diagonal();
  const Scatter scatter = scatter_over_groups(problem, free_parameters(problem), result.values());
  if (!scatter.errors.empty()) {
    result.stderr_from = "scatter over seeds";
    if (!scatter.clipped.empty())
      result.stderr_from += " (a lower bound; at bounds: " + scatter.clipped + ")";
    result.degrees_of_freedom = static_cast<double>(scatter.groups - 1);
    for (std::size_t j = 0; j < inner.size(); ++j) {
      const double error = scatter.errors[inner[j]] / problem.parameters[inner[j]].scale;
      variance[static_cast<Index>(j)] = error * error;
    }
  }
  variance += variance_from_held(problem, at.jacobian, jacobian);
  const double t = student_t_quantile(0.95, std::max(result.degrees_of_freedom, 0.1));
  for (std::size_t j = 0; j < inner.size(); ++j) {
    const FitParameter& p = problem.parameters[inner[j]];
    FitEstimate& e = result.parameters[inner[j]];
    attach_error(p, std::sqrt(variance[static_cast<Index>(j)]) * p.scale, t, e);
  }
}

double root_mean_square(const FitProblem& problem, const std::vector<double>& p) {
  double sum = 0, n = 0;
  for (const FitPoint& point : all_points(problem)) {
    const double residual = problem.law(p, point, {}) - point.y;
    sum += residual * residual;
    n += 1;
  }
  return std::sqrt(sum / n);
}

/// Names, values and bounds; returns the free parameters that do not rest on a bound.
std::vector<std::size_t> estimates_of(const FitProblem& problem, const Minimum& minimum, FitResult& result) {
  std::vector<std::size_t> inner;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const FitParameter& p = problem.parameters[i];
    FitEstimate e;
    e.name = p.name;
    e.unit = p.unit;
    e.value = minimum.values[i];
    e.held = p.held;
    if (p.held && p.held_error > 0) e.stderr_ = p.held_error;
    const bool low = at_low(p, e.value), high = at_high(p, e.value);
    e.at_bound = !p.held && (low || high);
    e.determined = !e.at_bound || (low && p.low_is_natural);
    if (!e.determined) e.reason = "the fit runs into its bound " + rounded(low ? p.low : p.high);
    if (!p.held && !e.at_bound) inner.push_back(i);
    result.parameters.push_back(e);
  }
  return inner;
}

/// The same for each of the parameters `free` in its own unit; zeros where nothing is held with an error.
std::vector<double> errors_from_held(const FitProblem& problem, const std::vector<std::size_t>& free,
                                     const std::vector<double>& values) {
  std::vector<double> errors(free.size(), 0.0);
  if (std::none_of(problem.parameters.begin(), problem.parameters.end(),
                   [](const FitParameter& p) { return p.held && p.held_error > 0; }))
    return errors;
  const Linearised at = linearise(problem, values, std::vector<double>(all_points(problem).size(), 1.0));
  const VectorXd variance = variance_from_held(problem, at.jacobian, columns_of(at.jacobian, free));
  for (std::size_t j = 0; j < free.size(); ++j)
    errors[j] = std::sqrt(variance[static_cast<Index>(j)]) * problem.parameters[free[j]].scale;
  return errors;
}

/// The result of several packings: the mean of what each says.
FitResult result_of_mean(const FitProblem& problem, const std::vector<std::size_t>& free,
                         const GroupMean& mean, const Minimum& pooled) {
  FitResult result;
  result.ran = true;
  result.n = all_points(problem).size();
  result.rms = mean.rms;
  result.condition = mean.condition;
  result.n_effective = mean.n_effective;
  result.degrees_of_freedom = static_cast<double>(mean.groups - 1);
  result.stderr_from = "scatter over seeds";
  result.starts = pooled.starts;
  result.best_found = pooled.best_found;
  result.exit =
      "converged for each of " + std::to_string(mean.groups) + " seeds alone; values are their weighted mean";
  if (!mean.left_out.empty()) result.exit += " (seed " + mean.left_out + " rests on a bound and is left out)";
  Minimum at = pooled;
  at.values = mean.values;
  FitProblem unbounded = problem;  // a mean may lie where the lowest row of all seeds would not let it
  for (const std::size_t i : free) {
    unbounded.parameters[i].low = -1e100;
    unbounded.parameters[i].high = 1e100;
  }
  estimates_of(unbounded, at, result);
  const double t = student_t_quantile(0.95, result.degrees_of_freedom);
  const std::vector<double> from_held = errors_from_held(problem, free, mean.values);
  for (std::size_t j = 0; j < free.size(); ++j)
    attach_error(problem.parameters[free[j]], std::hypot(mean.errors[free[j]], from_held[j]), t,
                 result.parameters[free[j]]);
  return result;
}

}  // namespace

std::vector<FitPoint> all_points(const FitProblem& problem) {
  std::vector<FitPoint> points;
  for (const FitSeries& series : problem.series) {
    points.insert(points.end(), series.points.begin(), series.points.end());
  }
  return points;
}

bool at_low(const FitParameter& p, double value) { return value <= p.low + 1e-7 * (p.high - p.low); }
bool at_high(const FitParameter& p, double value) { return value >= p.high - 1e-7 * (p.high - p.low); }

std::vector<std::size_t> free_parameters(const FitProblem& problem) {
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    if (!problem.parameters[i].held) free.push_back(i);
  }
  return free;
}

FitResult assess(const FitProblem& problem) {
  std::vector<double> start;
  for (const FitParameter& p : problem.parameters) start.push_back(p.initial);
  const std::vector<std::size_t> free = free_parameters(problem);
  const Weighted best = problem.points == Points::runs ? minimise_runs(problem, free, start)
                                                       : minimise_rows(problem, free, start);
  if (const auto mean = mean_over_groups(problem, free, best.minimum.values))
    return result_of_mean(problem, free, *mean, best.minimum);
  FitResult result;
  result.ran = true;
  result.n = best.weights.size();
  result.extra_scatter = best.extra;
  result.starts = best.minimum.starts;
  result.best_found = best.minimum.best_found;
  result.exit = best.minimum.exit;
  std::vector<std::size_t> inner = estimates_of(problem, best.minimum, result);
  result.rms = root_mean_square(problem, best.minimum.values);
  if (inner.empty()) return result;
  const Linearised at = linearise(problem, best.minimum.values, best.weights);
  judge_directions(inner, columns_of(at.jacobian, inner), result);
  std::erase_if(inner, [&](std::size_t i) { return !result.parameters[i].determined; });
  attach_errors(problem, inner, at, result);
  if (!best.minimum.converged) {
    for (const std::size_t i : free) {
      result.parameters[i].determined = false;
      result.parameters[i].reason = "the solver did not converge";
    }
  }
  return result;
}

}  // namespace grainlaw::calibrate
