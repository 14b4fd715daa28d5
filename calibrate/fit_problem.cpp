#include "grainlaw/calibrate/fit_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/calibrate/fit_assess.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

void check(const FitProblem& problem) {
  if (problem.parameters.empty()) throw Error("a fit needs at least one parameter");
  for (const FitParameter& p : problem.parameters) {
    const bool fits = p.held || (p.low < p.high && p.initial >= p.low && p.initial <= p.high && p.scale > 0);
    if (!fits || !std::isfinite(p.initial)) {
      throw Error("", p.name, "the start of a fit must lie within its bounds, got " + to_text(p.initial));
    }
  }
  for (const FitSeries& series : problem.series) {
    for (const FitPoint& point : series.points) {
      if (!std::isfinite(point.x + point.y + point.known + point.error) || point.error < 0) {
        throw Error("", series.test, "the points of a fit must be finite numbers");
      }
    }
  }
}

std::size_t count_points(const FitProblem& problem) {
  std::size_t n = 0;
  for (const FitSeries& series : problem.series) n += series.points.size();
  return n;
}

/// Number of values of x that differ by more than the resolution.
std::size_t count_distinct(const FitProblem& problem) {
  std::vector<double> x;
  for (const FitSeries& series : problem.series) {
    for (const FitPoint& point : series.points) x.push_back(point.x);
  }
  std::sort(x.begin(), x.end());
  std::size_t distinct = 0;
  double last = 0;
  for (const double value : x) {
    if (distinct == 0 || value - last > problem.x_resolution) {
      ++distinct;
      last = value;
    }
  }
  return distinct;
}

/// Why `free` parameters are too many for the data, or nothing.
std::string too_few(const FitProblem& problem, std::size_t free) {
  const std::size_t n = count_points(problem), distinct = count_distinct(problem);
  const std::string many = std::to_string(free) + (free == 1 ? " parameter" : " parameters");
  if (n == 0) return "no data";
  if (distinct < free) {
    return "the data hold only " + std::to_string(distinct) + " different x for " + many;
  }
  if (n == free) return std::to_string(n) + " points for " + many + " leave nothing to judge the fit by";
  return "";
}

/// The parameters in question, those with a usable fallback first, in the order they are to be held.
std::optional<std::size_t> next_to_hold(const FitProblem& problem,
                                        const std::vector<std::size_t>& candidates) {
  std::optional<std::size_t> best;
  for (const std::size_t i : candidates) {
    const FitParameter& p = problem.parameters[i];
    const bool usable = !p.held && p.fallback && *p.fallback >= p.low && *p.fallback <= p.high;
    if (usable && (!best || p.hold_order < problem.parameters[*best].hold_order)) best = i;
  }
  return best;
}

}  // namespace

const FitEstimate& FitResult::operator[](const std::string& name) const {
  for (const FitEstimate& p : parameters) {
    if (p.name == name) return p;
  }
  throw Error("", name, "the fit has no such parameter");
}

std::vector<double> FitResult::values() const {
  std::vector<double> out;
  for (const FitEstimate& p : parameters) out.push_back(p.value);
  return out;
}

bool FitResult::determined() const {
  return std::all_of(parameters.begin(), parameters.end(), [](const FitEstimate& p) { return p.determined; });
}

FitResult not_fitted(const FitProblem& problem, const std::string& why) {
  FitResult result;
  result.n = count_points(problem);
  result.exit = "not run: " + why;
  result.stderr_from = "none";
  for (const FitParameter& p : problem.parameters) {
    FitEstimate e;
    e.name = p.name;
    e.unit = p.unit;
    e.value = p.held ? p.initial : p.fallback.value_or(std::numeric_limits<double>::quiet_NaN());
    e.held = true;
    e.determined = p.held;
    if (!p.held) e.reason = why;
    result.parameters.push_back(e);
  }
  return result;
}

FitResult fit(const FitProblem& problem) {
  check(problem);
  FitProblem now = problem;
  std::vector<std::string> held_for(problem.parameters.size());
  const auto hold = [&](std::size_t i, const std::string& reason) {
    now.parameters[i].held = true;
    now.parameters[i].initial = *now.parameters[i].fallback;
    now.parameters[i].held_error = now.parameters[i].fallback_error;
    held_for[i] = reason;
  };
  FitResult result;
  while (true) {
    const std::vector<std::size_t> free = free_parameters(now);
    if (free.empty()) {
      result = not_fitted(now, "the data determine none of the parameters");
      break;
    }
    if (const std::string why = too_few(now, free.size()); !why.empty()) {
      const auto next = next_to_hold(now, free);
      if (count_points(now) == 0 || !next) {
        result = not_fitted(now, why);
        break;
      }
      hold(*next, why);
      continue;
    }
    result = assess(now);
    std::vector<std::size_t> doubtful;
    for (const std::size_t i : free) {
      if (!result.parameters[i].determined) doubtful.push_back(i);
    }
    const auto next = next_to_hold(now, doubtful);
    if (!next) break;
    hold(*next, result.parameters[*next].reason);
  }
  for (std::size_t i = 0; i < held_for.size(); ++i) {
    if (held_for[i].empty()) continue;
    result.parameters[i].determined = false;
    result.parameters[i].held = true;
    result.parameters[i].reason = held_for[i];
  }
  return result;
}

}  // namespace grainlaw::calibrate
