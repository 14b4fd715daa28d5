#include "grainlaw/calibrate/fit_memory_account.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "grainlaw/calibrate/fit_errors.hpp"

namespace grainlaw::calibrate {
namespace {

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// C0, C1, alpha, phi_c, phi_v and p0 of isotropic.iso: as fitted, or what the fit fell back to.
KnownValues branch_laws(const PackingFit& fit) {
  KnownValues laws;
  for (const FitResult* result : {&fit.contacts, &fit.rattlers, &fit.pressure})
    for (const FitEstimate& e : result->parameters)
      if (std::isfinite(e.value)) laws.emplace(e.name, KnownValue(e.value, e.stderr_.value_or(0)));
  return laws;
}

bool complete(const KnownValues& laws) {
  const auto knows = [&](const char* name) { return laws.contains(name); };
  return knows("C0") && knows("C1") && knows("alpha") && knows("phi_c") && knows("phi_v") && knows("p0");
}

void read_cycles(Account& account, const RecordFolder& folder, const KnownValues& laws,
                 const Selection& selection) {
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::memory || test.mode != "iso" || test.sheared_along) continue;
    const auto cycles = cycle_densities(test, laws, selection);
    const auto open =
        std::count_if(cycles.begin(), cycles.end(), [](const CycleDensity& c) { return !c.from_P.known(); });
    if (cycles.empty() || open > 0)
      account.left_out.push_back(
          {test.name, test.role,
           "memory: " + (cycles.empty()
                             ? "its path never unloads from its largest volume fraction"
                             : std::to_string(open) + " of " + std::to_string(cycles.size()) +
                                   " cycles are not jammed over enough rows for a jamming density")});
    account.cycles.insert(account.cycles.end(), cycles.begin(), cycles.end());
  }
}

/// The cycle whose unloading this test starts from.
std::optional<CycleDensity> origin_of(const Account& account, const TestRecord& test) {
  if (!test.from) return std::nullopt;
  for (const CycleDensity& c : account.cycles)
    if (c.test == test.from->record && c.leg == test.from->leg) return c;
  return std::nullopt;
}

/// A packing that others start from, brought to rest.
bool only_relaxes(const TestRecord& test) {
  return std::all_of(test.legs.begin(), test.legs.end(),
                     [](const Leg& leg) { return leg.mode == Mode::relax; });
}

const TestRecord* find(const RecordFolder& folder, const std::string& name) {
  const auto found = std::find_if(folder.tests.begin(), folder.tests.end(),
                                  [&](const TestRecord& test) { return test.name == name; });
  return found != folder.tests.end() ? &*found : nullptr;
}

/// The largest volume fraction of the records that this one starts from; 0 where none is there.
double largest_before(const RecordFolder& folder, const TestRecord& test) {
  const TestRecord* from = test.from ? find(folder, test.from->record) : nullptr;
  return from != nullptr ? std::max(largest_nu(*from, test.from->leg), largest_before(folder, *from)) : 0;
}

bool is_tapped(const TestRecord& test) {
  return test.role == Role::memory && test.mode == "iso" && test.sheared_along && test.from;
}

void read_tapped(Account& account, const RecordFolder& folder, const KnownValues& laws,
                 const Selection& selection) {
  for (const TestRecord& test : folder.tests) {
    if (!is_tapped(test)) continue;
    const TestRecord* sheared = find(folder, test.from->record);
    if (sheared == nullptr || sheared->mode != "d2") {
      account.left_out.push_back({test.name, test.role, "memory: it does not start from a d2 test"});
      continue;
    }
    for (TappedDensity& one : tapped_density(test, *sheared, laws, selection)) {
      one.phi_max = largest_before(folder, *sheared);
      account.tapped.push_back(std::move(one));
    }
  }
}

/// A shear at one volume fraction from which unloadings of this folder start.
bool taps(const RecordFolder& folder, const TestRecord& test) {
  return std::any_of(folder.tests.begin(), folder.tests.end(), [&](const TestRecord& other) {
    return is_tapped(other) && other.from->record == test.name;
  });
}

void read_shear(Account& account, const RecordFolder& folder, const Selection& selection) {
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::memory || test.mode == "iso" || only_relaxes(test)) continue;
    if (test.mode == "d2" && taps(folder, test)) continue;
    const auto from = origin_of(account, test);
    if (test.mode == "d2" && from && from->from_P.known() && rests_along_shear(test)) {
      const auto states = relaxed_states(test, *from);
      account.relaxed.insert(account.relaxed.end(), states.begin(), states.end());
      continue;
    }
    if (test.mode == "d2" && from && from->from_P.known()) {
      const auto runs = shear_jammings(test, *from, selection);
      account.shear_jammings.insert(account.shear_jammings.end(), runs.begin(), runs.end());
      continue;
    }
    account.left_out.push_back({test.name, test.role,
                                test.mode != "d2"
                                    ? "memory: it is neither iso nor d2"
                                    : "memory: it does not start from the unloading of a test of "
                                      "role memory with a jamming density"});
  }
}

/// False where the branches cannot be extrapolated.
bool read_tests(Account& account, const RecordFolder& folder, const Selection& selection) {
  const KnownValues laws = branch_laws(account.packing.at("iso"));
  if (!complete(laws)) {
    account.left_out.push_back(
        {"memory", Role::memory, "its branches need the laws of isotropic.iso, which are open"});
    return false;
  }
  read_cycles(account, folder, laws, selection);
  read_tapped(account, folder, laws, selection);
  read_shear(account, folder, selection);
  return true;
}

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

FitEntry over_compression_entry(const MemoryFit& fit, const Account& account, const Selection& selection) {
  FitEntry entry;
  entry.name = "memory.phi_J";
  entry.law = "φ_J = φ_SJ + α_max (φ_max/φ_SJ − 1)^α_φ {1 − exp[−(M/µ)^β]} (Eqs. 5.1, 5.5)";
  entry.mode = "iso";
  entry.x_name = "phi_max";
  entry.x_label = "largest volume fraction φ_max";
  entry.y_name = "phi_J";
  entry.y_label = "jamming density φ_J";
  entry.known_name = "M";
  entry.selection = cycle_rule(selection);
  entry.rows_left_out = static_cast<std::size_t>(std::count_if(
      account.cycles.begin(), account.cycles.end(), [](const auto& c) { return !c.from_P.known(); }));
  entry.problem = fit.over_compression_law;
  entry.result = fit.over_compression;
  entry.known_at = [](double) { return 1.0; };
  return entry;
}

double middle_density(const FitProblem& problem) {
  std::vector<double> values;
  for (const FitSeries& s : problem.series)
    for (const FitPoint& p : s.points) values.push_back(p.known);
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

FitEntry shear_entry(const MemoryFit& fit, const Selection& selection) {
  FitEntry entry;
  entry.name = "memory.eps_SJ";
  entry.law = "ε_SJ = ε0 {−ln[(φ − φ_SJ)/(φ_J − φ_SJ)]}^(1/α) (Eq. 5.2)";
  entry.mode = "d2";
  entry.x_name = "nu";
  entry.x_label = "volume fraction ν";
  entry.y_name = "eps_SJ";
  entry.y_label = "strain to jam ε_SJ";
  entry.known_name = "phi_J0";
  entry.selection =
      shear_jamming_rule(selection) + "; first loadings of packings below their jamming density";
  entry.problem = fit.shear_law;
  entry.result = fit.shear;
  entry.known_at = [phi_J0 = middle_density(fit.shear_law)](double) { return phi_J0; };
  return entry;
}

FitEntry reversal_entry(const MemoryFit& fit, const Selection& selection) {
  FitEntry entry = shear_entry(fit, selection);
  entry.name = "memory.eps_SJ_R";
  entry.law = "ε_SJ,R = ε0_R {−ln[(φ − φ_SJ)/(φ_cr − φ_SJ)]}^(1/α), 0 from φ_cr on (Eq. 5.13)";
  entry.y_name = "eps_SJ_R";
  entry.y_label = "strain to jam again after reversal ε_SJ,R";
  entry.known_name.clear();
  entry.selection = shear_jamming_rule(selection) +
                    "; reversals of packings that had jammed, 0 where they stay so, mean of each "
                    "packing at one volume fraction";
  entry.problem = fit.reversal_law;
  entry.result = fit.reversal;
  entry.known_at = {};
  return entry;
}

/// By how much the strain by this sign exceeds that by contacts, over all first loadings that have both.
Json agreement(const std::vector<ShearJamming>& runs, JamSign sign) {
  std::vector<double> differences;
  std::size_t one_only = 0;
  for (const ShearJamming& run : runs) {
    if (run.reversals > 0) continue;
    const double here = run.by(sign), contacts = run.by(JamSign::contacts);
    one_only += std::isfinite(here) != std::isfinite(contacts) ? 1 : 0;
    if (std::isfinite(here - contacts)) differences.push_back(here - contacts);
  }
  double mean = 0, square = 0;
  for (const double d : differences) mean += d / static_cast<double>(differences.size());
  for (const double d : differences) square += (d - mean) * (d - mean);
  const auto n = static_cast<double>(differences.size());
  return {{"sign", name_of(sign)},
          {"runs", differences.size()},
          {"one_only", one_only},
          {"mean_difference", n > 0 ? Json(mean) : Json(nullptr)},
          {"deviation", n > 1 ? Json(std::sqrt(square / (n - 1))) : Json(nullptr)}};
}

Json estimate_json(const Estimate& e) {
  return {{"value", number_or_null(e.value)}, {"stderr", number_or_null(e.error)}};
}

Json relaxed_json(const Account& account) {
  Json out{{"steady_states", account.relaxed_limit.states},
           {"pressure", estimate_json(account.relaxed_limit.by_pressure)},
           {"shear_stress", estimate_json(account.relaxed_limit.by_shear_stress)}};
  for (const char* key : {"phi_J0", "nu", "eps_dev", "P_flow", "P", "s_dev", "C"}) out[key] = Json::array();
  for (const RelaxedState& s : account.relaxed) {
    out["phi_J0"].push_back(s.phi_J0.value);
    out["nu"].push_back(s.nu);
    out["eps_dev"].push_back(s.eps_dev);
    out["P_flow"].push_back(s.P_flow);
    out["P"].push_back(s.P);
    out["s_dev"].push_back(number_or_null(s.s_dev));
    out["C"].push_back(s.C);
  }
  return out;
}

Json tapped_json(const std::vector<TappedDensity>& packings) {
  Json out;
  for (const char* key : {"phi_max", "nu", "amplitude", "strain", "phi_J"}) out[key] = Json::array();
  for (const TappedDensity& t : packings) {
    out["phi_max"].push_back(t.phi_max);
    out["nu"].push_back(t.density.phi_max);
    out["amplitude"].push_back(t.amplitude);
    out["strain"].push_back(t.strain);
    out["phi_J"].push_back(number_or_null(t.density.from_P.value));
  }
  return out;
}

}  // namespace

void fit_memory_of(Account& account, const RecordFolder& folder, const Reference& reference,
                   const MeasuredMemory& measured, const Selection& selection) {
  const auto remembers = [](const TestRecord& test) { return test.role == Role::memory; };
  const bool any_test = std::any_of(folder.tests.begin(), folder.tests.end(), remembers);
  if (!any_test && !measured.any()) return;
  if (any_test && !read_tests(account, folder, selection)) return;
  append(account.cycles, measured.cycles);
  append(account.shear_jammings, measured.shear_jammings);
  append(account.relaxed, measured.relaxed);
  append(account.tapped, measured.tapped);
  account.relaxed_limit = relaxed_limit(account.relaxed, selection);
  account.memory = fit_memory(account.cycles, account.shear_jammings, reference.memory_values(),
                              account.relaxed_limit.by_pressure);
  for (FitEntry entry :
       {over_compression_entry(*account.memory, account, selection), shear_entry(*account.memory, selection),
        reversal_entry(*account.memory, selection)}) {
    entry.role = Role::memory;
    entry.thesis = reference.thesis_memory();
    if (const auto limit = entry.thesis.find("phi_SJ"); limit != entry.thesis.end())
      entry.thesis.emplace("phi_SJ_sheared", limit->second);
    account.entries.push_back(std::move(entry));
  }
}

Json memory_json(const Account& account) {
  const MemoryFit& fit = *account.memory;
  Json growth = Json::array(), entangled = Json::array();
  for (const GrowthComparison& g : fit.growth)
    growth.push_back({{"law", name_of(g.growth)},
                      {"mu", g.mu},
                      {"beta", g.beta},
                      {"rms", number_or_null(g.rms)},
                      {"delta_AIC", number_or_null(g.delta_AIC)}});
  for (const Entanglement& e : fit.entangled)
    entangled.push_back(
        {{"parameters", {e.first, e.second}}, {"correlation", number_or_null(e.correlation)}});
  return {{"phi_SJ",
           {{"over_compression", estimate_json(fit.phi_SJ.by_over_compression)},
            {"shear", estimate_json(fit.phi_SJ.by_shear)},
            {"rest", estimate_json(fit.phi_SJ.by_rest)},
            {"value", number_or_null(fit.phi_SJ.value)},
            {"stderr", number_or_null(fit.phi_SJ.error)}}},
          {"relaxed", relaxed_json(account)},
          {"tapped", tapped_json(account.tapped)},
          {"growth", growth},
          {"entangled", entangled},
          {"agreement",
           {agreement(account.shear_jammings, JamSign::percolation),
            agreement(account.shear_jammings, JamSign::pressure)}}};
}

}  // namespace grainlaw::calibrate
