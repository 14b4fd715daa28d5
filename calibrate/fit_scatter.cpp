#include "grainlaw/calibrate/fit_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "grainlaw/calibrate/fit_assess.hpp"
#include "grainlaw/calibrate/fit_minimise.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr std::size_t fewest_groups = 3;

/// Series by group, if there are at least three groups: then their estimates are independent.
std::map<std::string, std::vector<FitSeries>> independent_groups(const FitProblem& problem) {
  std::map<std::string, std::vector<FitSeries>> groups;
  for (const FitSeries& series : problem.series) {
    if (!series.points.empty()) groups[series.group].push_back(series);
  }
  if (problem.points != Points::rows || groups.size() < fewest_groups) groups.clear();
  return groups;
}

double lowest_x(const FitProblem& problem) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const FitPoint& p : all_points(problem)) lowest = std::min(lowest, p.x);
  return lowest;
}

/// The problem with the series of one group alone, and the bounds that these have.
FitProblem alone_problem(const FitProblem& problem, const std::vector<FitSeries>& series) {
  FitProblem alone = problem;
  alone.starts = 1;
  alone.series = series;
  const double further = lowest_x(alone) - lowest_x(problem);
  for (FitParameter& p : alone.parameters) {
    if (!p.bounds_follow_data || p.held) continue;
    p.low += further;
    p.high += further;
  }
  return alone;
}

void note_clipped(const FitProblem& alone, const std::vector<std::size_t>& free, const std::string& group,
                  const std::vector<double>& values, Scatter& scatter) {
  for (const std::size_t i : free) {
    const FitParameter& p = alone.parameters[i];
    if (!at_low(p, values[i]) && !at_high(p, values[i])) continue;
    scatter.clipped += (scatter.clipped.empty() ? "" : ", ") + p.name + " of seed " + group;
  }
}

std::vector<double> errors_of_mean(const std::vector<std::vector<double>>& estimates,
                                   const std::vector<std::size_t>& free) {
  const auto n = static_cast<double>(estimates.size());
  std::vector<double> errors(estimates.front().size());
  for (const std::size_t i : free) {
    double mean = 0, square = 0;
    for (const auto& e : estimates) mean += e[i] / n;
    for (const auto& e : estimates) square += (e[i] - mean) * (e[i] - mean);
    errors[i] = std::sqrt(square / (n - 1) / n);
  }
  return errors;
}

/// Start of a fit to one group: `best`, within the group's own bounds. Errors of held parameters are common
/// to all groups, and no matter of one.
void start_from(FitProblem& alone, const std::vector<std::size_t>& free, const std::vector<double>& best) {
  for (FitParameter& p : alone.parameters) p.held_error = 0;
  for (const std::size_t i : free) {
    FitParameter& p = alone.parameters[i];
    p.initial = std::clamp(best[i], p.low, p.high);
  }
}

bool within_bounds(const FitResult& fit, const std::vector<std::size_t>& free) {
  return fit.exit.starts_with("converged") && std::all_of(free.begin(), free.end(), [&](std::size_t i) {
           return !fit.parameters[i].at_bound && fit.parameters[i].stderr_.has_value();
         });
}

struct Weighted {
  double mean = 0, error = 0, chi_squared = 0;
};

Weighted weighted_mean(const std::vector<double>& values, const std::vector<double>& errors, double scatter) {
  Weighted out;
  double weights = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double weight = 1 / (errors[i] * errors[i] + scatter * scatter);
    weights += weight;
    out.mean += weight * values[i];
  }
  out.mean /= weights;
  out.error = std::sqrt(1 / weights);
  for (std::size_t i = 0; i < values.size(); ++i)
    out.chi_squared += std::pow(values[i] - out.mean, 2) / (errors[i] * errors[i] + scatter * scatter);
  return out;
}

/// With the scatter at which chi squared equals the degrees of freedom (Paule and Mandel); 0 where it is
/// below.
Weighted mean_of(const std::vector<double>& values, const std::vector<double>& errors) {
  const double dof = static_cast<double>(values.size() - 1);
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  // No error is taken to be smaller than the rounding of the estimates.
  const double floor = 1e-12 * std::max(std::abs(*least), std::abs(*largest)) + 1e-300;
  if (weighted_mean(values, errors, floor).chi_squared <= dof) return weighted_mean(values, errors, floor);
  double low = floor, high = std::max(*largest - *least, 2 * floor);
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low * high);
    (weighted_mean(values, errors, middle).chi_squared > dof ? low : high) = middle;
  }
  return weighted_mean(values, errors, high);
}

GroupMean mean_of_fits(const std::vector<FitResult>& fits, const std::vector<std::size_t>& free) {
  GroupMean mean;
  mean.groups = fits.size();
  mean.values = fits.front().values();
  mean.errors.assign(mean.values.size(), 0);
  for (const std::size_t i : free) {
    std::vector<double> values, errors;
    for (const FitResult& fit : fits) {
      values.push_back(fit.parameters[i].value);
      errors.push_back(*fit.parameters[i].stderr_);
    }
    const Weighted weighted = mean_of(values, errors);
    mean.values[i] = weighted.mean;
    mean.errors[i] = weighted.error;
  }
  double squares = 0, n = 0;
  for (const FitResult& fit : fits) {
    squares += fit.rms * fit.rms * static_cast<double>(fit.n);
    n += static_cast<double>(fit.n);
    mean.n_effective += fit.n_effective;
    mean.condition = std::max(mean.condition, fit.condition);
  }
  mean.rms = std::sqrt(squares / n);
  return mean;
}

}  // namespace

std::optional<GroupMean> mean_over_groups(const FitProblem& problem, const std::vector<std::size_t>& free,
                                          const std::vector<double>& best) {
  std::vector<FitResult> fits;
  std::string left_out;
  for (const auto& [name, series] : independent_groups(problem)) {
    FitProblem alone = alone_problem(problem, series);
    if (all_points(alone).size() <= free.size()) return std::nullopt;
    start_from(alone, free, best);
    FitResult fit = assess(alone);
    if (within_bounds(fit, free))
      fits.push_back(std::move(fit));
    else
      left_out += (left_out.empty() ? "" : ", ") + name;
  }
  if (fits.size() < fewest_groups) return std::nullopt;
  GroupMean mean = mean_of_fits(fits, free);
  mean.left_out = left_out;
  return mean;
}

Scatter scatter_over_groups(const FitProblem& problem, const std::vector<std::size_t>& free,
                            const std::vector<double>& best) {
  const auto groups = independent_groups(problem);
  Scatter scatter;
  std::vector<std::vector<double>> estimates;
  for (const auto& [name, series] : groups) {
    const FitProblem alone = alone_problem(problem, series);
    const std::vector<double> weights(all_points(alone).size(), 1.0);
    if (weights.size() <= free.size()) return {};
    std::vector<double> start = best;
    for (const std::size_t i : free)
      start[i] = std::clamp(best[i], alone.parameters[i].low, alone.parameters[i].high);
    const Minimum minimum = minimise(alone, free, weights, start);
    if (!minimum.converged) return {};
    note_clipped(alone, free, name, minimum.values, scatter);
    estimates.push_back(minimum.values);
  }
  if (estimates.empty()) return {};
  scatter.groups = estimates.size();
  scatter.errors = errors_of_mean(estimates, free);
  return scatter;
}

}  // namespace grainlaw::calibrate
