#include "grainlaw/calibrate/fit_moduli.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "grainlaw/calibrate/fit_law.hpp"

namespace grainlaw::calibrate {
namespace {

/// Values closer than this count as one: of F_v, F_dev, F_dev/F_v, and sigma*_dev F_dev.
constexpr double F_v_resolution = 0.05, F_dev_resolution = 2e-3, share_resolution = 3e-4,
                 product_resolution = 1e-6;
constexpr int starts = 12;

struct BulkLaw {  // p0, gamma_p, nu_c; F_v is at.x, nu is at.known
  model::ContactCurve contacts;
  double g3;
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::log;
    const double slope = model::strain_times_fabric_slope(contacts, at.known, 1);
    const T e = log(at.known / p[2]);
    return p[0] * at.x / (g3 * p[2]) * (1.0 - 2.0 * p[1] * e + e * (1.0 - p[1] * e) * slope);
  }
};

struct Proportional {  // the factor
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return p[0] * at.x;
  }
};

struct EnergyAnisotropyLaw {  // a_F, a_s; F_dev/F_v is at.x, s_dev is at.known
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return p[0] * at.x + p[1] * at.known;
  }
};

struct InitialRatioLaw {  // GB_max, Fv_min, Fv_alpha
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::exp;
    return p[0] * (1.0 - exp(-(at.x - p[1]) / p[2]));
  }
};

struct DecreaseLaw {  // g_I
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return -p[0] * at.x;
  }
};

template <class Take>
std::vector<FitSeries> points_of(const std::vector<ModuliSeries>& series, Take take) {
  std::vector<FitSeries> out;
  for (const ModuliSeries& s : series) {
    FitSeries points{s.test, s.group, {}};
    for (const ModuliState& state : s.states) points.points.push_back(take(state));
    out.push_back(std::move(points));
  }
  return out;
}

/// Mean over the states of a test before it has sheared; none if it has no such state.
std::optional<FitPoint> initial_ratio(const ModuliSeries& series) {
  FitPoint mean;
  double n = 0;
  for (const ModuliState& s : series.states) {
    if (std::abs(s.eps_dev) > initial_strain) continue;
    mean.x += s.F_v;
    mean.y += s.G / s.B;
    n += 1;
  }
  if (n == 0) return std::nullopt;
  mean.x /= n;
  mean.y /= n;
  return mean;
}

FitProblem anisotropy_problem(const std::vector<ModuliSeries>& series, double ModuliState::*modulus,
                              const FitParameter& factor) {
  FitProblem problem;
  problem.law = differentiable<1>(Proportional{});
  problem.series = points_of(series, [&](const ModuliState& s) {
    return FitPoint{s.F_dev, s.*modulus / s.B, 0, 0};
  });
  problem.x_resolution = F_dev_resolution;
  problem.parameters = {factor};
  return problem;
}

}  // namespace

FitProblem bulk_modulus_problem(const std::vector<ModuliSeries>& series, const model::ContactCurve& contacts,
                                double g3, const KnownValue& nu_c, const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<3>(BulkLaw{contacts, g3});
  problem.series = points_of(series, [](const ModuliState& s) { return FitPoint{s.F_v, s.B, s.nu, 0}; });
  for (FitSeries& s : problem.series)
    std::erase_if(s.points, [&](const FitPoint& p) { return p.known <= contacts.nu_c; });
  problem.x_resolution = F_v_resolution;
  problem.starts = starts;
  FitParameter jamming = known_parameter({}, "nu_c", nu_c.value, 0, 1, 0.02, 2);
  jamming.held = true;
  jamming.held_error = nu_c.error;
  problem.parameters = {known_parameter(known, "p0", 0.042, 1e-3, 0.5, 0.04, 1),
                        known_parameter(known, "gamma_p", 0.2, -5, 5, 1, 0), jamming};
  return problem;
}

FitProblem first_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known) {
  return anisotropy_problem(series, &ModuliState::A1, known_parameter(known, "a_I", 0.7, -10, 10, 0.7));
}

FitProblem second_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known) {
  return anisotropy_problem(series, &ModuliState::A2, known_parameter(known, "a_II", 1, -10, 10, 1));
}

FitProblem energy_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<2>(EnergyAnisotropyLaw{});
  problem.series = points_of(series, [](const ModuliState& s) {
    const double from_A1 = s.A1 + 2.0 / 9 * s.sigma_dev;
    const double from_A2 = 2.0 / 3 * (s.A2 - 2.0 / 3 * s.sigma_dev);
    const double B0 = s.B - 2.0 / 3 * s.P;
    return FitPoint{s.F_dev / s.F_v, 0.5 * (from_A1 + from_A2) / B0, s.sigma_dev / s.P, 0};
  });
  problem.x_resolution = share_resolution;
  problem.parameters = {known_parameter(known, "a_F", 3, -50, 50, 3, 1),
                        known_parameter(known, "a_s", 0.2, -10, 10, 0.3, 0)};
  return problem;
}

FitProblem initial_ratio_problem(const std::vector<ModuliSeries>& series, const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<3>(InitialRatioLaw{});
  for (const ModuliSeries& s : series)
    if (const auto point = initial_ratio(s)) problem.series.push_back({s.test, s.group, {*point}});
  problem.points = Points::runs;
  problem.x_resolution = F_v_resolution;
  problem.starts = 2 * starts;
  problem.parameters = {known_parameter(known, "GB_max", 0.5, 0.05, 3, 0.5, 2),
                        known_parameter(known, "Fv_min", 4.2, 0, 8, 2, 1),
                        known_parameter(known, "Fv_alpha", 2, 0.1, 50, 2, 0)};
  return problem;
}

FitProblem shear_modulus_problem(const std::vector<ModuliSeries>& series, const KnownValues& known) {
  FitProblem problem;
  problem.law = differentiable<1>(DecreaseLaw{});
  for (const ModuliSeries& s : series) {
    const auto initial = initial_ratio(s);
    if (!initial) continue;
    FitSeries points{s.test, s.group, {}};
    for (const ModuliState& state : s.states)
      points.points.push_back({state.sigma_dev * state.F_dev, state.G / state.B - initial->y, 0, 0});
    problem.series.push_back(std::move(points));
  }
  problem.x_resolution = product_resolution;
  problem.parameters = {known_parameter(known, "g_I", 100, -1e4, 1e4, 100)};
  return problem;
}

ModuliFit fit_moduli(const std::vector<ModuliSeries>& series, const model::ContactCurve& contacts, double g3,
                     const KnownValue& nu_c, const KnownValues& known) {
  ModuliFit out;
  out.B_law = bulk_modulus_problem(series, contacts, g3, nu_c, known);
  out.A1_law = first_anisotropy_problem(series, known);
  out.A2_law = second_anisotropy_problem(series, known);
  out.A_law = energy_anisotropy_problem(series, known);
  out.GB_ini_law = initial_ratio_problem(series, known);
  out.G_law = shear_modulus_problem(series, known);
  out.B = fit(out.B_law);
  out.A1 = fit(out.A1_law);
  out.A2 = fit(out.A2_law);
  out.A = fit(out.A_law);
  out.GB_ini = fit(out.GB_ini_law);
  out.G = fit(out.G_law);
  return out;
}

}  // namespace grainlaw::calibrate
