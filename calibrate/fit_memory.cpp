#include "grainlaw/calibrate/fit_memory.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "grainlaw/calibrate/fit_assess.hpp"
#include "grainlaw/calibrate/fit_law.hpp"
#include "grainlaw/model/laws/shear_jamming.hpp"

namespace grainlaw::calibrate {
namespace {

/// Volume fractions of states, and amplitudes of over-compression, closer than this count as one.
constexpr double nu_resolution = 5e-4;
/// Legs of shear whose volume fractions are closer than this are of one path.
constexpr double same_nu = 1e-5;
/// Eqs. 5.2 and 5.5 have an infinite slope where a volume fraction of the data meets phi_SJ: it stays below
/// the lowest by this share.
constexpr double off_phi_SJ = 1e-4;
constexpr int starts = 24;
constexpr double most_loose = 0.1;
constexpr std::size_t fewest_cycles = 3;  // of a record that says how it grows

/// Share of the limit after M cycles: 0 for M = 0, where a power of M has no derivative.
template <class T>
T share(Growth growth, double M, const T& mu, const T& beta) {
  using std::expm1;
  using std::log;
  using std::pow;
  using std::tanh;
  if (M <= 0) return T(0);
  if (growth == Growth::inverse_log) return T(1) - T(1) / (T(1) + beta * log(T(1) + M / mu));
  const T cycles = pow(M / mu, beta);
  return growth == Growth::tanh ? T(tanh(cycles)) : T(-expm1(-cycles));
}

struct OverCompressionLaw {  // phi_SJ, alpha_max, alpha_phi, mu, beta; phi_max is at.x, M is at.known
  Growth growth;
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::pow;
    if (at.x <= p[0]) return p[0];
    return p[0] + p[1] * pow(at.x / p[0] - 1.0, p[2]) * share(growth, at.known, p[3], p[4]);
  }
};

struct ShearJammingLaw {  // phi_SJ, alpha, eps0; phi is at.x, phi_J0 is at.known
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return model::shear_jamming_strain<T>({p[0], p[1], p[2]}, T(at.known), T(at.x));
  }
};

struct ReversalLaw {  // phi_SJ, alpha, eps0_R, phi_cr
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return model::shear_jamming_strain<T>({p[0], p[1], p[2]}, p[3], T(at.x));
  }
};

/// Whether too many cycles to this volume fraction leave a packing that does not jam there.
bool often_loose(const std::vector<CycleDensity>& cycles, double phi_max) {
  double all = 0, loose = 0;
  for (const CycleDensity& c : cycles) {
    if (std::abs(c.phi_max - phi_max) > nu_resolution) continue;
    all += 1;
    loose += c.from_P.known() ? 0 : 1;
  }
  return loose > most_loose * all;
}

std::vector<FitSeries> series_of(const std::vector<CycleDensity>& cycles) {
  std::vector<FitSeries> series;
  for (const CycleDensity& c : cycles) {
    if (!c.from_P.known() || often_loose(cycles, c.phi_max)) continue;
    if (series.empty() || series.back().test != c.test) series.push_back({c.test, c.group, {}});
    series.back().points.push_back({c.phi_max, c.from_P.value, c.M, 0});
  }
  return series;
}

std::vector<FitSeries> one_point_each(const std::vector<ShearJamming>& runs, double above,
                                      const std::function<bool(const ShearJamming&)>& take) {
  std::vector<FitSeries> series;
  for (const ShearJamming& run : runs) {
    const double strain = run.by(JamSign::contacts);
    if (!std::isfinite(strain) || run.nu <= above || !take(run)) continue;
    series.push_back({run.test, run.group, {{run.nu, strain, run.phi_J0.value, 0}}});
  }
  return series;
}

bool same_packing(const ShearJamming& a, const ShearJamming& b) {
  return a.group == b.group && a.M == b.M && std::abs(a.phi_max - b.phi_max) < nu_resolution &&
         std::abs(a.nu - b.nu) < same_nu;
}

/// Legs of one packing at one volume fraction are not independent: one run, with the mean of their strains.
std::vector<ShearJamming> mean_reversals(const std::vector<ShearJamming>& runs) {
  std::vector<ShearJamming> means;
  std::vector<double> legs;
  for (const ShearJamming& run : runs) {
    if (run.reversals == 0 || !run.jammed_before || !std::isfinite(run.by(JamSign::contacts))) continue;
    const auto of_packing = std::find_if(means.begin(), means.end(),
                                         [&](const ShearJamming& other) { return same_packing(run, other); });
    if (of_packing == means.end()) {
      means.push_back(run);
      legs.push_back(1);
      continue;
    }
    double& n = legs[static_cast<std::size_t>(of_packing - means.begin())];
    double& mean = of_packing->strain[static_cast<std::size_t>(JamSign::contacts)];
    n += 1;
    mean += (run.by(JamSign::contacts) - mean) / n;
  }
  return means;
}

double lowest_x(const std::vector<FitSeries>& series, double otherwise) {
  double lowest = otherwise;
  for (const FitSeries& s : series)
    for (const FitPoint& p : s.points) lowest = std::min(lowest, p.x);
  return lowest;
}

FitParameter limit_density(const std::string& name, const KnownValues& known,
                           const std::vector<FitSeries>& series, int hold_order) {
  const double high = lowest_x(series, 0.7) * (1 - off_phi_SJ);
  FitParameter p = known_parameter(known, name, high - 2e-3, high - 0.06, high, 5e-3, hold_order);
  p.bounds_follow_data = true;
  return p;
}

FitParameter held_parameter(const std::string& name, const KnownValue& at) {
  FitParameter p = known_parameter({}, name, at.value, at.value - 1, at.value + 1, 1);
  p.held = true;
  p.held_error = at.error;
  return p;
}

bool is_found(const FitEstimate& e) { return e.determined && !e.held && e.stderr_.value_or(0) > 0; }

/// Weighted mean of those that found it, so that one number serves all laws.
LimitDensity common_limit(const FitEstimate& compressed, const FitEstimate& sheared,
                          const Estimate& at_rest) {
  LimitDensity out{compressed.value, compressed.stderr_.value_or(0), {}, {}, at_rest};
  double weights = 0, sum = 0;
  if (is_found(compressed)) out.by_over_compression = {compressed.value, *compressed.stderr_};
  if (is_found(sheared)) out.by_shear = {sheared.value, *sheared.stderr_};
  for (const Estimate& e : {out.by_over_compression, out.by_shear, out.by_rest}) {
    if (!e.known()) continue;
    weights += 1 / (e.error * e.error);
    sum += e.value / (e.error * e.error);
  }
  if (weights == 0) return out;
  out.value = sum / weights;
  out.error = std::sqrt(1 / weights);
  return out;
}

/// phi_SJ is the first parameter; runs at or below it cannot jam by the law.
void hold_limit(FitProblem& problem, const LimitDensity& limit) {
  problem.parameters.front().held = true;
  problem.parameters.front().initial = limit.value;
  problem.parameters.front().held_error = limit.error;
  for (FitSeries& s : problem.series)
    std::erase_if(s.points, [&](const FitPoint& p) { return p.x <= limit.value * (1 + off_phi_SJ); });
}

}  // namespace

std::string name_of(Growth growth) {
  if (growth == Growth::stretched) return "stretched exponential";
  return growth == Growth::inverse_log ? "inverse logarithm" : "hyperbolic tangent";
}

double grown(Growth growth, double M, double mu, double beta) { return share(growth, M, mu, beta); }

FitProblem over_compression_problem(const std::vector<CycleDensity>& cycles, Growth growth,
                                    const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<5>(OverCompressionLaw{growth});
  problem.series = series_of(cycles);
  problem.x_resolution = nu_resolution;
  problem.starts = starts;
  problem.parameters = {limit_density("phi_SJ", known, problem.series, 3),
                        known_parameter(known, "alpha_max", 0.02, 1e-4, 0.5, 0.02, 4),
                        known_parameter(known, "alpha_phi", 0.3, 0.02, 3, 0.3, 1),
                        known_parameter(known, "mu", 1, 1e-3, 1e4, 1, 0),
                        known_parameter(known, "beta", 0.3, 0.02, 10, 0.3, 2)};
  return problem;
}

FitProblem growth_problem(const std::vector<CycleDensity>& cycles, Growth growth, double phi_SJ) {
  FitProblem problem;
  problem.starts = starts / 2;
  problem.parameters = {known_parameter({}, "mu", 1, 1e-3, 1e4, 1),
                        known_parameter({}, "beta", 0.5, 0.02, 30, 0.3)};
  for (const FitSeries& s : series_of(cycles)) {
    if (s.points.size() < fewest_cycles) continue;
    FitSeries numbered{s.test, "", s.points};
    for (FitPoint& p : numbered.points) {
      p.x = static_cast<double>(problem.series.size());
      p.y -= phi_SJ;
    }
    problem.parameters.push_back(known_parameter({}, "of " + s.test, 0.01, -0.05, 0.2, 0.01));
    problem.series.push_back(std::move(numbered));
  }
  problem.law = [growth](std::span<const double> p, const FitPoint& at, std::span<double> gradient) {
    using Jet = ceres::Jet<double, 2>;
    const Jet g = share(growth, at.known, Jet(p[0], 0), Jet(p[1], 1));
    const auto amplitude = 2 + static_cast<std::size_t>(at.x);
    if (!gradient.empty()) {
      std::fill(gradient.begin(), gradient.end(), 0.0);
      gradient[0] = p[amplitude] * g.v[0];
      gradient[1] = p[amplitude] * g.v[1];
      gradient[amplitude] = g.a;
    }
    return p[amplitude] * g.a;
  };
  return problem;
}

std::vector<GrowthComparison> compare_growths(const std::vector<CycleDensity>& cycles, double phi_SJ) {
  std::vector<GrowthComparison> out;
  double n_effective = 0;
  if (growth_problem(cycles, Growth::stretched, phi_SJ).series.empty()) return out;
  for (const Growth growth : growths) {
    const FitResult result = assess(growth_problem(cycles, growth, phi_SJ));
    out.push_back({growth, result.value("mu"), result.value("beta"), result.rms, 0});
    n_effective = std::max(n_effective, result.n_effective);
  }
  const double best = std::min_element(out.begin(), out.end(), [](const auto& a, const auto& b) {
                        return a.rms < b.rms;
                      })->rms;
  for (GrowthComparison& c : out) c.delta_AIC = 2 * n_effective * std::log(c.rms / best);
  return out;
}

std::vector<Entanglement> entanglement(const FitProblem& problem, const FitResult& at) {
  const std::vector<std::size_t> free = free_parameters(problem);
  const std::vector<FitPoint> points = all_points(problem);
  if (!at.ran || points.size() <= free.size()) return {};
  Eigen::MatrixXd jacobian(points.size(), free.size());
  std::vector<double> gradient(problem.parameters.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    problem.law(at.values(), points[i], gradient);
    for (std::size_t k = 0; k < free.size(); ++k)
      jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          gradient[free[k]] * problem.parameters[free[k]].scale;
  }
  const Eigen::MatrixXd covariance =
      (jacobian.transpose() * jacobian).completeOrthogonalDecomposition().pseudoInverse();
  std::vector<Entanglement> out;
  for (std::size_t k = 0; k < free.size(); ++k)
    for (std::size_t l = k + 1; l < free.size(); ++l) {
      const auto a = static_cast<Eigen::Index>(k), b = static_cast<Eigen::Index>(l);
      out.push_back({problem.parameters[free[k]].name, problem.parameters[free[l]].name,
                     covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b))});
    }
  return out;
}

FitProblem shear_jamming_problem(const std::vector<ShearJamming>& runs, const KnownValue& phi_SJ,
                                 const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<3>(ShearJammingLaw{});
  problem.series = one_point_each(runs, 0, [](const ShearJamming& run) {
    return run.reversals == 0 && run.nu < run.phi_J0.value && run.by(JamSign::contacts) > 0;
  });
  problem.points = Points::runs;
  problem.starts = starts;
  const double highest = lowest_x(problem.series, 0.7) * (1 - off_phi_SJ);
  const KnownValue limit(std::min(phi_SJ.value, highest), phi_SJ.error);
  problem.parameters = {limit_density("phi_SJ_sheared", {{"phi_SJ_sheared", limit}}, problem.series, 1),
                        known_parameter(known, "alpha", 1.4, 0.2, 10, 1, 0),
                        known_parameter(known, "eps0", 0.1, 1e-3, 2, 0.1, 2)};
  return problem;
}

FitProblem reversal_problem(const std::vector<ShearJamming>& runs, const KnownValue& phi_SJ,
                            const KnownValue& alpha, const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<4>(ReversalLaw{});
  problem.series = one_point_each(mean_reversals(runs), phi_SJ.value * (1 + off_phi_SJ),
                                  [](const ShearJamming&) { return true; });
  problem.points = Points::runs;
  problem.starts = starts;
  const double lowest = lowest_x(problem.series, 0.66);
  problem.parameters = {
      held_parameter("phi_SJ_sheared", phi_SJ), held_parameter("alpha", alpha),
      known_parameter(known, "eps0_R", 0.17, 1e-3, 2, 0.1, 1),
      known_parameter(known, "phi_cr", lowest + 4e-3, lowest * (1 + off_phi_SJ), lowest + 0.05, 5e-3, 0)};
  return problem;
}

MemoryFit fit_memory(const std::vector<CycleDensity>& cycles, const std::vector<ShearJamming>& runs,
                     const KnownValues& known, const Estimate& at_rest) {
  MemoryFit out;
  out.over_compression_law = over_compression_problem(cycles, Growth::stretched, known);
  out.over_compression = fit(out.over_compression_law);
  const FitEstimate compressed = out.over_compression["phi_SJ"];
  out.entangled = entanglement(out.over_compression_law, out.over_compression);
  out.shear_law = shear_jamming_problem(runs, {compressed.value, compressed.stderr_.value_or(0)}, known);
  out.shear = fit(out.shear_law);
  const FitEstimate sheared = out.shear["phi_SJ_sheared"];
  out.phi_SJ = common_limit(compressed, sheared, at_rest);
  if (is_found(sheared) || at_rest.known()) {  // else the fits stand at one phi_SJ already
    hold_limit(out.over_compression_law, out.phi_SJ);
    hold_limit(out.shear_law, out.phi_SJ);
    out.over_compression = fit(out.over_compression_law);
    out.shear = fit(out.shear_law);
  }
  out.growth = compare_growths(cycles, out.phi_SJ.value);
  const FitEstimate& alpha = out.shear["alpha"];
  out.reversal_law = reversal_problem(runs, {out.phi_SJ.value, out.phi_SJ.error},
                                      {alpha.value, alpha.stderr_.value_or(0)}, known);
  out.reversal = fit(out.reversal_law);
  return out;
}

}  // namespace grainlaw::calibrate
