#include "grainlaw/model/closure.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <vector>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled, Form::memory,
                          Form::coupled_3_14};

/// A term by name, and the forms that have a place for it.
struct Term {
  const char* name;
  bool Terms::*flag;
  std::initializer_list<Form> forms;
};
const Term all_terms[] = {
    {"axial",
     &Terms::axial,
     {Form::reduced_closed, Form::reduced, Form::coupled, Form::memory, Form::coupled_3_14}},
    {"energy", &Terms::energy, {Form::coupled}},
    {"volumetric", &Terms::volumetric, {Form::reduced, Form::coupled, Form::memory}},
    {"constant_F_v", &Terms::constant_F_v, {Form::coupled, Form::coupled_3_14}},
    {"moduli_table", &Terms::moduli_table, {Form::coupled}}};

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Adds the term of this name to the choice.
void add_term(Choice& choice, const std::string& name, const std::string& whole) {
  std::vector<std::string> names;
  for (const Term& term : all_terms) {
    if (std::find(term.forms.begin(), term.forms.end(), choice.form) == term.forms.end()) continue;
    names.push_back(term.name);
    if (name != term.name) continue;
    if (choice.terms.*term.flag) throw Error("", "form", "names a term twice, got \"" + whole + "\"");
    choice.terms.*term.flag = true;
    return;
  }
  const std::string can = names.empty() ? "takes no terms" : "takes the terms " + listed(names);
  throw Error("", "form", name_of(choice.form) + " " + can + ", got \"" + whole + "\"");
}

}  // namespace

std::string name_of(Form form) {
  switch (form) {
    case Form::reduced_closed:
      return "reduced_closed";
    case Form::reduced:
      return "reduced";
    case Form::coupled:
      return "coupled";
    case Form::memory:
      return "memory";
    case Form::coupled_3_14:
      return "coupled_3_14";
  }
  return "";
}

Form form_of(const std::string& name) {
  std::vector<std::string> names;
  for (const Form form : forms) {
    if (name == name_of(form)) return form;
    names.push_back(name_of(form));
  }
  throw Error("", "form", "must be one of " + listed(names) + ", got \"" + name + "\"");
}

std::string name_of(const Choice& choice) {
  std::string name = name_of(choice.form);
  for (const Term& term : all_terms)
    if (choice.terms.*term.flag) name += std::string("+") + term.name;
  return name;
}

Choice choice_of(const std::string& name) {
  std::istringstream parts(name);
  std::string part;
  std::getline(parts, part, '+');
  Choice choice{form_of(part), {}};
  if (name.ends_with('+')) throw Error("", "form", "must not end with a plus, got \"" + name + "\"");
  while (std::getline(parts, part, '+')) add_term(choice, part, name);
  if (choice.terms.moduli_table && (choice.terms.energy || choice.terms.constant_F_v))
    throw Error(
        "", "form",
        "takes its moduli from moduli_table or from the laws that energy and constant_F_v change, not "
        "both, got \"" +
            name + "\"");
  return choice;
}

namespace {

template <class P>
BasicContactCurve<P> contacts_of(const PackingLaw& row, const Reading<P>& read) {
  return {read(row.C0),    read(row.C1),   read(row.alpha), read(row.nu_c_contacts),
          read(row.phi_c), read(row.phi_v)};
}

template <class P>
BasicPressureCurve<P> pressure_of(const PackingLaw& row, const Reading<P>& read) {
  return {contacts_of(row, read), read(row.p0), read(row.gamma_p), read(row.nu_c)};
}

template <class P>
BasicSaturation<P> saturation_of(const SaturationLaw& row, const Reading<P>& read) {
  return {read(row.Q_max), read(row.Q_v), read(row.alpha), read(row.nu_c)};
}

template <class P>
BasicModuli<P> moduli_of(const ModuliLaws& m, const Reading<P>& read) {
  return {read(m.p0),   read(m.gamma_p), read(m.nu_c),   read(m.g3),     read(m.a_I),
          read(m.a_II), read(m.g_I),     read(m.GB_max), read(m.Fv_min), read(m.Fv_alpha)};
}

template <class P>
void add_memory(BasicLaws<P>& laws, const ParameterSet& parameters, const std::string& who,
                const Reading<P>& read) {
  laws.shear_pressure = pressure_of(parameters.packing(parameters.closure.contacts, who), read);
  const MemoryLaws& memory = parameters.need_memory(who);
  laws.memory.over = over_compression_of(memory, read);
  if (!memory.eps_r)
    throw Error(
        parameters.file, "memory.eps_r",
        "is missing; " + who +
            " needs it, and the thesis has none: fit and calibrate write it where tests of role memory "
            "tell the rest of the group; predict --form minimal does without");
  BasicMemoryNumbers<P>& numbers = laws.memory;
  // By reference: who reads knows a parameter by where it stands.
  const auto either = [&](const std::optional<Parameter>& own, const Parameter& other) {
    return read(own ? *own : other);
  };
  numbers.alpha = either(memory.alpha_P, memory.alpha);
  numbers.eps0 = either(memory.eps0_P, memory.eps0);
  numbers.eps0_R = either(memory.eps0_R_P, memory.eps0_R);
  numbers.eps_r = read(*memory.eps_r);
  if (memory.hold) numbers.hold = read(*memory.hold);
  if (memory.pack_rate.has_value() != memory.phi_pack.has_value())
    throw Error(parameters.file, memory.pack_rate ? "memory.phi_pack" : "memory.pack_rate",
                "is missing; memory.pack_rate and memory.phi_pack go together");
  if (memory.pack_rate) {
    numbers.pack_rate = read(*memory.pack_rate);
    numbers.phi_pack = read(*memory.phi_pack);
  }
}

/// Fills in what the terms need.
template <class P>
void add_terms(BasicLaws<P>& laws, const ParameterSet& parameters, const Terms& terms, const std::string& who,
               const Reading<P>& read) {
  laws.terms = terms;
  if (terms.energy) {
    const auto& [a_F, a_s] = parameters.need_energy(who);
    laws.moduli.a_F = read(a_F);
    laws.moduli.a_s = read(a_s);
  }
  if (terms.constant_F_v) laws.F_v = read(parameters.need_constant_F_v(who));
  if (terms.volumetric) {
    const VolumetricLaws& v = parameters.need_volumetric(who);
    laws.volumetric = {read(v.compression), read(v.decompression)};
  }
}

}  // namespace

void check_finite(const ParameterSet& parameters, const Parameter& parameter) {
  if (std::isfinite(parameter.value)) return;
  for (const NamedParameter& entry : parameters.named())
    if (entry.parameter == &parameter)
      throw Error(parameters.file, entry.name, "must be a finite number, got " + to_text(parameter.value));
}

template <class P>
BasicLaws<P> laws_of(const ParameterSet& parameters, const Choice& choice, const Reading<P>& read_as) {
  const Reading<P> read = [&](const Parameter& parameter) {
    check_finite(parameters, parameter);
    return read_as(parameter);
  };
  const std::string who = "the " + name_of(choice) + " form";
  const Closure& closure = parameters.closure;
  BasicLaws<P> laws;
  laws.pressure = pressure_of(parameters.packing(closure.P, who + " (closure.P)"), read);
  laws.contacts = contacts_of(parameters.packing(closure.contacts, who + " (closure.contacts)"), read);
  if (closure.contacts_at_moduli_nu_c)
    laws.contacts.nu_c = read(parameters.need_moduli(who + " (closure.contacts_nu_c)").nu_c);
  if (parameters.moduli)
    laws.g3 = read(parameters.moduli->g3);
  else
    laws.g3 = fabric_size_factor(parameters.material.w);
  laws.s_max = saturation_of(parameters.saturation("s_max", who, choice.terms.axial), read);
  laws.F_max = saturation_of(parameters.saturation("F_max", who, choice.terms.axial), read);
  laws.beta_F = saturation_of(parameters.saturation("beta_F", who, choice.terms.axial), read);
  if (choice.form == Form::memory) add_memory(laws, parameters, who, read);
  if (choice.form == Form::coupled || choice.form == Form::memory || choice.form == Form::coupled_3_14)
    laws.moduli = moduli_of(parameters.need_moduli(who), read);
  else
    laws.beta_s = saturation_of(parameters.saturation("beta_s", who, choice.terms.axial), read);
  if (choice.form == Form::coupled_3_14 && parameters.moduli->a_I.value == 0)
    throw Error(parameters.file, "moduli.a_I.value", "must not be 0 for " + who + ", whose A is a_I B F_dev");
  add_terms(laws, parameters, choice.terms, who, read);
  return laws;
}

template BasicLaws<double> laws_of(const ParameterSet&, const Choice&, const Reading<double>&);
template BasicLaws<Slopes> laws_of(const ParameterSet&, const Choice&, const Reading<Slopes>&);
template BasicLaws<FewSlopes> laws_of(const ParameterSet&, const Choice&, const Reading<FewSlopes>&);

Laws laws_of(const ParameterSet& parameters, const Choice& choice) {
  return laws_of<double>(parameters, choice, [](const Parameter& parameter) { return parameter.value; });
}

}  // namespace grainlaw::model
