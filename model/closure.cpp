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

Laws laws_of(const ParameterSet& parameters, Form form) {
  const std::string who = "the " + name_of(form) + " form";
  const Closure& closure = parameters.closure;
  Laws laws;
  laws.pressure = parameters.packing(closure.P, who + " (closure.P)").pressure();
  laws.contacts = parameters.packing(closure.contacts, who + " (closure.contacts)").contacts();
  if (closure.contacts_at_moduli_nu_c)
    laws.contacts.nu_c = parameters.need_moduli(who + " (closure.contacts_nu_c)").nu_c.value;
  laws.g3 = parameters.moduli ? parameters.moduli->g3.value : fabric_size_factor(parameters.material.w);
  laws.s_max = parameters.saturation("s_max", who).values();
  laws.F_max = parameters.saturation("F_max", who).values();
  laws.beta_F = parameters.saturation("beta_F", who).values();
  if (form == Form::coupled)
    laws.moduli = parameters.need_moduli(who).values();
  else
    laws.beta_s = parameters.saturation("beta_s", who).values();
  return laws;
}

Laws with_jamming_density(Laws laws, double phi_J) {
  const double factor = phi_J / laws.pressure.nu_c;
  laws.pressure = with_jamming_density(laws.pressure, phi_J);
  for (double* nu_c : {&laws.contacts.nu_c, &laws.moduli.nu_c, &laws.s_max.nu_c, &laws.beta_s.nu_c,
                       &laws.F_max.nu_c, &laws.beta_F.nu_c})
    *nu_c *= factor;
  return laws;
}

}  // namespace grainlaw::model
