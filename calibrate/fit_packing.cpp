#include "grainlaw/calibrate/fit_packing.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/calibrate/fit_law.hpp"

namespace grainlaw::calibrate {
namespace {

/// Volume fractions closer than this say the same about a law over volume fraction.
constexpr double nu_resolution = 2e-3;
constexpr int starts = 12;

struct ContactsLaw {  // C0, C1, alpha, nu_c
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::pow;
    return p[0] + p[1] * pow(at.x / p[3] - 1.0, p[2]);
  }
};

struct RattlersLaw {  // phi_c, phi_v, nu_c
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::exp;
    return p[0] * exp(-p[1] * (at.x / p[2] - 1.0));
  }
};

struct PressureLaw {  // p0, gamma_p, nu_c; the measured C is at.known
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::log;
    const T e = log(at.x / p[2]);
    return p[0] * (at.x * at.known / p[2]) * e * (1.0 - p[1] * e);
  }
};

template <class Take>
std::vector<FitSeries> points_of(const std::vector<PackingSeries>& series, Take take) {
  std::vector<FitSeries> out;
  for (const PackingSeries& s : series) {
    FitSeries points{s.test, s.group, {}};
    for (const PackingState& state : s.states) points.points.push_back(take(state));
    out.push_back(std::move(points));
  }
  return out;
}

double lowest_nu(const std::vector<PackingSeries>& series) {
  double lowest = 1;
  for (const PackingSeries& s : series) {
    for (const PackingState& state : s.states) lowest = std::min(lowest, state.nu);
  }
  return lowest;
}

/// The volume fraction at which a law begins, up to `high`, just below the lowest one of the data.
FitParameter jamming(const KnownValues& known, const std::string& name, double lowest, double high) {
  FitParameter p = known_parameter(known, name, lowest - 0.005, lowest - 0.15, high, 0.02, 1);
  p.bounds_follow_data = true;
  return p;
}

}  // namespace

FitParameter known_parameter(const KnownValues& known, const std::string& name, double initial, double low,
                             double high, double scale, int hold_order) {
  FitParameter p;
  p.name = name;
  p.initial = std::clamp(initial, low, high);
  p.low = low;
  p.high = high;
  p.scale = scale;
  if (const auto found = known.find(name); found != known.end()) {
    p.fallback = found->second.value;
    p.fallback_error = found->second.error;
  }
  p.hold_order = hold_order;
  return p;
}

FitProblem contacts_problem(const std::vector<PackingSeries>& series, Points points, const KnownValues& known,
                            bool free_C0) {
  const double lowest = lowest_nu(series);
  FitProblem problem;
  problem.law = differentiable<4>(ContactsLaw{});
  problem.series = points_of(series, [](const PackingState& s) {
    return FitPoint{s.nu, s.C_star, 0, s.C_star_error};
  });
  problem.points = points;
  problem.x_resolution = nu_resolution;
  problem.starts = starts;
  FitParameter C0 = known_parameter(known, "C0", 6, 3, 9, 1, 3);
  C0.held = !free_C0;
  problem.parameters = {C0, known_parameter(known, "C1", 8, 0.5, 40, 8, 2),
                        known_parameter(known, "alpha", 0.6, 0.15, 2, 0.5, 0),
                        jamming(known, "nu_c_contacts", lowest, lowest * (1 - 1e-10))};
  return problem;
}

FitProblem rattlers_problem(const std::vector<PackingSeries>& series, Points points, const KnownValues& known,
                            double nu_c_contacts, double nu_c_error) {
  FitProblem problem;
  problem.law = differentiable<3>(RattlersLaw{});
  problem.series = points_of(series, [](const PackingState& s) {
    return FitPoint{s.nu, s.phi_r, 0, s.phi_r_error};
  });
  problem.points = points;
  problem.x_resolution = nu_resolution;
  problem.starts = starts;
  FitParameter nu_c = known_parameter({}, "nu_c_contacts", nu_c_contacts, 0, 1, 0.02, 2);
  nu_c.held = true;
  nu_c.held_error = nu_c_error;
  problem.parameters = {known_parameter(known, "phi_c", 0.13, 1e-4, 0.99, 0.1, 1),
                        known_parameter(known, "phi_v", 15, 0.1, 100, 15, 0), nu_c};
  return problem;
}

FitProblem pressure_problem(const std::vector<PackingSeries>& series, Points points,
                            const KnownValues& known) {
  const double lowest = lowest_nu(series);
  FitProblem problem;
  problem.law = differentiable<3>(PressureLaw{});
  problem.series = points_of(series, [](const PackingState& s) {
    return FitPoint{s.nu, s.P, s.C, s.P_error};
  });
  problem.points = points;
  problem.x_resolution = nu_resolution;
  problem.starts = starts;
  problem.parameters = {known_parameter(known, "p0", 0.042, 1e-3, 0.5, 0.04, 2),
                        known_parameter(known, "gamma_p", 0.05, -5, 5, 1, 0),
                        jamming(known, "nu_c", lowest, lowest)};
  return problem;
}

std::vector<PackingSeries> near_jamming(const std::vector<PackingSeries>& series) {
  const double highest = lowest_nu(series) * (1 + free_C0_range);
  std::vector<PackingSeries> near = series;
  for (PackingSeries& s : near)
    std::erase_if(s.states, [&](const PackingState& state) { return state.nu > highest; });
  return near;
}

std::function<double(double)> coordination_of(const PackingFit& fit) {
  if (!fit.contacts.ran || !fit.rattlers.ran) return {};
  return [contacts = fit.contacts_law.law, rattlers = fit.rattlers_law.law, c = fit.contacts.values(),
          r = fit.rattlers.values()](double nu) {
    const FitPoint at{nu, 0, 0, 0};
    return (1 - rattlers(r, at, {})) * contacts(c, at, {});
  };
}

PackingFit fit_packing(const std::vector<PackingSeries>& series, Points points, const KnownValues& known) {
  PackingFit out;
  out.contacts_law = contacts_problem(series, points, known);
  out.contacts = fit(out.contacts_law);
  KnownValues known_free = known;
  known_free.emplace("C0", 6);
  out.contacts_free_C0_law = contacts_problem(near_jamming(series), points, known_free, true);
  out.contacts_free_C0 = fit(out.contacts_free_C0_law);
  const FitEstimate& nu_c = out.contacts["nu_c_contacts"];
  if (std::isfinite(nu_c.value)) {
    out.rattlers_law = rattlers_problem(series, points, known, nu_c.value, nu_c.stderr_.value_or(0));
    out.rattlers = fit(out.rattlers_law);
  } else {
    out.rattlers_law = rattlers_problem(series, points, known, lowest_nu(series), 0);
    out.rattlers =
        not_fitted(out.rattlers_law, "nu_c_contacts is not determined, and this law counts from it");
    out.rattlers.parameters.back().value = nu_c.value;
  }
  out.pressure_law = pressure_problem(series, points, known);
  out.pressure = fit(out.pressure_law);
  return out;
}

}  // namespace grainlaw::calibrate
