#include "grainlaw/calibrate/memory_relaxed.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace grainlaw::calibrate {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double gamma_p_error = 0.1;   // Table 5.1: gamma_p = 0 +- 0.1
constexpr double nu_resolution = 5e-4;  ///< volume fractions closer than this count as one

std::optional<std::size_t> last_row_of(const TestRecord& test, std::size_t leg) {
  const std::vector<double>& segment = test.rows["segment"];
  for (std::size_t i = segment.size(); i > 0; --i)
    if (static_cast<std::size_t>(segment[i - 1]) == leg) return i - 1;
  return std::nullopt;
}

bool follows_shear(const TestRecord& test, std::size_t leg) {
  return leg > 0 && test.legs[leg].mode == Mode::relax && test.legs[leg - 1].mode == Mode::d2;
}

RelaxedState state_at(const TestRecord& test, std::size_t rest, std::size_t flow) {
  RelaxedState out;
  out.test = test.name;
  out.group = test.seed;
  out.nu = test.rows["nu"][rest];
  out.eps_dev = test.rows["eps_dev"][rest];
  out.P_flow = test.rows["P"][flow];
  out.P = test.rows["P"][rest];
  out.s_dev = test.rows["s_dev"][rest];
  out.C = test.rows["C"][rest];
  out.C_star = test.rows["C_star"][rest];
  out.percolating = test.rows.has("percolating") ? test.rows["percolating"][rest] : nan;
  return out;
}

/// Where a stress of these states vanishes over nu, of their own slope.
Estimate vanishing(const std::vector<RelaxedState>& states,
                   const std::function<double(const RelaxedState&)>& stress) {
  std::vector<PackingSeries> series;
  for (const RelaxedState& s : states) {
    PackingState state;
    state.nu = s.nu;
    state.P = stress(s);
    state.C = s.C;
    if (series.empty() || series.back().test != s.test) series.push_back({s.test, s.group, {}});
    series.back().states.push_back(state);
  }
  if (series.empty()) return {};
  FitProblem problem = pressure_problem(series, Points::rows, {});
  problem.x_resolution = nu_resolution;
  FitParameter& gamma_p = problem.parameters[1];
  gamma_p.held = true;
  gamma_p.initial = 0;
  gamma_p.held_error = gamma_p_error;
  const FitResult result = fit(problem);
  const FitEstimate& nu_c = result["nu_c"];
  if (!result.ran || !nu_c.determined || !nu_c.stderr_) return {};
  return {nu_c.value, *nu_c.stderr_};
}

}  // namespace

bool rests_along_shear(const TestRecord& test) {
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg)
    if (follows_shear(test, leg)) return true;
  return false;
}

std::vector<RelaxedState> relaxed_states(const TestRecord& test, const CycleDensity& from) {
  std::vector<RelaxedState> out;
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg) {
    if (!follows_shear(test, leg)) continue;
    const auto rest = last_row_of(test, leg), flow = last_row_of(test, leg - 1);
    if (!rest || !flow) continue;
    RelaxedState state = state_at(test, *rest, *flow);
    state.phi_max = from.phi_max;
    state.M = from.M;
    state.phi_J0 = from.from_P;
    out.push_back(state);
  }
  return out;
}

RelaxedLimit relaxed_limit(const std::vector<RelaxedState>& states, const Selection& selection) {
  std::vector<RelaxedState> steady;
  for (const RelaxedState& s : states)
    if (std::abs(s.eps_dev) >= steady_strain) steady.push_back(s);
  const std::vector<RelaxedState> all = steady;
  const auto idle = [&](const RelaxedState& other) { return other.P < selection.P_min; };
  std::erase_if(steady, [&](const RelaxedState& s) {
    return std::any_of(all.begin(), all.end(), [&](const RelaxedState& other) {
      return idle(other) && std::abs(other.nu - s.nu) < nu_resolution;
    });
  });
  RelaxedLimit out;
  out.states = steady.size();
  out.by_pressure = vanishing(steady, [](const RelaxedState& s) { return s.P; });
  out.by_shear_stress = vanishing(steady, [](const RelaxedState& s) { return std::abs(s.s_dev) * s.P; });
  return out;
}

}  // namespace grainlaw::calibrate
