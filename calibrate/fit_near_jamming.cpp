#include "grainlaw/calibrate/fit_near_jamming.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace grainlaw::calibrate {
namespace {

/// Volume fractions closer than this count as one.
constexpr double nu_resolution = 5e-4;

bool is_result(const FitEstimate& e) { return e.determined && !e.at_bound && e.stderr_.has_value(); }

struct MeanOf {
  double value, error;
};

/// Mean of independent values, with its standard error.
template <class Take>
MeanOf mean_of(const std::vector<RelaxedState>& states, Take take) {
  const auto n = static_cast<double>(states.size());
  double sum = 0, squares = 0;
  for (const RelaxedState& s : states) sum += take(s);
  for (const RelaxedState& s : states) squares += std::pow(take(s) - sum / n, 2);
  return {sum / n, std::sqrt(squares / ((n - 1) * n))};
}

PackingSeries state_of(const std::vector<RelaxedState>& rests) {
  const MeanOf P = mean_of(rests, [](const RelaxedState& s) { return s.P; });
  const MeanOf C = mean_of(rests, [](const RelaxedState& s) { return s.C; });
  const MeanOf C_star = mean_of(rests, [](const RelaxedState& s) { return s.C_star; });
  const MeanOf phi_r = mean_of(rests, [](const RelaxedState& s) { return 1 - s.C / s.C_star; });
  const RelaxedState& first = rests.front();
  return {first.test,
          first.group,
          {{first.nu, P.value, C.value, C_star.value, phi_r.value, P.error, C_star.error, phi_r.error}}};
}

/// The saturation and the rate that one run gives of one quantity.
void take_values(std::map<ShearQuantity, std::vector<RunValue>>& values, const ShearCurve& curve,
                 ShearQuantity saturation, ShearQuantity rate, const Selection& selection) {
  const FitResult r = fit_approach(curve);
  const auto value = [&](const FitEstimate& e) {
    return RunValue{curve.test, curve.group, curve.nu, e.value, *e.stderr_, false};
  };
  if (is_result(r["beta"])) values[rate].push_back(value(r["beta"]));
  if (is_result(r["beta"]) && is_result(r["max"])) {
    values[saturation].push_back(value(r["max"]));
  } else if (const auto mean = steady_mean(curve, selection)) {
    values[saturation].push_back(*mean);
  }
}

void keep_up_to(std::vector<PackingSeries>& series, double nu_max) {
  for (PackingSeries& s : series)
    std::erase_if(s.states, [&](const PackingState& state) { return state.nu > nu_max; });
  std::erase_if(series, [](const PackingSeries& s) { return s.states.empty(); });
}

void hold(FitProblem& problem, const std::string& name, const KnownValue& at) {
  for (FitParameter& p : problem.parameters) {
    if (p.name != name) continue;
    p.held = true;
    p.initial = at.value;
    p.held_error = at.error;
  }
}

/// C*, rattlers and pressure with one given nu_c.
PackingFit packing_from(const std::vector<PackingSeries>& series, const KnownValue& nu_c,
                        const KnownValues& known) {
  PackingFit out;
  out.contacts_law = contacts_problem(series, Points::runs, known);
  out.rattlers_law = rattlers_problem(series, Points::runs, known, nu_c.value, nu_c.error);
  out.pressure_law = pressure_problem(series, Points::runs, known);
  hold(out.contacts_law, "nu_c_contacts", nu_c);
  hold(out.pressure_law, "nu_c", nu_c);
  out.contacts = fit(out.contacts_law);
  out.rattlers = fit(out.rattlers_law);
  out.pressure = fit(out.pressure_law);
  return out;
}

}  // namespace

std::vector<PackingSeries> resting_states(const std::vector<RelaxedState>& states,
                                          const Selection& selection) {
  std::map<std::pair<std::string, double>, std::vector<RelaxedState>> runs;
  for (const RelaxedState& s : states)
    if (std::abs(s.eps_dev) >= steady_strain) runs[{s.test, s.nu}].push_back(s);
  const auto pushes = [&](double nu) {
    return std::none_of(states.begin(), states.end(), [&](const RelaxedState& s) {
      return std::abs(s.nu - nu) < nu_resolution && std::abs(s.eps_dev) >= steady_strain &&
             s.P < selection.P_min;
    });
  };
  std::vector<PackingSeries> out;
  for (const auto& [run, rests] : runs)
    if (rests.size() > 1 && pushes(run.second)) out.push_back(state_of(rests));
  return out;
}

std::map<ShearQuantity, std::vector<RunValue>> loading_values(const std::vector<TestRecord>& tests,
                                                              const Selection& selection) {
  std::map<ShearQuantity, std::vector<RunValue>> values;
  for (const TestRecord& test : tests) {
    if (test.mode != "d2" || test.role != Role::fit || test.sheared_along) continue;
    for (const bool stress : {true, false}) {
      Counted counted;
      const ShearCurve curve = first_loading(test, stress ? "s_dev" : "F_dev", selection, counted);
      if (!counted.reason.empty()) continue;
      take_values(values, curve, stress ? ShearQuantity::s_max : ShearQuantity::F_max,
                  stress ? ShearQuantity::beta_s : ShearQuantity::beta_F, selection);
    }
  }
  return values;
}

NearJammingData near_jamming_data(const std::vector<TestRecord>& tests,
                                  const std::vector<RelaxedState>& rests, double nu_max,
                                  const Selection& selection) {
  NearJammingData data;
  for (const TestRecord& test : tests) {
    if (test.role != Role::fit || test.sheared_along) continue;
    Counted counted;
    if (test.mode == "iso") data.unloading.push_back(unloading_branch(test, selection, counted));
    if (test.mode == "d2") data.flowing.push_back(steady_state(test, selection, counted));
  }
  data.resting = resting_states(rests, selection);
  for (auto* series : {&data.unloading, &data.flowing, &data.resting}) keep_up_to(*series, nu_max);
  data.runs = loading_values(tests, selection);
  for (auto& [quantity, values] : data.runs)
    std::erase_if(values, [&](const RunValue& v) { return v.nu > nu_max; });
  return data;
}

NearJammingFit fit_near_jamming(const NearJammingData& data, const KnownValue& phi_SJ,
                                const NearJammingKnown& known) {
  NearJammingFit out;
  out.isotropic = fit_packing(data.unloading, Points::rows, known.isotropic);
  out.flowing = fit_packing(data.flowing, Points::runs, known.sheared);
  out.resting = fit_packing(data.resting, Points::runs, known.sheared);
  out.flowing_from_phi_SJ = packing_from(data.flowing, phi_SJ, known.sheared);
  for (const ShearQuantity quantity : shear_quantities) {
    const auto values = data.runs.find(quantity);
    const auto held = known.shear.find(quantity);
    FitProblem& law = out.shear_law[quantity];
    law =
        density_problem(quantity, values != data.runs.end() ? values->second : std::vector<RunValue>{},
                        phi_SJ.value, phi_SJ.error, held != known.shear.end() ? held->second : KnownValues{});
    out.shear[quantity] = fit(law);
  }
  return out;
}

}  // namespace grainlaw::calibrate
