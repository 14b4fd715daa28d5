#include "grainlaw/calibrate/path_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/calibrate/fit_errors.hpp"

namespace grainlaw::calibrate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<std::size_t> others(std::size_t count, const std::set<std::size_t>& fixed) {
  std::vector<std::size_t> free;
  for (std::size_t k = 0; k < count; ++k)
    if (!fixed.contains(k)) free.push_back(k);
  return free;
}

MatrixXd columns(const MatrixXd& matrix, const std::vector<std::size_t>& which) {
  MatrixXd out(matrix.rows(), static_cast<Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i)
    out.col(static_cast<Index>(i)) = matrix.col(static_cast<Index>(which[i]));
  return out;
}

/// Where the rise passes 95 % between the best value and the far end of one side; along a parabola's arm its
/// root is linear.
std::optional<double> crossing(double best, const std::vector<double>& values,
                               const std::vector<double>& rises) {
  constexpr double level = 3.841458820694124;
  double before = best, root_before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(rises[i])) return std::nullopt;
    const double root = std::sqrt(std::max(rises[i], 0.0));
    if (rises[i] >= level)
      return before + (values[i] - before) * (std::sqrt(level) - root_before) / (root - root_before);
    before = values[i];
    root_before = root;
  }
  return std::nullopt;
}

}  // namespace

Blind blind_parameters(const PathProblem& problem, const MatrixXd& jacobian) {
  constexpr double nothing = 1e-6;
  const std::size_t count = problem.names().size();
  Blind blind{{}, std::vector<std::string>(count)};
  const double largest = jacobian.colwise().norm().maxCoeff();
  for (std::size_t k = 0; k < count; ++k) {
    if (jacobian.col(static_cast<Index>(k)).norm() > nothing * largest) continue;
    blind.numbers.insert(k);
    blind.reasons[k] = "the paths do not depend on it";
  }
  while (blind.numbers.size() < count) {
    const auto free = others(count, blind.numbers);
    MatrixXd scaled = columns(jacobian, free);
    for (Index i = 0; i < scaled.cols(); ++i) scaled.col(i).normalize();
    const Eigen::JacobiSVD<MatrixXd> svd(scaled, Eigen::ComputeThinV);
    if (svd.singularValues().tail(1)(0) > nothing * svd.singularValues()(0)) break;
    const VectorXd direction = svd.matrixV().rightCols(1).cwiseAbs();
    Index most = 0;
    direction.maxCoeff(&most);
    std::string partners;
    for (Index i = 0; i < direction.size(); ++i)
      if (i != most && direction(i) > 0.1 * direction(most))
        partners += (partners.empty() ? "" : ", ") + problem.names()[free[static_cast<std::size_t>(i)]];
    const std::size_t k = free[static_cast<std::size_t>(most)];
    blind.numbers.insert(k);
    blind.reasons[k] = "the paths tell only a combination of it with " + partners;
  }
  return blind;
}

PathErrors path_errors(const PathProblem& problem, const PathResiduals& at,
                       const std::set<std::size_t>& fixed) {
  const std::size_t count = problem.names().size();
  PathErrors out;
  out.errors.assign(count, 0);
  out.inflation.assign(count, 1);
  out.correlations = MatrixXd::Constant(static_cast<Index>(count), static_cast<Index>(count),
                                        std::numeric_limits<double>::quiet_NaN());
  const auto free = others(count, fixed);
  if (free.empty()) return out;
  const MatrixXd jacobian = columns(at.jacobian, free);
  const CorrelatedErrors e = correlated_errors(jacobian, at.values, problem.run_lengths());
  out.variance = at.values.squaredNorm() / static_cast<double>(jacobian.rows() - jacobian.cols());
  out.n_effective = e.n_effective;
  const MatrixXd independent = out.variance * (jacobian.transpose() * jacobian).inverse();
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto a = static_cast<Index>(i);
    out.errors[free[i]] = problem.scales()[free[i]] * std::sqrt(e.covariance(a, a));
    out.inflation[free[i]] = std::sqrt(e.covariance(a, a) / independent(a, a));
    for (std::size_t j = 0; j < free.size(); ++j) {
      const auto b = static_cast<Index>(j);
      out.correlations(static_cast<Index>(free[i]), static_cast<Index>(free[j])) =
          e.covariance(a, b) / std::sqrt(e.covariance(a, a) * e.covariance(b, b));
    }
  }
  return out;
}

Profile profile_of(const PathProblem& problem, const PathMinimum& best, const PathErrors& errors,
                   const ColumnWeights& weights, const std::set<std::size_t>& fixed, std::size_t k) {
  std::set<std::size_t> held = fixed;
  held.insert(k);
  const double unit = 0.5 * errors.variance * std::pow(errors.inflation[k], 2);
  Profile profile;
  for (const double side : {-1.0, 1.0}) {
    std::vector<double> values, rises, from = best.values;
    for (const double step : {1.0, 2.0, 3.0}) {
      from[k] = best.values[k] + side * step * errors.errors[k];
      values.push_back(from[k]);
      const PathMinimum at = problem.minimise(from, weights, held);
      rises.push_back(std::isfinite(at.cost) ? (at.cost - best.cost) / unit
                                             : std::numeric_limits<double>::quiet_NaN());
      if (!std::isfinite(at.cost)) break;
      from = at.values;
    }
    (side < 0 ? profile.low : profile.high) = crossing(best.values[k], values, rises);
    for (std::size_t i = 0; i < values.size(); ++i) {
      profile.values.insert(side < 0 ? profile.values.begin() : profile.values.end(), values[i]);
      profile.rises.insert(side < 0 ? profile.rises.begin() : profile.rises.end(), rises[i]);
    }
    if (side < 0) {
      profile.values.push_back(best.values[k]);
      profile.rises.push_back(0);
    }
  }
  return profile;
}

}  // namespace grainlaw::calibrate
