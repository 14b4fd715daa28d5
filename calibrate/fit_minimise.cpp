#include "grainlaw/calibrate/fit_minimise.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace grainlaw::calibrate {
namespace {

/// Weighted residuals over the free parameters, each divided by its scale; the residuals by the size of the
/// data, so that the solver's absolute tolerances mean the same for every law.
class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const FitProblem& problem, const std::vector<std::size_t>& free,
            const std::vector<double>& weights, double unit, std::vector<double> values)
      : problem_(problem), free_(free), weights_(weights), unit_(unit), values_(std::move(values)) {
    set_num_residuals(static_cast<int>(weights.size()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(free.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::vector<double> p = values_;
    for (std::size_t k = 0; k < free_.size(); ++k) p[free_[k]] = parameters[0][k] * scale(k);
    std::vector<double> gradient(p.size());
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    std::size_t row = 0;
    for (const FitSeries& series : problem_.series) {
      for (const FitPoint& point : series.points) {
        const double w = weights_[row] / unit_;
        const double y =
            problem_.law(p, point, jacobian != nullptr ? std::span(gradient) : std::span<double>());
        residuals[row] = w * (y - point.y);
        if (!std::isfinite(residuals[row])) return false;
        for (std::size_t k = 0; jacobian != nullptr && k < free_.size(); ++k) {
          const double slope = w * gradient[free_[k]] * scale(k);
          if (!std::isfinite(slope)) return false;
          jacobian[row * free_.size() + k] = slope;
        }
        ++row;
      }
    }
    return true;
  }

 private:
  double scale(std::size_t k) const { return problem_.parameters[free_[k]].scale; }

  const FitProblem& problem_;
  const std::vector<std::size_t>& free_;
  const std::vector<double>& weights_;
  double unit_;
  std::vector<double> values_;
};

std::string exit_in_words(const ceres::Solver::Summary& summary) {
  const std::string& message = summary.message;
  if (summary.termination_type == ceres::CONVERGENCE) {
    if (message.starts_with("Gradient")) return "converged: the gradient vanishes";
    if (message.starts_with("Parameter")) return "converged: the parameters no longer change";
    if (message.starts_with("Function")) return "converged: the sum of squares no longer falls";
    return "converged: " + message;
  }
  if (summary.termination_type == ceres::NO_CONVERGENCE) return "not converged: " + message;
  return "failed: " + message;
}

struct Run {
  std::vector<double> values;
  double cost;
  bool converged;
  std::string exit;
};

/// One run of the solver. None where the law is not finite at the start.
std::optional<Run> descend_within(const FitProblem& problem, const std::vector<std::size_t>& free,
                                  const std::vector<double>& weights, double unit,
                                  const std::vector<double>& start) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres_problem(ownership);
  Residuals residuals(problem, free, weights, unit, start);
  std::vector<double> u(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) u[k] = start[free[k]] / problem.parameters[free[k]].scale;
  ceres_problem.AddResidualBlock(&residuals, nullptr, u.data());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FitParameter& p = problem.parameters[free[k]];
    ceres_problem.SetParameterLowerBound(u.data(), static_cast<int>(k), p.low / p.scale);
    ceres_problem.SetParameterUpperBound(u.data(), static_cast<int>(k), p.high / p.scale);
  }
  const double* block = u.data();
  std::vector<double> probe(weights.size()), slopes(weights.size() * free.size());
  double* slopes_of_block = slopes.data();
  if (!residuals.Evaluate(&block, probe.data(), &slopes_of_block)) return std::nullopt;

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 400;
  options.max_num_consecutive_invalid_steps = 20;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;

  Run run{start, summary.final_cost * unit * unit, summary.termination_type == ceres::CONVERGENCE,
          exit_in_words(summary)};
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FitParameter& p = problem.parameters[free[k]];
    run.values[free[k]] = std::clamp(u[k] * p.scale, p.low, p.high);
  }
  return run;
}

bool on_low(const FitParameter& p, double value) { return value <= p.low + 1e-9 * (p.high - p.low); }
bool on_high(const FitParameter& p, double value) { return value >= p.high - 1e-9 * (p.high - p.low); }

/// Whether the sum of squares falls when parameter i leaves its bound.
bool pulls_inwards(const FitProblem& problem, const std::vector<double>& weights,
                   const std::vector<double>& values, std::size_t i) {
  std::vector<double> gradient(values.size());
  double slope = 0;
  std::size_t row = 0;
  for (const FitSeries& series : problem.series) {
    for (const FitPoint& point : series.points) {
      const double residual = problem.law(values, point, gradient) - point.y;
      slope += weights[row] * weights[row] * residual * gradient[i];
      ++row;
    }
  }
  return on_low(problem.parameters[i], values[i]) ? slope < 0 : slope > 0;
}

/// The solver projects its steps onto the bounds, and a step cut short there can end it before the other
/// parameters are at their minimum. So those that came to rest on a bound are put exactly there, the others
/// go on, and one that would rather leave its bound is let go.
std::optional<Run> descend(const FitProblem& problem, const std::vector<std::size_t>& free,
                           const std::vector<double>& weights, double unit,
                           const std::vector<double>& start) {
  std::optional<Run> run = descend_within(problem, free, weights, unit, start);
  for (int round = 0; run && round < 4; ++round) {
    std::vector<std::size_t> inner, resting;
    std::vector<double> from = run->values;
    for (const std::size_t i : free) {
      const FitParameter& p = problem.parameters[i];
      const bool low = on_low(p, from[i]), high = on_high(p, from[i]);
      (low || high ? resting : inner).push_back(i);
      if (low || high) from[i] = low ? p.low : p.high;
    }
    if (resting.empty()) return run;
    if (!inner.empty()) {
      auto rest = descend_within(problem, inner, weights, unit, from);
      if (!rest || rest->cost > run->cost * (1 + 1e-9)) return run;
      run = std::move(rest);
    }
    std::vector<double> nudged = run->values;
    for (const std::size_t i : resting) {
      if (!pulls_inwards(problem, weights, run->values, i)) continue;
      const FitParameter& p = problem.parameters[i];
      nudged[i] += (on_low(p, nudged[i]) ? 1e-3 : -1e-3) * (p.high - p.low);
    }
    if (nudged == run->values) return run;
    auto again = descend_within(problem, free, weights, unit, nudged);
    if (!again || again->cost >= run->cost) return run;
    run = std::move(again);
  }
  return run;
}

double between_bounds(const FitParameter& p, double fraction) {
  if (p.low > 0 && p.high > 10 * p.low) return p.low * std::pow(p.high / p.low, fraction);
  return p.low + fraction * (p.high - p.low);
}

/// Root of the weighted mean square of the data: the size against which residuals are small.
double data_size(const FitProblem& problem, const std::vector<double>& weights) {
  double sum = 0;
  std::size_t row = 0;
  for (const FitSeries& series : problem.series) {
    for (const FitPoint& point : series.points) sum += std::pow(weights[row++] * point.y, 2);
  }
  return sum > 0 ? std::sqrt(sum / static_cast<double>(row)) : 1.0;
}

/// SplitMix64: small, and the same everywhere.
std::uint64_t next_random(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

std::vector<std::vector<double>> latin_hypercube(int count, std::size_t dimensions, std::uint64_t seed) {
  const auto n = static_cast<std::size_t>(std::max(count, 0));
  std::vector<std::vector<double>> points(n, std::vector<double>(dimensions));
  std::uint64_t state = seed;
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::size_t> cell(n);
    std::iota(cell.begin(), cell.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(cell[i - 1], cell[next_random(state) % i]);
    for (std::size_t i = 0; i < n; ++i) {
      const double within = static_cast<double>(next_random(state) >> 11) * 0x1p-53;
      points[i][d] = (static_cast<double>(cell[i]) + within) / static_cast<double>(n);
    }
  }
  return points;
}

Minimum minimise(const FitProblem& problem, const std::vector<std::size_t>& free,
                 const std::vector<double>& weights, const std::vector<double>& start) {
  const double unit = data_size(problem, weights);
  std::vector<std::vector<double>> starts{start};
  for (const auto& point : latin_hypercube(problem.starts - 1, free.size(), problem.seed)) {
    starts.push_back(start);
    for (std::size_t k = 0; k < free.size(); ++k) {
      starts.back()[free[k]] = between_bounds(problem.parameters[free[k]], point[k]);
    }
  }
  std::vector<Run> runs;
  for (const auto& from : starts) {
    if (auto run = descend(problem, free, weights, unit, from)) runs.push_back(std::move(*run));
  }
  Minimum best;
  best.starts = static_cast<int>(starts.size());
  best.values = start;
  best.exit = "failed: the law is not finite at any start";
  if (runs.empty()) return best;
  const auto lowest =
      std::min_element(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.cost < b.cost; });
  best.values = lowest->values;
  best.cost = lowest->cost;
  best.converged = lowest->converged;
  best.exit = lowest->exit;
  // Costs that differ by less than the data's own rounding are one minimum.
  const double noise = 1e-14 * unit * unit * static_cast<double>(weights.size());
  best.best_found = static_cast<int>(std::count_if(runs.begin(), runs.end(), [&](const Run& run) {
    return run.cost <= lowest->cost * (1 + 1e-6) + noise;
  }));
  return best;
}

}  // namespace grainlaw::calibrate
