#include "grainlaw/calibrate/fit_shear.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/calibrate/fit_law.hpp"

namespace grainlaw::calibrate {
namespace {

/// Volume fractions closer than this count as one.
constexpr double nu_resolution = 2e-3;

struct ApproachLaw {  // max, initial, beta
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::exp;
    return p[0] - (p[0] - p[1]) * exp(-p[2] * at.x);
  }
};

struct DensityLaw {  // Q_max, Q_v, alpha, nu_c
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::exp;
    return p[0] + p[1] * exp(-p[2] * (at.x / p[3] - 1.0));
  }
};

struct StraightLine {  // value at 0.7, slope
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return p[0] + p[1] * (at.x - 0.7);
  }
};

FitParameter parameter(const std::string& name, double initial, double low, double high, double scale) {
  FitParameter p;
  p.name = name;
  p.initial = std::clamp(initial, low, high);
  p.low = low;
  p.high = high;
  p.scale = scale;
  return p;
}

void hold_if_open(FitParameter& p, const KnownValues& known, int order) {
  if (const auto found = known.find(p.name); found != known.end()) {
    p.fallback = found->second.value;
    p.fallback_error = found->second.error;
  }
  p.hold_order = order;
}

std::vector<FitSeries> series_of(const std::vector<RunValue>& values, bool weighted) {
  std::vector<FitSeries> series;
  for (const RunValue& v : values)
    series.push_back({v.test, v.group, {{v.nu, v.value, 0, weighted ? v.error : 0}}});
  return series;
}

bool of_fabric(ShearQuantity q) { return q == ShearQuantity::F_max || q == ShearQuantity::beta_F; }
bool is_rate(ShearQuantity q) { return q == ShearQuantity::beta_s || q == ShearQuantity::beta_F; }

}  // namespace

std::string name_of(ShearQuantity quantity) {
  switch (quantity) {
    case ShearQuantity::s_max:
      return "s_max";
    case ShearQuantity::beta_s:
      return "beta_s";
    case ShearQuantity::F_max:
      return "F_max";
    case ShearQuantity::beta_F:
      return "beta_F";
  }
  return "";
}

FitProblem approach_problem(const ShearCurve& curve) {
  FitProblem problem;
  problem.law = differentiable<3>(ApproachLaw{});
  FitSeries series{curve.test, curve.group, {}};
  for (std::size_t i = 0; i < curve.strain.size(); ++i)
    series.points.push_back({curve.strain[i], curve.value[i]});
  problem.series = {series};
  problem.starts = 8;
  problem.parameters = {parameter("max", 0.15, 0, 1, 0.1), parameter("initial", 0, -0.5, 0.5, 0.1),
                        parameter("beta", 40, 1, 2000, 100)};
  problem.parameters.back().judged_by_value = true;
  return problem;
}

FitResult fit_approach(const ShearCurve& curve) { return fit(approach_problem(curve)); }

FitProblem density_problem(ShearQuantity quantity, const std::vector<RunValue>& values, double nu_c,
                           double nu_c_error, const KnownValues& known) {
  const double unit = is_rate(quantity) ? 50 : 0.15;
  FitProblem problem;
  problem.law = differentiable<4>(DensityLaw{});
  // The error of a rate grows with the rate itself: as a weight it would pull the law towards the lower ones.
  problem.series = series_of(values, !is_rate(quantity));
  problem.points = Points::runs;
  problem.x_resolution = nu_resolution;
  problem.starts = 24;
  FitParameter Q_max = parameter("Q_max", of_fabric(quantity) ? 0 : 0.6 * unit, 0, 4 * unit, unit);
  Q_max.low_is_natural = true;
  Q_max.held = of_fabric(quantity);
  FitParameter Q_v = parameter("Q_v", unit, -10 * unit, 10 * unit, unit);
  FitParameter alpha = parameter("alpha", 8, 0.3, 80, 10);
  hold_if_open(alpha, known, 0);
  hold_if_open(Q_v, known, 1);
  hold_if_open(Q_max, known, 2);
  FitParameter at = parameter("nu_c", nu_c, 0, 1, 0.02);
  at.held = true;
  at.held_error = nu_c_error;
  problem.parameters = {Q_max, Q_v, alpha, at};
  return problem;
}

Trend trend_of(const std::vector<RunValue>& values) {
  FitProblem problem;
  problem.law = differentiable<2>(StraightLine{});
  problem.series = series_of(values, true);
  problem.points = Points::runs;
  problem.x_resolution = nu_resolution;
  problem.parameters = {parameter("value", 0, -1e4, 1e4, 1e4), parameter("slope", 0, -1e5, 1e5, 1e5)};
  std::vector<double> nu;
  for (const RunValue& v : values) nu.push_back(v.nu);
  std::sort(nu.begin(), nu.end());
  std::size_t different = nu.empty() ? 0 : 1;
  for (std::size_t i = 1; i < nu.size(); ++i) different += nu[i] - nu[i - 1] > nu_resolution ? 1 : 0;
  if (different < 3) return {};
  const FitResult line = fit(problem);
  return {line.value("slope"), line["slope"].stderr_.value_or(0), line.ran};
}

}  // namespace grainlaw::calibrate
