#include "grainlaw/calibrate/fit_near_jamming_account.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

/// Table 5.1 prints gamma_p as 0 +- 0.1.
constexpr double gamma_p_range = 0.1;

KnownValues known_packing(const Reference& tables, const std::string& mode) {
  KnownValues known = tables.packing(mode);
  if (const auto found = known.find("gamma_p"); found != known.end()) found->second.error = gamma_p_range;
  return known;
}

std::size_t states_in(const std::vector<PackingSeries>& series) {
  std::size_t states = 0;
  for (const PackingSeries& s : series) states += s.states.size();
  return states;
}

std::string range_rule(double nu_max) { return "; nu <= " + to_text(std::round(nu_max * 1e4) / 1e4); }

/// The three entries of one column of Table 5.1.
void add_column(Account& account, const std::string& row, const std::string& mode, const PackingFit& fit,
                const std::string& selection, const KnownValues& thesis) {
  FitEntry entry;
  entry.mode = mode;
  entry.x_name = "nu";
  entry.x_label = "volume fraction ν";
  entry.selection = selection;
  entry.thesis = thesis;
  const auto add = [&](const std::string& y, const std::string& law, const std::string& label,
                       const FitProblem& problem, const FitResult& result) {
    entry.name = "near_jamming." + row + "." + y;
    entry.law = law;
    entry.y_name = y;
    entry.y_label = label;
    entry.problem = problem;
    entry.result = result;
    account.entries.push_back(entry);
  };
  add("C_star", "C* = C0 + C1 (ν/φ_J − 1)^θ (Eq. 5.7)", "corrected coordination number C*", fit.contacts_law,
      fit.contacts);
  add("phi_r", "1 − f_NR = φ_c exp[−φ_v (ν/φ_J − 1)] (Eq. 5.8)", "fraction of rattlers φ_r", fit.rattlers_law,
      fit.rattlers);
  entry.known_at = coordination_of(fit);
  add("P", "p = p0 (ν C/φ_J) ε (1 − γ_p ε), ε = ln(ν/φ_J), with the measured C (Eq. 5.9)", "pressure P*",
      fit.pressure_law, fit.pressure);
}

void add_density_law(Account& account, ShearQuantity quantity, const std::string& selection,
                     const Reference& tables) {
  FitEntry entry;
  entry.name = "near_jamming." + name_of(quantity);
  entry.law = "Q = Q_a + Q_c exp[−Ψ (ν/φ_SJ − 1)] (Eq. 5.12)";
  entry.mode = "d2";
  entry.x_name = "nu";
  entry.x_label = "volume fraction ν";
  entry.y_name = name_of(quantity);
  entry.y_label = name_of(quantity);
  entry.selection = selection;
  entry.thesis = tables.thesis_shear(name_of(quantity));
  entry.problem = account.near_jamming->shear_law.at(quantity);
  entry.result = account.near_jamming->shear.at(quantity);
  account.entries.push_back(std::move(entry));
}

}  // namespace

void fit_near_jamming_of(Account& account, const RecordFolder& folder, const Reference& tables,
                         const Selection& selection) {
  if (!account.memory || !account.memory->phi_SJ.found()) return;
  const KnownValue phi_SJ{account.memory->phi_SJ.value, account.memory->phi_SJ.error};
  const double nu_max = phi_SJ.value * (1 + near_jamming_range);
  const NearJammingData data = near_jamming_data(folder.tests, account.relaxed, nu_max, selection);
  if (data.unloading.empty() || data.flowing.empty()) return;
  NearJammingKnown known{known_packing(tables, "iso"), known_packing(tables, "d2"), {}};
  for (const ShearQuantity quantity : shear_quantities)
    known.shear[quantity] = tables.shear(name_of(quantity));
  account.near_jamming = fit_near_jamming(data, phi_SJ, known);
  const std::string range = range_rule(nu_max);
  add_column(account, "iso", "iso", account.near_jamming->isotropic, unloading_rule(selection) + range,
             tables.thesis_packing("iso"));
  add_column(account, "d2", "d2", account.near_jamming->flowing, steady_rule(selection) + range,
             tables.thesis_packing("d2"));
  if (states_in(data.resting) > 0)
    add_column(account, "d2_at_rest", "d2", account.near_jamming->resting,
               "means of the rests of a run beyond the strain of steady states" + range,
               tables.thesis_packing("d2"));
  for (const ShearQuantity quantity : shear_quantities)
    add_density_law(account, quantity, loading_rule(selection) + "; one value of each run" + range, tables);
}

std::optional<model::NearJammingLaws> near_jamming_laws(const Account& account, const Reference& tables) {
  if (!account.near_jamming) return std::nullopt;
  const NearJammingFit& fit = *account.near_jamming;
  const auto iso = packing_law(fit.isotropic, tables.packing("iso"), tables.thesis_packing("iso"), tables);
  const auto d2 = packing_law(fit.flowing, tables.packing("d2"), tables.thesis_packing("d2"), tables);
  if (!iso || !d2) return std::nullopt;
  model::NearJammingLaws laws;
  laws.iso = *iso;
  laws.d2 = *d2;
  const std::pair<ShearQuantity, model::SaturationLaw model::NearJammingLaws::*> rows[] = {
      {ShearQuantity::s_max, &model::NearJammingLaws::s_max},
      {ShearQuantity::beta_s, &model::NearJammingLaws::beta_s},
      {ShearQuantity::F_max, &model::NearJammingLaws::F_max},
      {ShearQuantity::beta_F, &model::NearJammingLaws::beta_F}};
  for (const auto& [quantity, member] : rows) {
    const std::string name = name_of(quantity);
    const FitResult& result = fit.shear.at(quantity);
    auto row = saturation_law(result, tables.shear(name), tables.thesis_shear(name), tables);
    if (!row) return std::nullopt;
    if (row->nu_c.value == account.memory->phi_SJ.value) {
      row->nu_c.source = "fit";
      row->nu_c.note = "phi_SJ of memory";
    }
    if (result["Q_max"].determined && row->Q_max.source == "assumed")
      row->Q_max.note = "held at 0, as in Table 5.2";
    laws.*member = *row;
  }
  return laws;
}

}  // namespace grainlaw::calibrate
