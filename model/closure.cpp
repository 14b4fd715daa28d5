#include "grainlaw/model/closure.hpp"

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

std::string name_of(Form form) {
  switch (form) {
    case Form::reduced_closed:
      return "reduced_closed";
    case Form::reduced:
      return "reduced";
    case Form::coupled:
      return "coupled";
  }
  return "";
}

Form form_of(const std::string& name) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled})
    if (name == name_of(form)) return form;
  throw Error("", "form", "must be one of reduced_closed, reduced, coupled, got \"" + name + "\"");
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

}  // namespace

template <class P>
BasicLaws<P> laws_of(const ParameterSet& parameters, Form form, const Reading<P>& read) {
  const std::string who = "the " + name_of(form) + " form";
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
  laws.s_max = saturation_of(parameters.saturation("s_max", who), read);
  laws.F_max = saturation_of(parameters.saturation("F_max", who), read);
  laws.beta_F = saturation_of(parameters.saturation("beta_F", who), read);
  if (form == Form::coupled)
    laws.moduli = moduli_of(parameters.need_moduli(who), read);
  else
    laws.beta_s = saturation_of(parameters.saturation("beta_s", who), read);
  return laws;
}

template BasicLaws<double> laws_of(const ParameterSet&, Form, const Reading<double>&);
template BasicLaws<Slopes> laws_of(const ParameterSet&, Form, const Reading<Slopes>&);

Laws laws_of(const ParameterSet& parameters, Form form) {
  return laws_of<double>(parameters, form, [](const Parameter& parameter) { return parameter.value; });
}

}  // namespace grainlaw::model
