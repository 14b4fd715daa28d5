#include "grainlaw/calibrate/memory_branches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr double gamma_p_error = 0.1;  // Table 5.1: gamma_p = 0 +- 0.1
/// Volume fractions of two compressions that count as one.
constexpr double same_phi_max = 1e-6;
constexpr std::size_t fewest_rows = 3;

double nu_at(const TestRecord& test, double eps_vol) { return test.nu_start * std::exp(eps_vol); }

KnownValue known(const KnownValues& laws, const std::string& name) {
  const auto found = laws.find(name);
  if (found == laws.end()) throw Error("", name, "the branches need it, and no fit or thesis gives it");
  return found->second;
}

/// Holds a parameter at a known value, whose error goes into that of the jamming density.
void hold(FitParameter& p, double value, double error) {
  p.held = true;
  p.initial = value;
  p.held_error = error;
}

void hold(FitParameter& p, const KnownValues& laws) {
  const KnownValue at = known(laws, p.name);
  hold(p, at.value, at.error);
}

Estimate jamming(FitProblem problem, const std::string& name, FitResult* whole = nullptr) {
  problem.starts = 1;
  problem.x_resolution = 0;
  const FitResult result = fit(problem);
  if (whole != nullptr) *whole = result;
  const FitEstimate& e = result[name];
  if (!result.ran || !e.determined || !e.stderr_) return {};
  return {e.value, *e.stderr_};
}

double relative_range(const PackingSeries& branch) {
  double low = 1, high = 0;
  for (const PackingState& s : branch.states) {
    low = std::min(low, s.nu);
    high = std::max(high, s.nu);
  }
  return high / low - 1;
}

/// Eq. 5.4 with the measured C.
void extrapolate_pressure(const PackingSeries& branch, const KnownValues& laws, CycleDensity& out) {
  FitProblem problem = pressure_problem({branch}, Points::rows, {});
  FitParameter &p0 = problem.parameters[0], &gamma_p = problem.parameters[1];
  hold(gamma_p, 0, gamma_p_error);
  if (relative_range(branch) < branch_slope_range) hold(p0, laws);
  FitResult whole;
  out.from_P = jamming(problem, "nu_c", &whole);
  out.p0 = whole.value("p0");
}

/// Eq. 5.7.
Estimate extrapolate_contacts(const PackingSeries& branch, const KnownValues& laws) {
  FitProblem problem = contacts_problem({branch}, Points::rows, {});
  for (FitParameter& p : problem.parameters)
    if (p.name != "nu_c_contacts") hold(p, laws);
  return jamming(problem, "nu_c_contacts");
}

/// Eq. 5.8.
Estimate extrapolate_rattlers(const PackingSeries& branch, const KnownValues& laws) {
  const double lowest = branch.states.back().nu;
  FitProblem problem = rattlers_problem({branch}, Points::rows, {}, lowest, 0);
  for (FitParameter& p : problem.parameters) {
    if (p.name != "nu_c_contacts") {
      hold(p, laws);
      continue;
    }
    // Here the contacts' own phi_J is what is asked for, and rattlers alone set no bound to it.
    p.held = false;
    p.low = lowest - 0.1;
    p.high = lowest + 0.1;
  }
  return jamming(problem, "nu_c_contacts");
}

/// Jammed rows of a leg, near jamming.
PackingSeries branch_of(const TestRecord& test, std::size_t leg, const Selection& selection) {
  Counted counted;
  PackingSeries branch = unloading_leg(test, leg, selection, counted);
  double lowest = 1;
  for (const PackingState& s : branch.states) lowest = std::min(lowest, s.nu);
  std::erase_if(branch.states, [&](const PackingState& s) { return s.nu > lowest * (1 + branch_range); });
  return branch;
}

CycleDensity density_of(const PackingSeries& branch, const KnownValues& laws) {
  CycleDensity out;
  out.test = branch.test;
  out.group = branch.group;
  out.p0 = std::numeric_limits<double>::quiet_NaN();
  out.rows = branch.states.size();
  if (out.rows < fewest_rows) return out;
  extrapolate_pressure(branch, laws, out);
  out.from_C_star = extrapolate_contacts(branch, laws);
  out.from_f_NR = extrapolate_rattlers(branch, laws);
  return out;
}

}  // namespace

Estimate::Estimate()
    : value(std::numeric_limits<double>::quiet_NaN()), error(std::numeric_limits<double>::quiet_NaN()) {}

bool Estimate::known() const { return std::isfinite(value); }

std::vector<CycleDensity> cycle_densities(const TestRecord& test, const KnownValues& laws,
                                          const Selection& selection) {
  std::vector<CycleDensity> cycles;
  double phi_max = test.nu_start;
  double M = 0;
  for (std::size_t i = 0; i < test.legs.size(); ++i) {
    const Leg& leg = test.legs[i];
    const double from = nu_at(test, leg.eps_vol[0]), to = nu_at(test, leg.eps_vol[1]);
    if (to > phi_max * (1 + same_phi_max)) {
      phi_max = to;
      M = 0;
    }
    if (to >= from || from < phi_max * (1 - same_phi_max)) continue;
    CycleDensity cycle = density_of(branch_of(test, i, selection), laws);
    cycle.leg = i;
    cycle.phi_max = phi_max;
    cycle.M = ++M;
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

std::string cycle_rule(const Selection& selection) {
  return "one point per unloading from the largest volume fraction so far: rows with P >= " +
         to_text(selection.P_min) + " and Ek_over_Ep <= " + to_text(selection.Ek_over_Ep_max) +
         ", up to a volume fraction " + to_text(branch_range) +
         " above the lowest of them, with p extrapolated to 0 by Eq. 5.4 at gamma_p = 0";
}

}  // namespace grainlaw::calibrate
