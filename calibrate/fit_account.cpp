#include "grainlaw/calibrate/fit_account.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/calibrate/fit_memory_account.hpp"
#include "grainlaw/calibrate/fit_moduli_account.hpp"
#include "grainlaw/calibrate/fit_near_jamming_account.hpp"
#include "grainlaw/calibrate/fit_volumetric_account.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr const char* nu_label = "volume fraction ν";
constexpr double thesis_nu_c = 0.6653;  // of Table 2.2, where no isotropic test tells

constexpr double narrow_pressure = 4;  // times P_min: from there on the packing laws are fitted once more

/// The states of one mode and role, pooled over tests and seeds.
struct Pool {
  std::vector<PackingSeries> series;
  std::size_t left_out = 0;
};

bool is_shear(const std::string& mode) { return mode == "d2" || mode == "d3"; }

Pool pool_of(const RecordFolder& folder, const std::string& mode, Role role, const Selection& selection,
             std::vector<LeftOut>* left_out) {
  Pool pool;
  for (const TestRecord& test : folder.tests) {
    if (test.mode != mode || test.role != role || test.sheared_along) continue;
    Counted counted;
    PackingSeries series =
        is_shear(mode) ? steady_state(test, selection, counted) : unloading_branch(test, selection, counted);
    if (!counted.reason.empty()) {
      if (left_out != nullptr) left_out->push_back({test.name, role, "packing laws: " + counted.reason});
      continue;
    }
    pool.left_out += counted.left_out;
    pool.series.push_back(std::move(series));
  }
  return pool;
}

std::size_t states_in(const Pool& pool) {
  std::size_t states = 0;
  for (const PackingSeries& series : pool.series) states += series.states.size();
  return states;
}

/// How far each parameter moves when only rows of at least four times the pressure are taken: NaN where these
/// are all rows (`narrow` null).
std::vector<double> shift_of(const PackingFit& base, const PackingFit* narrow, FitResult PackingFit::*law) {
  const FitResult& now = base.*law;
  std::vector<double> shift(now.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  if (narrow == nullptr || !now.ran || !(narrow->*law).ran) return shift;
  for (std::size_t i = 0; i < shift.size(); ++i)
    shift[i] = (narrow->*law).parameters[i].value - now.parameters[i].value;
  return shift;
}

/// The four entries of a mode: C*, C* with C0 free, rattlers, pressure. `narrow` is the fit to the rows of
/// larger pressure, null where these are all rows.
void add_packing_entries(Account& account, const std::string& mode, Role role, const Pool& pool,
                         const PackingFit& fit, const PackingFit* narrow, const Reference& reference,
                         const Selection& selection, const std::string& suffix) {
  FitEntry entry;
  entry.role = role;
  entry.mode = mode;
  entry.x_name = "nu";
  entry.x_label = nu_label;
  entry.selection = is_shear(mode) ? steady_rule(selection) : unloading_rule(selection);
  entry.rows_left_out = pool.left_out;
  entry.thesis = reference.thesis_packing(mode);
  const auto add = [&](const std::string& name, const std::string& law, const std::string& y,
                       const std::string& label, const FitProblem& problem, FitResult PackingFit::*result,
                       double from) {
    entry.name = "isotropic." + mode + "." + name + suffix;
    entry.law = law;
    entry.y_name = y;
    entry.y_label = label;
    entry.problem = problem;
    entry.result = fit.*result;
    entry.curve_from = from;
    entry.shift = is_shear(mode) ? std::vector<double>{} : shift_of(fit, narrow, result);
    account.entries.push_back(entry);
  };
  add("C_star", "C* = C0 + C1 (ν/ν_c − 1)^α (Eq. 2.11)", "C_star", "corrected coordination number C*",
      fit.contacts_law, &PackingFit::contacts, fit.contacts.value("nu_c_contacts"));
  add("C_star_free_C0", "C* = C0 + C1 (ν/ν_c − 1)^α with C0 free, near jamming (Eq. 2.11)", "C_star",
      "corrected coordination number C*", fit.contacts_free_C0_law, &PackingFit::contacts_free_C0,
      fit.contacts_free_C0.value("nu_c_contacts"));
  add("phi_r", "φ_r = φ_c exp[−φ_v (ν/ν_c − 1)] (Eq. 2.12)", "phi_r", "fraction of rattlers φ_r",
      fit.rattlers_law, &PackingFit::rattlers, fit.rattlers.value("nu_c_contacts"));
  entry.known_at = coordination_of(fit);
  add("P", "p = p0 (ν C/ν_c) ε (1 − γ_p ε), ε = ln(ν/ν_c), with the measured C (Eq. 2.14)", "P",
      "pressure P*", fit.pressure_law, &PackingFit::pressure, fit.pressure.value("nu_c"));
}

/// The fit to the rows from account.narrow_P_min on; none where these are all rows, or where the states are
/// means over runs.
std::optional<PackingFit> narrow_fit(const Account& account, const RecordFolder& folder,
                                     const std::string& mode, Role role, const Pool& pool,
                                     const Selection& selection, const KnownValues& fallback) {
  if (is_shear(mode)) return std::nullopt;
  Selection narrow = selection;
  narrow.P_min = account.narrow_P_min;
  const Pool fewer = pool_of(folder, mode, role, narrow, nullptr);
  if (states_in(fewer) == states_in(pool)) return std::nullopt;
  return fit_packing(fewer.series, Points::rows, fallback);
}

void fit_mode(Account& account, const RecordFolder& folder, const std::string& mode, Role role,
              const Reference& reference, const Selection& selection) {
  const bool any = std::any_of(folder.tests.begin(), folder.tests.end(), [&](const TestRecord& test) {
    return test.mode == mode && test.role == role && !test.sheared_along;
  });
  const bool needed = role == Role::fit && (mode == "iso" || mode == "d2");
  if (!any && !needed) return;
  const Pool pool = pool_of(folder, mode, role, selection, &account.left_out);
  // A test of role predict that has nothing for these laws (UNI that only loads) is no fit at all.
  if (pool.series.empty() && !needed) return;
  // What the thesis says takes the place of what is open only where a prediction will use it.
  const KnownValues fallback = role == Role::fit ? reference.packing(mode) : KnownValues{};
  const Points points = is_shear(mode) ? Points::runs : Points::rows;
  const PackingFit fit = fit_packing(pool.series, points, fallback);
  const std::optional<PackingFit> narrow = narrow_fit(account, folder, mode, role, pool, selection, fallback);
  const bool twice = role == Role::predict && account.packing.contains(mode);
  add_packing_entries(account, mode, role, pool, fit, narrow ? &*narrow : nullptr, reference, selection,
                      twice ? ".predict" : "");
  if (role != Role::fit) return;
  account.packing[mode] = fit;
  if (narrow) account.narrow[mode] = *narrow;
}

/// What the shear curve of one run shows: the projection, or the column that stands in for it.
std::string shear_label(const std::string& quantity, bool projected) {
  const std::string name = quantity == "s_dev" ? "stress ratio s_dev" : "fabric F_dev";
  return name + (projected ? " along the mode" : ", signed √(3J₂)");
}

std::string shear_rule(const std::string& quantity, bool projected) {
  const std::string letter = quantity == "s_dev" ? "s" : "F", unit = quantity == "s_dev" ? ", over P" : "";
  if (!projected) return "y is the signed column " + quantity + ", for want of components";
  return "y is the projection of " + letter + "xx, " + letter + "yy, " + letter +
         "zz on the deviator of the mode" + unit;
}

FitEntry run_entry(const TestRecord& test, const std::string& quantity, const ShearCurve& curve,
                   const Counted& counted, const Selection& selection) {
  const bool stress = quantity == "s_dev";
  FitEntry entry;
  entry.name = test.name + "." + quantity;
  entry.law = stress ? "s_dev = s_max − (s_max − s_0) exp(−β_s ε_dev) (Eq. 2.17)"
                     : "F_dev = F_max − (F_max − F_0) exp(−β_F ε_dev) (Eq. 2.18)";
  entry.role = test.role;
  entry.mode = test.mode;
  entry.x_name = "eps_dev";
  entry.x_label = "deviatoric strain ε_dev";
  entry.y_name = quantity;
  entry.y_label = shear_label(quantity, curve.projected);
  entry.selection = loading_rule(selection) + "; " + shear_rule(quantity, curve.projected);
  entry.rows_left_out = counted.left_out;
  entry.problem = approach_problem(curve);
  entry.result = fit(entry.problem);
  return entry;
}

bool is_result(const FitEstimate& e) { return e.determined && !e.at_bound && e.stderr_.has_value(); }

RunValue run_value(const ShearCurve& curve, const FitEstimate& e) {
  return {curve.test, curve.group, curve.nu, e.value, *e.stderr_, false};
}

/// Of the parameter set.
std::string shear_group(const std::string& mode) { return mode == "d2" ? "shear" : "shear_axial"; }

/// The rate, where the run determines it.
void take_rate(Account& account, const TestRecord& test, const ShearCurve& curve, const FitEstimate& beta,
               ShearQuantity target) {
  if (is_result(beta)) {
    account.run_values[test.mode][target].push_back(run_value(curve, beta));
  } else {
    account.left_out.push_back(
        {test.name, test.role,
         shear_group(test.mode) + "." + name_of(target) + ": not determined by this test: " + beta.reason});
  }
}

/// The saturation value: an extrapolation, to be trusted only where the rate of the approach is known; else
/// the mean of what the run has reached.
void take_saturation(Account& account, const TestRecord& test, const ShearCurve& curve, const FitResult& fit,
                     ShearQuantity target, const Selection& selection) {
  std::vector<RunValue>& values = account.run_values[test.mode][target];
  if (is_result(fit["max"]) && is_result(fit["beta"])) {
    values.push_back(run_value(curve, fit["max"]));
  } else if (const auto mean = steady_mean(curve, selection)) {
    values.push_back(*mean);
  } else {
    const std::string open = is_result(fit["max"]) ? fit["beta"].reason : fit["max"].reason;
    account.left_out.push_back({test.name, test.role,
                                shear_group(test.mode) + "." + name_of(target) +
                                    ": not determined by this test: " + open +
                                    ", and it has too few rows of a steady state"});
  }
}

/// Fits s_dev and F_dev of one shear test; one of role fit gives a point each of its mode's laws over volume
/// fraction.
void fit_shear_test(Account& account, const TestRecord& test, const Selection& selection) {
  const std::pair<const char*, std::pair<ShearQuantity, ShearQuantity>> fits[] = {
      {"s_dev", {ShearQuantity::s_max, ShearQuantity::beta_s}},
      {"F_dev", {ShearQuantity::F_max, ShearQuantity::beta_F}}};
  for (const auto& [quantity, gives] : fits) {
    Counted counted;
    const ShearCurve curve = first_loading(test, quantity, selection, counted);
    if (!counted.reason.empty()) {
      account.left_out.push_back({test.name, test.role, std::string(quantity) + ": " + counted.reason});
      continue;
    }
    account.entries.push_back(run_entry(test, quantity, curve, counted, selection));
    const FitResult& r = account.entries.back().result;
    if (test.role != Role::fit) continue;
    take_saturation(account, test, curve, r, gives.first, selection);
    take_rate(account, test, curve, r["beta"], gives.second);
  }
}

/// Which number each run gives to a law over volume fraction, in words.
std::string density_rule(const std::string& mode, const std::vector<RunValue>& values, bool rate,
                         const Selection& selection) {
  if (rate) return "beta of each " + mode + " test whose own fit determines it, all of one weight";
  std::string means;
  for (const RunValue& v : values) {
    if (v.steady_mean) means += (means.empty() ? "" : ", ") + v.test;
  }
  return "max of each " + mode + " test whose own fit determines beta and max, else " +
         steady_mean_rule(selection) + " (" + (means.empty() ? "no test" : means) +
         "); weighted by its standard error";
}

void fit_density(Account& account, const std::string& mode, ShearQuantity quantity, double nu_c_error,
                 const Reference& reference, const Selection& selection) {
  const bool rate = quantity == ShearQuantity::beta_s || quantity == ShearQuantity::beta_F;
  const bool stress = quantity == ShearQuantity::s_max || quantity == ShearQuantity::beta_s;
  const std::vector<RunValue>& values = account.run_values[mode][quantity];
  // The thesis has these laws of D2 alone.
  const KnownValues known = mode == "d2" ? reference.shear(name_of(quantity)) : KnownValues{};
  FitEntry entry;
  entry.name = shear_group(mode) + "." + name_of(quantity);
  entry.law = "Q = Q_max + Q_v exp[−α (ν/ν_c − 1)] (Eq. 2.20)";
  entry.mode = mode;
  entry.x_name = "nu";
  entry.x_label = nu_label;
  entry.y_name = name_of(quantity);
  entry.y_label =
      std::string(rate ? "rate β of the " : "saturation of the ") + (stress ? "stress ratio" : "fabric");
  entry.selection = density_rule(mode, values, rate, selection);
  if (mode == "d2") entry.thesis = reference.thesis_shear(name_of(quantity));
  entry.problem = density_problem(quantity, values, account.nu_c, nu_c_error, known);
  entry.result = fit(entry.problem);
  entry.curve_from = account.nu_c;
  account.density[mode][quantity] = entry.result;
  account.entries.push_back(std::move(entry));
}

}  // namespace

Account fit_all(const RecordFolder& folder, const Reference& reference, const Reference& near_jamming,
                const MeasuredMemory& measured, const Selection& selection) {
  Account account;
  account.left_out = folder.left_out;
  account.narrow_P_min = narrow_pressure * selection.P_min;
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::memory && (test.mode == "mixed" || test.mode == "components")) {
      account.left_out.push_back({test.name, test.role, "its path is not of one mode (iso, uni, d2, d3)"});
    }
  }
  for (const Role role : {Role::fit, Role::predict}) {
    for (const char* mode : {"iso", "uni", "d2", "d3"})
      fit_mode(account, folder, mode, role, reference, selection);
  }
  const FitEstimate& nu_c = account.packing.at("iso").pressure["nu_c"];
  account.nu_c_fitted = account.packing.at("iso").pressure.ran && !nu_c.held && nu_c.determined;
  const KnownValues known = reference.packing("iso");
  const KnownValue thesis = known.contains("nu_c") ? known.at("nu_c") : KnownValue(thesis_nu_c);
  account.nu_c = account.nu_c_fitted ? nu_c.value : thesis.value;
  const double nu_c_error = account.nu_c_fitted ? nu_c.stderr_.value_or(0) : thesis.error;
  for (const TestRecord& test : folder.tests) {
    if (is_shear(test.mode) && test.role != Role::memory && !test.sheared_along)
      fit_shear_test(account, test, selection);
  }
  for (const char* mode : {"d2", "d3"}) {
    if (mode == std::string("d3") && !account.run_values.contains(mode)) continue;
    for (const ShearQuantity quantity : shear_quantities)
      fit_density(account, mode, quantity, nu_c_error, reference, selection);
  }
  fit_moduli_of(account, folder, reference);
  fit_volumetric_of(account, folder, selection);
  fit_memory_of(account, folder, reference, measured, selection);
  fit_near_jamming_of(account, folder, near_jamming, selection);
  return account;
}

Json Account::to_json() const {
  Json json{{"fits", Json::array()}, {"not_determined", Json::array()}, {"left_out", Json::array()}};
  for (const FitEntry& entry : entries) {
    json["fits"].push_back(calibrate::to_json(entry));
    append_not_determined(entry, json["not_determined"]);
  }
  for (const LeftOut& left : left_out) {
    json["left_out"].push_back({{"test", left.name}, {"role", name_of(left.role)}, {"reason", left.reason}});
  }
  if (memory) json["memory"] = memory_json(*this);
  return json;
}

}  // namespace grainlaw::calibrate
