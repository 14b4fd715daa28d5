// Which laws a prediction takes where the tables hold several rows: the parameter set's `closure`, resolved
// into plain numbers for one form of the law. Says by Error which row or group is missing.
#pragma once

#include <functional>
#include <string>

#include "grainlaw/model/laws/volumetric.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

enum class Form {
  reduced_closed,  ///< Eqs. 2.17, 2.18 with the current nu, the thesis's way on UNI; P* from Eq. 2.14
  reduced,         ///< their rate forms; P* from Eq. 2.14
  coupled,         ///< Eq. 4.16 with moduli 4.11 to 4.15
  memory,          ///< Eq. 4.16 with P* bounded by phi_J(H): over-compression and shear are remembered
  coupled_3_14     ///< Eq. 3.14, the thesis's earlier form, with the same B and G and one modulus A
};

std::string name_of(Form form);
/// Throws Error listing the names.
Form form_of(const std::string& name);

/// Terms past the thesis that a form may take, off unless asked for.
struct Terms {
  bool axial = false;  ///< s_max, F_max and their rates of axisymmetric strain (group shear_axial), not of D2
  bool energy = false;        ///< A1 and A2 from one energy (moduli.a_F, a_s) in place of Eqs. 4.12 and 4.13
  bool volumetric = false;    ///< F_dev changes with volume alone (group volumetric)
  bool constant_F_v = false;  ///< moduli.F_v in Eqs. 4.11 and 4.14, whatever nu, in place of F_v(nu)
  bool moduli_table = false;  ///< moduli by group moduli_table in place of their laws
  bool operator==(const Terms&) const = default;
};

/// A form with its terms. Its name is that of the form, and after a plus that of each term:
/// "coupled+energy".
struct Choice {
  Form form = Form::coupled;
  Terms terms;
};
std::string name_of(const Choice& choice);
/// Throws Error listing the names, or those of the terms that the form can take.
Choice choice_of(const std::string& name);

/// Numbers of the form with memory.
template <class P>
struct BasicMemoryNumbers {
  BasicOverCompression<P> over;  ///< Eqs. 5.1, 5.5
  P alpha = 1;                   ///< exponent of Eq. 5.3
  P eps0 = 1;                    ///< strain over which a first loading is remembered (Eq. 5.3)
  P eps0_R = 1;                  ///< the same after a reversal (Eq. 5.13)
  P eps_r = 1;                   ///< strain of a reversal that empties the memory of steady shear
  P hold = 0;                    ///< part of the fabric's rate that a full reversal takes
  P pack_rate = 0;               ///< of shear to and fro
  P phi_pack = 0;                ///< the density it packs to
};

/// The laws of one form, as numbers.
template <class P>
struct BasicLaws {
  BasicPressureCurve<P> pressure;  ///< closure.P; in the coupled form it only starts P*
  BasicContactCurve<P> contacts;   ///< closure.contacts, closure.contacts_nu_c
  P g3 = 1;                        ///< of F_v = g3 nu C: moduli.g3 where known, else Eq. 3.8 of material.w
  BasicSaturation<P> s_max, F_max, beta_F;
  BasicSaturation<P> beta_s;             ///< reduced forms only
  BasicModuli<P> moduli;                 ///< coupled forms only
  P F_v = 0;                             ///< of the term constant_F_v
  BasicPressureCurve<P> shear_pressure;  ///< memory only: the row closure.contacts, of steady shear
  BasicMemoryNumbers<P> memory;          ///< memory only
  BasicVolumetric<P> volumetric;
  Terms terms;  ///< whose numbers are in the laws
};
using Laws = BasicLaws<double>;

/// A parameter as a number of type P: for a Dual, with the slope it carries.
template <class P>
using Reading = std::function<P(const Parameter&)>;

/// Throws Error naming file and key of a parameter of the set whose value is no finite number.
void check_finite(const ParameterSet& parameters, const Parameter& parameter);

/// Resolves the closure. Throws Error naming the parameter file and the row or group that the form needs and
/// the set lacks, or a parameter that is no finite number. Instantiated for double, Slopes and
/// FewSlopes.
template <class P>
BasicLaws<P> laws_of(const ParameterSet& parameters, const Choice& choice, const Reading<P>& read);
Laws laws_of(const ParameterSet& parameters, const Choice& choice);
inline Laws laws_of(const ParameterSet& parameters, Form form) { return laws_of(parameters, {form, {}}); }

/// The numbers of Eqs. 5.1 and 5.5 of a set's memory.
template <class P>
BasicOverCompression<P> over_compression_of(const MemoryLaws& memory, const Reading<P>& read) {
  return {read(memory.phi_SJ), read(memory.mu), read(memory.beta), read(memory.alpha_max),
          read(memory.alpha_phi)};
}

/// The same laws for another history: phi_J in place of the nu_c of the pressure law, and every other nu_c in
/// proportion (chapter 5: Eqs. 5.7 to 5.9, 5.12).
template <class P>
BasicLaws<P> with_jamming_density(BasicLaws<P> laws, const P& phi_J) {
  const P factor = phi_J / laws.pressure.nu_c;
  laws.pressure = with_jamming_density(laws.pressure, phi_J);
  for (P* nu_c : {&laws.contacts.nu_c, &laws.moduli.nu_c, &laws.s_max.nu_c, &laws.beta_s.nu_c,
                  &laws.F_max.nu_c, &laws.beta_F.nu_c})
    *nu_c = *nu_c * factor;
  return laws;
}

}  // namespace grainlaw::model
