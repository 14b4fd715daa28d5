// Which laws a prediction takes where the tables hold several rows: the parameter set's `closure`, resolved
// into plain numbers for one form of the law. Says by Error which row or group is missing.
#pragma once

#include <optional>
#include <string>

#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

enum class Form {
  reduced_closed,  ///< Eqs. 2.17, 2.18 with the current nu, the thesis's way on UNI; P* from Eq. 2.14
  reduced,         ///< their rate forms; P* from Eq. 2.14
  coupled          ///< Eq. 4.16 with moduli 4.11 to 4.15
};

std::string name_of(Form form);
/// Throws Error listing the names.
Form form_of(const std::string& name);

/// The laws of one form, as numbers.
struct Laws {
  PressureCurve pressure;  ///< closure.P; in the coupled form it only starts P*
  ContactCurve contacts;   ///< closure.contacts, closure.contacts_nu_c
  double g3 = 1;           ///< of F_v = g3 nu C: moduli.g3 where known, else Eq. 3.8 of material.w
  Saturation s_max, F_max, beta_F;
  Saturation beta_s;  ///< reduced forms only
  Moduli moduli;      ///< coupled form only
};

/// Resolves the closure. Throws Error naming the parameter file and the row or group that the form needs and
/// the set lacks.
Laws laws_of(const ParameterSet& parameters, Form form);

/// The same laws for another history: phi_J in place of the nu_c of the pressure law, and every other nu_c in
/// proportion (chapter 5: Eqs. 5.7 to 5.9, 5.12).
Laws with_jamming_density(Laws laws, double phi_J);

}  // namespace grainlaw::model
