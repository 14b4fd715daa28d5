#include "grainlaw/calibrate/fit_moduli_account.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "grainlaw/calibrate/moduli_selection.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {
namespace {

struct Tables {
  std::vector<ModuliSeries> series;
  std::size_t left_out = 0;
  Material material;
  bool any = false;
};

/// The states of all d2 tests of role fit.
Tables tables_of(Account& account, const RecordFolder& folder) {
  Tables all;
  for (const TestRecord& test : folder.tests) {
    if (!test.moduli) continue;
    if (test.role != Role::fit || test.mode != "d2") {
      account.left_out.push_back({test.name, test.role, "moduli: these are fitted to d2 tests of role fit"});
      continue;
    }
    ModuliCount count;
    ModuliSeries series = moduli_states(*test.moduli, test.name, test.seed, first_shear_leg(test), count);
    if (count.left_out() > 0) account.left_out.push_back({test.name, test.role, "moduli: " + count.text()});
    all.left_out += count.left_out();
    all.material = test.material;
    all.any = true;
    all.series.push_back(std::move(series));
  }
  return all;
}

/// The contacts and rattlers over nu that were fitted to this mode; none where one of their numbers is open.
std::optional<model::ContactCurve> contacts_of(const PackingFit& fit) {
  const model::ContactCurve curve{fit.contacts.value("C0"),    fit.contacts.value("C1"),
                                  fit.contacts.value("alpha"), fit.contacts.value("nu_c_contacts"),
                                  fit.rattlers.value("phi_c"), fit.rattlers.value("phi_v")};
  const double sum = curve.C0 + curve.C1 + curve.alpha + curve.nu_c + curve.phi_c + curve.phi_v;
  return std::isfinite(sum) ? std::optional(curve) : std::nullopt;
}

/// The nu at which these contacts make the fabric F_v: what Eq. 4.11 needs for its curve over F_v.
std::function<double(double)> density_of(const model::ContactCurve& contacts, double g3) {
  return [contacts, g3](double F_v) {
    double low = contacts.nu_c * (1 + 1e-9), high = 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (model::isotropic_fabric(contacts, g3, middle) < F_v ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
}

/// s_dev where F_dev/F_v has this value, by the mean ratio of the two over the states: what the law of A
/// needs for a curve over one of its two variables.
std::function<double(double)> stress_ratio_of(const FitProblem& law) {
  double product = 0, square = 0;
  for (const FitSeries& series : law.series)
    for (const FitPoint& point : series.points) {
      product += point.x * point.known;
      square += point.x * point.x;
    }
  return [ratio = square > 0 ? product / square : 0](double share) { return ratio * share; };
}

class Entries {
 public:
  Entries(Account& account, const Tables& tables, const Reference& reference) : account_(account) {
    entry_.mode = "d2";
    entry_.selection = moduli_rule();
    entry_.rows_left_out = tables.left_out;
    entry_.thesis = reference.thesis_moduli();
  }
  void x(const std::string& name, const std::string& label) {
    entry_.x_name = name;
    entry_.x_label = label;
  }
  void add(const std::string& name, const std::string& law, const std::string& label,
           const FitProblem& problem, const FitResult& result) {
    entry_.name = "moduli." + name;
    entry_.law = law;
    entry_.y_name = name;
    entry_.y_label = label;
    entry_.problem = problem;
    entry_.result = result;
    account_.entries.push_back(entry_);
    entry_.known_at = {};
  }
  void known_at(std::function<double(double)> known) { entry_.known_at = std::move(known); }

 private:
  Account& account_;
  FitEntry entry_;
};

void add_entries(Account& account, const Tables& tables, const ModuliFit& fit, const Reference& reference,
                 const std::function<double(double)>& nu_of_fabric) {
  Entries entries(account, tables, reference);
  entries.x("F_v", "isotropic fabric F_v");
  entries.known_at(nu_of_fabric);
  entries.add("B", "B = p0 F_v/(g3 ν_c) [1 − 2γ_p ε + ε (1 − γ_p ε) ∂ln F_v/∂ε], ε = ln(ν/ν_c) (Eq. 4.11)",
              "bulk modulus B", fit.B_law, fit.B);
  entries.x("F_dev", "deviatoric fabric F_dev");
  entries.add("A1", "A1/B = a_I F_dev (Eq. 4.12)", "first anisotropy modulus, over B", fit.A1_law, fit.A1);
  entries.add("A2", "A2/B = a_II F_dev (Eq. 4.13)", "second anisotropy modulus, over B", fit.A2_law, fit.A2);
  entries.x("F_dev/F_v", "share of the fabric that is deviatoric, F_dev/F_v");
  entries.known_at(stress_ratio_of(fit.A_law));
  entries.add("A",
              "A/B_0 = a_F F_dev/F_v + a_s s_dev, A = A1 + (2/9) σ*_dev = (2/3) [A2 − (2/3) σ*_dev], B_0 = B "
              "− (2/3) P*",
              "anisotropy modulus without prestress, over B_0", fit.A_law, fit.A);
  entries.x("F_v", "isotropic fabric F_v");
  entries.add("GB_ini", "(G/B)_ini = (G/B)_max {1 − exp[−(F_v − F_v_min)/F_v_alpha]} (Eq. 4.14)",
              "G/B before shear", fit.GB_ini_law, fit.GB_ini);
  entries.x("sigma_dev F_dev", "σ*_dev F_dev");
  entries.add("G", "G/B − (G/B)_ini = −g_I σ*_dev F_dev (Eq. 4.15)", "G/B less that before shear", fit.G_law,
              fit.G);
}

}  // namespace

void fit_moduli_of(Account& account, const RecordFolder& folder, const Reference& reference) {
  const Tables tables = tables_of(account, folder);
  if (!tables.any) return;
  const PackingFit& packing = account.packing.at("d2");
  const auto contacts = contacts_of(packing);
  const FitEstimate& nu_c = packing.pressure["nu_c"];
  if (!contacts || !std::isfinite(nu_c.value)) {
    account.left_out.push_back(
        {"d2", Role::fit, "moduli: Eq. 4.11 needs the laws of contacts and pressure of d2, which are open"});
    return;
  }
  const double g3 = fabric_size_factor(tables.material.w);
  account.moduli_nu_c_fitted = packing.pressure.ran && !nu_c.held && nu_c.determined;
  account.moduli = fit_moduli(tables.series, *contacts, g3, {nu_c.value, nu_c.stderr_.value_or(0)},
                              reference.moduli_values());
  add_entries(account, tables, *account.moduli, reference, density_of(*contacts, g3));
}

}  // namespace grainlaw::calibrate
