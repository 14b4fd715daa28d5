#include "grainlaw/apps/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace grainlaw::apps {

namespace {

std::string number(double value) { return fmt::format("{:.4g}", value); }

constexpr std::size_t most_remarks = 8;

/// Calls add(name, parameter) for each of group shear.
template <class Add>
void add_shear_rows(const model::ParameterSet& set, const Add& add) {
  if (!set.shear) return;
  const std::pair<const char*, const std::optional<model::SaturationLaw>*> laws[] = {
      {"s_max", &set.shear->s_max},
      {"beta_s", &set.shear->beta_s},
      {"F_max", &set.shear->F_max},
      {"beta_F", &set.shear->beta_F}};
  for (const auto& [name, law] : laws) {
    if (!law->has_value()) continue;
    const std::string group = std::string("shear.") + name + ".";
    add(group + "Q_max", (*law)->Q_max);
    add(group + "Q_v", (*law)->Q_v);
    add(group + "alpha", (*law)->alpha);
    add(group + "nu_c", (*law)->nu_c);
  }
}

/// The same for group moduli.
template <class Add>
void add_moduli_rows(const model::ParameterSet& set, const Add& add) {
  if (!set.moduli) return;
  const model::ModuliLaws& m = *set.moduli;
  add("moduli.p0", m.p0);
  add("moduli.gamma_p", m.gamma_p);
  add("moduli.nu_c", m.nu_c);
  add("moduli.a_I", m.a_I);
  add("moduli.a_II", m.a_II);
  if (m.a_F) add("moduli.a_F", *m.a_F);
  if (m.a_s) add("moduli.a_s", *m.a_s);
  add("moduli.GB_max", m.GB_max);
  add("moduli.Fv_min", m.Fv_min);
  add("moduli.Fv_alpha", m.Fv_alpha);
  add("moduli.g_I", m.g_I);
}

/// The same for group memory.
template <class Add>
void add_memory_rows(const model::ParameterSet& set, const Add& add) {
  if (!set.memory) return;
  const model::MemoryLaws& m = *set.memory;
  add("memory.phi_SJ", m.phi_SJ);
  add("memory.alpha_max", m.alpha_max);
  add("memory.alpha_phi", m.alpha_phi);
  add("memory.mu", m.mu);
  add("memory.beta", m.beta);
  add("memory.alpha", m.alpha);
  add("memory.eps0", m.eps0);
  add("memory.eps0_R", m.eps0_R);
  if (m.phi_cr) add("memory.phi_cr", *m.phi_cr);
  for (const auto& [name, parameter] : {std::pair{"memory.alpha_P", &m.alpha_P},
                                        {"memory.eps0_P", &m.eps0_P},
                                        {"memory.eps0_R_P", &m.eps0_R_P},
                                        {"memory.eps_r", &m.eps_r},
                                        {"memory.hold", &m.hold},
                                        {"memory.pack_rate", &m.pack_rate},
                                        {"memory.phi_pack", &m.phi_pack}})
    if (*parameter) add(name, **parameter);
}

/// The fitted parameters with their names, in the order they are shown.
using Rows = std::vector<std::pair<std::string, const model::Parameter*>>;

Rows fitted_rows(const model::ParameterSet& set) {
  Rows rows;
  const auto add = [&](const std::string& name, const model::Parameter& parameter) {
    if (parameter.source == "fit") rows.emplace_back(name, &parameter);
  };
  for (const auto& [mode, law] : set.isotropic) {
    const std::string group = "isotropic." + mode + ".";
    add(group + "nu_c", law.nu_c);
    add(group + "p0", law.p0);
    add(group + "gamma_p", law.gamma_p);
    add(group + "C0", law.C0);
    add(group + "C1", law.C1);
    add(group + "alpha", law.alpha);
    add(group + "nu_c_contacts", law.nu_c_contacts);
    add(group + "phi_c", law.phi_c);
    add(group + "phi_v", law.phi_v);
  }
  add_shear_rows(set, add);
  add_moduli_rows(set, add);
  add_memory_rows(set, add);
  return rows;
}

/// A list in an object; empty where there is none.
Json list_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : Json::array();
}

/// A text in an object; "-" where there is none.
std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "-";
}

/// A mean over seeds that leaves undefined values out.
struct Mean {
  double sum = 0;
  int count = 0;
  void add(const Json& value) {
    if (!value.is_number()) return;
    sum += value.get<double>();
    ++count;
  }
  std::string text() const { return count > 0 ? fmt::format("{:.1f} %", 100 * sum / count) : "-"; }
};

constexpr std::array error_names{"P", "sigma_dev", "s_dev", "F_dev"};

/// "uni-0.69" of "uni-0.69-s1".
std::string test_of(const std::string& record) { return record.substr(0, record.rfind("-s")); }

}  // namespace

std::string parameter_table(const model::ParameterSet& parameters) {
  std::string text = fmt::format("{:<30} {:>12} {:>12} {:>12}\n", "parameter", "value", "+-", "thesis");
  for (const auto& [name, p] : fitted_rows(parameters))
    text += fmt::format("{:<30} {:>12} {:>12} {:>12}\n", name, number(p->value),
                        p->stderr_ ? number(*p->stderr_) : "-", p->thesis ? number(*p->thesis) : "-");
  return text;
}

std::string fit_remarks(const Json& fits) {
  std::string text;
  for (const Json& check : list_of(fits, "checks")) {
    const Json holds = check.value("holds", Json());
    const char* verdict = holds == true ? "holds" : holds == false ? "FAILS" : "open ";
    text += fmt::format("{}  {} ({})\n", verdict, text_of(check, "name"), text_of(check, "value"));
  }
  std::size_t missing = 0;
  for (const Json& one : list_of(fits, "not_determined")) {
    if (text_of(one, "role") == "predict" || ++missing > most_remarks) continue;
    text += fmt::format("not determined: {} of {}: {}\n", text_of(one, "parameter"), text_of(one, "fit"),
                        text_of(one, "reason"));
  }
  if (missing > most_remarks)
    text += fmt::format("not determined: {} more, see the report\n", missing - most_remarks);
  return text;
}

std::string prediction_table(const Json& predictions) {
  std::vector<std::pair<std::string, std::string>> order;
  std::map<std::pair<std::string, std::string>, std::map<std::string_view, Mean>> errors;
  const Json list = list_of(predictions, "predictions");
  if (list.empty()) return "";
  for (const Json& one : list) {
    const std::pair key{test_of(text_of(one, "test")), text_of(one, "form")};
    if (!errors.contains(key)) order.push_back(key);
    const Json found = one.value("errors", Json::object());
    for (const char* name : error_names) errors[key][name].add(found.value(name, Json()));
  }
  std::size_t width = 14;  // names grow with their terms
  for (const auto& key : order) width = std::max(width, key.second.size());
  std::string text = fmt::format("{:<16} {:<{}}", "prediction of", "form", width);
  for (const char* name : error_names) text += fmt::format(" {:>9}", name);
  text += "   (relative L2 error, mean over seeds)\n";
  for (const auto& key : order) {
    text += fmt::format("{:<16} {:<{}}", key.first, key.second, width);
    for (const char* name : error_names) text += fmt::format(" {:>9}", errors[key][name].text());
    text += "\n";
  }
  return text;
}

}  // namespace grainlaw::apps
