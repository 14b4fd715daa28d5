#include "grainlaw/calibrate/fit_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "grainlaw/calibrate/fit_assess.hpp"
#include "grainlaw/calibrate/fit_minimise.hpp"

namespace grainlaw::calibrate {
namespace {

/// Series by group, if there are at least three groups: then their estimates are independent.
std::map<std::string, std::vector<FitSeries>> independent_groups(const FitProblem& problem) {
  std::map<std::string, std::vector<FitSeries>> groups;
  for (const FitSeries& series : problem.series) {
    if (!series.points.empty()) groups[series.group].push_back(series);
  }
  if (problem.points != Points::rows || groups.size() < 3) groups.clear();
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

}  // namespace

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
