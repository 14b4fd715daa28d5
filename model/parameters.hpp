// A parameter set (PARAMETERS.json in docs/formats.md): one material from one source, every number with its
// error and where it comes from. A group or row that is absent is one the set does not know; whoever needs it
// says so.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"
#include "grainlaw/model/laws/moduli.hpp"
#include "grainlaw/model/laws/moduli_table.hpp"
#include "grainlaw/model/laws/packing_laws.hpp"
#include "grainlaw/model/laws/saturation.hpp"

namespace grainlaw::model {

/// One number and its story.
struct Parameter {
  double value = 0;
  std::optional<double> stderr_;  ///< standard error; none where nobody gave one
  std::string unit = "1";         ///< every parameter of the laws is a pure number
  std::string source = "fit";     ///< "fit", "thesis" or "assumed"
  std::optional<double> thesis;   ///< the thesis's value, where it has one
  std::string note;
};

/// isotropic.MODE: Eqs. 2.11, 2.12 and 2.14 of one deformation mode (a row of Table 2.1).
struct PackingLaw {
  Parameter C0, C1, alpha, nu_c_contacts, phi_c, phi_v, p0, gamma_p, nu_c;
  ContactCurve contacts() const;  ///< at nu_c_contacts
  PressureCurve pressure() const;
};

/// shear.QUANTITY: Eq. 2.20 (a row of Table 2.2).
struct SaturationLaw {
  Parameter Q_max, Q_v, alpha, nu_c;
  Saturation values() const;
};

/// shear: the four numbers of Eqs. 2.17 and 2.18 over volume fraction; any may be unknown (w = 1 has no
/// betas).
struct ShearLaws {
  std::optional<SaturationLaw> s_max, beta_s, F_max, beta_F;
};

/// near_jamming: what the minimal form takes in place of isotropic and shear, all counted from phi_J.
/// Eqs. 5.7 to 5.9 before and in steady shear (Table 5.1), Eq. 5.12 (Table 5.2).
struct NearJammingLaws {
  PackingLaw iso, d2;
  SaturationLaw s_max, beta_s, F_max, beta_F;
};

/// moduli: Eqs. 4.11 to 4.15 (Table 4.1).
struct ModuliLaws {
  Parameter p0, gamma_p, nu_c, g3, a_I, a_II, g_I, GB_max, Fv_min, Fv_alpha;
  std::optional<Parameter> a_F, a_s;  ///< of the law past the thesis; both or none
  std::optional<Parameter> F_v;       ///< of the term constant_F_v
  Moduli values() const;
};

/// moduli_table: moduli by density in place of the laws.
struct TabulatedLaws {
  ModuliTable table;
  std::string source = "fit";  ///< as of a Parameter
  std::string note;
};

/// volumetric: -d ln F_dev/d ln nu under isotropic strain, past the thesis, which neglects it.
struct VolumetricLaws {
  Parameter compression, decompression;
};

/// memory: Eqs. 5.1 to 5.13.
struct MemoryLaws {
  Parameter phi_SJ, mu, beta, alpha_max, alpha_phi, alpha, eps0, eps0_R;
  std::optional<Parameter> phi_cr;  ///< the thesis gives no number
  /// Of the form with memory: alpha, eps0 and eps0_R as the pressure of jammed packings has them (without,
  /// those above), and what is not the thesis's.
  std::optional<Parameter> alpha_P, eps0_P, eps0_R_P, eps_r, hold, pack_rate, phi_pack;
  OverCompression over_compression() const;
};

/// Which rows a prediction takes where the set holds several (the thesis leaves it open).
struct Closure {
  std::string P;                         ///< mode whose pressure law gives the starting P*
  std::string contacts;                  ///< mode whose C0, C1, alpha, phi_c, phi_v give C*, phi_r and F_v
  bool contacts_at_moduli_nu_c = false;  ///< contacts_nu_c: "moduli" (true) or "row" (false)
};

/// A parameter by its place in the file ("moduli.a_I", "isotropic.d2.C1", "shear.s_max.Q_max"), and the
/// values it may have.
struct NamedParameter {
  std::string name;
  const Parameter* parameter;  ///< of the set that was asked; valid as long as that is
  Range range;
};

struct ParameterSet {
  std::string name;
  Material material;
  Closure closure;
  std::map<std::string, PackingLaw> isotropic;  ///< by mode: iso, uni, d2, d3
  std::optional<ShearLaws> shear;               ///< of D2
  std::optional<ShearLaws> shear_axial;         ///< past the thesis: of axisymmetric strain (D3, UNI)
  std::optional<NearJammingLaws> near_jamming;  ///< of chapter 5
  std::optional<ModuliLaws> moduli;
  std::optional<TabulatedLaws> moduli_table;
  std::optional<VolumetricLaws> volumetric;
  std::optional<MemoryLaws> memory;
  std::string file;  ///< where it was read from, for error messages; may be empty

  /// Throws Error naming file and key.
  static ParameterSet load(const std::filesystem::path& file);
  static ParameterSet read(Reader reader);
  Json to_json() const;

  /// Every parameter of the set, in the order of the file.
  std::vector<NamedParameter> named() const;
  /// The one of that name. Throws Error naming file and key where the set has none.
  Parameter& parameter(const std::string& key);

  /// The row or group asked for. Throws Error naming file, group and why it is needed ("... needs
  /// isotropic.d2").
  const PackingLaw& packing(const std::string& mode, const std::string& why) const;
  const SaturationLaw& saturation(const std::string& quantity, const std::string& why,
                                  bool axial = false) const;
  const ModuliLaws& need_moduli(const std::string& why) const;
  /// moduli.a_F and moduli.a_s.
  std::pair<const Parameter&, const Parameter&> need_energy(const std::string& why) const;
  /// moduli.F_v.
  const Parameter& need_constant_F_v(const std::string& why) const;
  const ModuliTable& need_moduli_table(const std::string& why) const;
  const VolumetricLaws& need_volumetric(const std::string& why) const;
  const MemoryLaws& need_memory(const std::string& why) const;
};

}  // namespace grainlaw::model
