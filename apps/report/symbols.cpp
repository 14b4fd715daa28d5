#include "grainlaw/apps/report/symbols.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace grainlaw::report {
namespace {

const std::vector<Symbol> state{
    {"nu", "<var>ν</var>", "{/:Italic ν}", "–",
     "Volume fraction: volume of the grains over volume of the box; overlaps are not subtracted."},
    {"eps_vol", "<var>ε</var><sub>vol</sub>", "{/:Italic ε}_{vol}", "–",
     "Volume strain ln(nu/nu at the start); compression is positive."},
    {"eps_dev", "<var>ε</var><sub>dev</sub>", "{/:Italic ε}_{dev}", "–",
     "Shear strain √(3 J₂) of the strain since the start, signed: positive in the first direction of the "
     "test."},
    {"P", "<var>P</var>*", "{/:Italic P}*", "–",
     "Pressure, a third of the trace of the static stress, over the stress unit k*."},
    {"p_star", "<var>p</var>*", "{/:Italic p}*", "–",
     "Scaled pressure P* nu_c/(nu C): what is left of the pressure once the number of contacts is divided "
     "out."},
    {"sigma_dev", "<var>σ</var>*<sub>dev</sub>", "{/:Italic σ}*_{dev}", "–",
     "Shear stress √(3 J₂) of the stress, signed, over k*."},
    {"s_dev", "<var>s</var><sub>dev</sub>", "{/:Italic s}_{dev}", "–",
     "Stress ratio sigma_dev/P*: the mobilised (macroscopic) friction."},
    {"F_v", "<var>F</var><sub>v</sub>", "{/:Italic F}_v", "–",
     "Trace of the fabric tensor: how many contacts there are, weighted by the volume of the grains."},
    {"F_dev", "<var>F</var><sub>dev</sub>", "{/:Italic F}_{dev}", "–",
     "Anisotropy of the contacts: √(3 J₂) of the fabric tensor, signed. Zero if contacts point everywhere "
     "alike."},
    {"C", "<var>C</var>", "{/:Italic C}", "–",
     "Contacts per grain, over all grains, rattlers' contacts left out."},
    {"C_star", "<var>C</var>*", "{/:Italic C}*", "–",
     "Contacts per grain among the grains that carry load (four contacts or more)."},
    {"phi_r", "<var>φ</var><sub>r</sub>", "{/:Italic φ}_r", "–",
     "Fraction of rattlers: grains with fewer than four contacts, which carry no lasting load."},
    {"f_NR", "<var>f</var><sub>NR</sub>", "{/:Italic f}_{NR}", "–",
     "Fraction of grains that are not rattlers, 1 − phi_r."},
    {"Ek_over_Ep", "<var>E</var><sub>k</sub>/<var>E</var><sub>p</sub>", "{/:Italic E}_k/{/:Italic E}_p", "–",
     "Kinetic over elastic energy of the grains; small where the test is quasi-static, that is slow enough."},
    {"phi_J", "<var>φ</var><sub>J</sub>", "{/:Italic φ}_J", "–",
     "Jamming density: the volume fraction below which the packing, with its history, carries no load."},
};

const std::vector<Symbol> isotropic{
    {"isotropic.nu_c", "<var>ν</var><sub>c</sub>", "{/:Italic ν}_c", "–",
     "Volume fraction at which the pressure vanishes on unloading (jamming point of the pressure law)."},
    {"isotropic.nu_c_contacts", "<var>ν</var><sub>c</sub> (contacts)", "{/:Italic ν}_c", "–",
     "The same from the contact number, C* = C0 at nu_c (Eqs. 2.11, 2.12); the two differ by little."},
    {"isotropic.C0", "<var>C</var><sub>0</sub>", "{/:Italic C}_0", "–",
     "Contact number at jamming; 6 for frictionless spheres (isostatic)."},
    {"isotropic.C1", "<var>C</var><sub>1</sub>", "{/:Italic C}_1", "–",
     "How fast the contact number grows with compression beyond jamming."},
    {"isotropic.alpha", "<var>α</var>", "{/:Italic α}", "–", "Exponent of that growth, about 0.58."},
    {"isotropic.phi_c", "<var>φ</var><sub>c</sub>", "{/:Italic φ}_c", "–",
     "Fraction of rattlers at jamming."},
    {"isotropic.phi_v", "<var>φ</var><sub>v</sub>", "{/:Italic φ}_v", "–",
     "How fast rattlers disappear with compression beyond jamming."},
    {"isotropic.p0", "<var>p</var><sub>0</sub>", "{/:Italic p}_0", "–",
     "Slope of the scaled pressure against ln(nu/nu_c): the bulk stiffness of the contact network."},
    {"isotropic.gamma_p", "<var>γ</var><sub>p</sub>", "{/:Italic γ}_p", "–",
     "Small correction to that straight line at large compression."},
};

const std::vector<Symbol> shear{
    {"s_max", "<var>s</var><sub>max</sub>", "{/:Italic s}_{max}", "–",
     "Stress ratio reached at large shear strain (saturation value)."},
    {"beta_s", "<var>β</var><sub>s</sub>", "{/:Italic β}_s", "–",
     "Rate at which s_dev approaches s_max, per unit eps_dev."},
    {"F_max", "<var>F</var><sub>max</sub>", "{/:Italic F}_{max}", "–",
     "Contact anisotropy reached at large shear strain."},
    {"beta_F", "<var>β</var><sub>F</sub>", "{/:Italic β}_F", "–",
     "Rate at which F_dev approaches F_max, per unit eps_dev."},
    {"shear.Q_max", "<var>Q</var><sub>max</sub>", "{/:Italic Q}_{max}", "–",
     "Value of s_max, beta_s, F_max or beta_F far beyond jamming (Eq. 2.20)."},
    {"shear.Q_v", "<var>Q</var><sub>v</sub>", "{/:Italic Q}_v", "–", "What is added to it at jamming."},
    {"shear.alpha", "<var>α</var>", "{/:Italic α}", "–",
     "How fast that addition dies away with nu/nu_c − 1."},
    {"shear.nu_c", "<var>ν</var><sub>c</sub>", "{/:Italic ν}_c", "–",
     "Reference volume fraction of that decay: the jamming point of ISO, given to the fit."},
};

const std::vector<Symbol> moduli{
    {"moduli.p0", "<var>p</var><sub>0</sub>", "{/:Italic p}_0", "–",
     "As in the pressure law, for the bulk modulus (Eq. 4.11)."},
    {"moduli.gamma_p", "<var>γ</var><sub>p</sub>", "{/:Italic γ}_p", "–",
     "As in the pressure law, for the bulk modulus."},
    {"moduli.nu_c", "<var>ν</var><sub>c</sub>", "{/:Italic ν}_c", "–", "Jamming point that the moduli use."},
    {"moduli.g3", "<var>g</var><sub>3</sub>", "{/:Italic g}_3", "–",
     "Factor of the size distribution in F_v = g3 nu C; 1 for equal grains."},
    {"moduli.a_I", "<var>a</var><sub>I</sub>", "{/:Italic a}_I", "–",
     "Pressure gained by shear: A₁ = a_I B F_dev (Eq. 4.12)."},
    {"moduli.a_II", "<var>a</var><sub>II</sub>", "{/:Italic a}_{II}", "–",
     "Shear stress gained by compression: A₂ = a_II B F_dev (Eq. 4.13)."},
    {"moduli.a_F", "<var>a</var><sub>F</sub>", "{/:Italic a}_F", "–",
     "Share of the fabric's anisotropy F_dev/F_v in A/B₀ (past the thesis)."},
    {"moduli.a_s", "<var>a</var><sub>s</sub>", "{/:Italic a}_s", "–",
     "Share of the stress ratio s_dev in A/B₀ (past the thesis)."},
    {"moduli.g_I", "<var>g</var><sub>I</sub>", "{/:Italic g}_I", "–",
     "Loss of shear stiffness with stress and anisotropy (Eq. 4.15)."},
    {"moduli.GB_max", "(<var>G</var>/<var>B</var>)<sub>max</sub>", "(G/B)_{max}", "–",
     "Ceiling of the initial ratio of shear to bulk modulus (Eq. 4.14)."},
    {"moduli.Fv_min", "<var>F</var><sub>v</sub><sup>min</sup>", "{/:Italic F}_{v,min}", "–",
     "Value of F_v at which the shear modulus vanishes (Eq. 4.14)."},
    {"moduli.Fv_alpha", "<var>F</var><sub>v</sub><sup>α</sup>", "{/:Italic F}_{v,α}", "–",
     "How fast the ratio G/B rises with F_v above that (Eq. 4.14)."},
};

const std::vector<Symbol> memory{
    {"memory.phi_SJ", "<var>φ</var><sub>SJ</sub>", "{/:Italic φ}_{SJ}", "–",
     "Lowest density at which shear can jam the packing (Eq. 5.1)."},
    {"memory.mu", "<var>μ</var>", "{/:Italic μ}", "–",
     "Scale of the number of compression cycles (Eq. 5.1)."},
    {"memory.beta", "<var>β</var>", "{/:Italic β}", "–",
     "Exponent of the number of compression cycles (Eq. 5.1)."},
    {"memory.alpha_max", "<var>α</var><sub>max</sub>", "{/:Italic α}_{max}", "–",
     "Most that over-compression can raise the jamming density (Eq. 5.5)."},
    {"memory.alpha_phi", "<var>α</var><sub>φ</sub>", "{/:Italic α}_φ", "–",
     "Exponent of over-compression in Eq. 5.5."},
    {"memory.alpha", "<var>α</var>", "{/:Italic α}", "–",
     "Exponent of shear strain in shear jamming (Eq. 5.2)."},
    {"memory.eps0", "<var>ε</var><sub>0</sub>", "{/:Italic ε}_0", "–",
     "Shear strain over which phi_J falls to phi_SJ."},
    {"memory.eps0_R", "<var>ε</var><sub>0,R</sub>", "{/:Italic ε}_{0,R}", "–",
     "The same after a reversal of shear."},
    {"memory.phi_SJ_sheared", "<var>φ</var><sub>SJ</sub>", "{/:Italic φ}_{SJ}", "–",
     "The same from the strains that jam, alone (Eq. 5.2)."},
    {"memory.phi_cr", "<var>φ</var><sub>cr</sub>", "{/:Italic φ}_{cr}", "–",
     "Density below which a reversal of shear unjams the packing."},
    {"memory.alpha_P", "<var>α</var><sub>P</sub>", "{/:Italic α}_P", "–",
     "Exponent of Eq. 5.3 as the pressure of jammed packings has it (form memory)."},
    {"memory.eps0_P", "<var>ε</var><sub>0,P</sub>", "{/:Italic ε}_{0,P}", "–",
     "Shear strain of Eq. 5.3, likewise."},
    {"memory.eps0_R_P", "<var>ε</var><sub>0,R,P</sub>", "{/:Italic ε}_{0,R,P}", "–",
     "The same after a reversal (Eq. 5.13), likewise."},
    {"memory.eps_r", "<var>ε</var><sub>r</sub>", "{/:Italic ε}_r", "–",
     "Strain of a reversal that empties the memory of steady shear (form memory)."},
    {"memory.hold", "<var>h</var>", "{/:Italic h}", "–",
     "Part of the fabric's rate that a full reversal takes (form memory)."},
    {"memory.pack_rate", "<var>k</var><sub>p</sub>", "{/:Italic k}_p", "–",
     "How much of what a reversal gives back is packed (form memory)."},
    {"memory.phi_pack", "<var>φ</var><sub>p</sub>", "{/:Italic φ}_p", "–",
     "Jamming density that shear to and fro packs to (form memory)."},
};

const std::vector<Symbol> volumetric{
    {"volumetric.compression", "<var>k</var><sub>+</sub>", "{/:Italic k}_+", "–",
     "Loss of F_dev by compression alone: −d ln F_dev/d ln nu (past the thesis)."},
    {"volumetric.decompression", "<var>k</var><sub>−</sub>", "{/:Italic k}_−", "–",
     "The same where the volume grows."},
};

const std::vector<Symbol> material{
    {"material.w", "<var>w</var>", "{/:Italic w}", "–",
     "Largest over smallest grain radius of the uniform size distribution."},
    {"material.k", "<var>k</var>", "{/:Italic k}", "μg/μs² (= 1000 kg/s²)", "Stiffness of a contact."},
    {"material.r_mean", "⟨<var>r</var>⟩", "⟨{/:Italic r}⟩", "mm", "Mean grain radius."},
    {"material.rho", "<var>ρ</var>", "{/:Italic ρ}", "μg/mm³ (= kg/m³)", "Density of the grains' solid."},
    {"material.gamma", "<var>γ</var>", "{/:Italic γ}", "μg/μs (= 0.001 kg/s)", "Viscosity of a contact."},
    {"material.gamma_b", "<var>γ</var><sub>b</sub>", "{/:Italic γ}_b", "μg/μs (= 0.001 kg/s)",
     "Viscosity of the background, a drag on every grain."},
    {"k_star", "<var>k</var>*", "{/:Italic k}*", "kPa",
     "Unit of stress, k/(2⟨r⟩). A stress in kPa is its starred value times this."},
};

}  // namespace

const std::vector<SymbolGroup>& symbol_groups() {
  static const std::vector<SymbolGroup> groups{
      {"State of a packing", state},
      {"Isotropic laws, one set per mode (Eqs. 2.11, 2.12, 2.14)", isotropic},
      {"Shear laws (Eqs. 2.17, 2.18, 2.20)", shear},
      {"Small-strain moduli (Eqs. 4.11 – 4.15)", moduli},
      {"Memory of the jamming density (Eqs. 5.1 – 5.13)", memory},
      {"Fabric under change of volume", volumetric},
      {"Material", material},
  };
  return groups;
}

const Symbol* find_symbol(std::string_view name, std::string_view group) {
  if (group == "shear_axial") group = "shear";       // the same letters, of another mode
  if (group == "near_jamming") group = "isotropic";  // its shear laws: group shear
  const std::string full = group.empty() ? std::string(name) : std::string(group) + "." + std::string(name);
  const Symbol* plain = nullptr;
  for (const SymbolGroup& part : symbol_groups()) {
    for (const Symbol& entry : part.symbols) {
      if (entry.key == full) return &entry;
      if (entry.key == name) plain = &entry;
    }
  }
  return plain;
}

Markup symbol(std::string_view name, std::string_view group) {
  const Symbol* known = find_symbol(name, group);
  return known ? Markup::trusted(std::string(known->html)) : text(name);
}

std::string enhanced(std::string_view plain) {
  std::string escaped;
  for (const char c : plain) {
    if (std::string_view("{}^_@&~\\").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string axis_label(const std::string& name, const std::string& fallback) {
  static const std::array<std::pair<std::string_view, std::string_view>, 16> words{{
      {"nu", "volume fraction"},
      {"eps_vol", "volume strain"},
      {"eps_dev", "shear strain"},
      {"P", "pressure"},
      {"p_star", "scaled pressure"},
      {"sigma_dev", "shear stress"},
      {"s_dev", "stress ratio"},
      {"F_dev", "contact anisotropy"},
      {"F_v", "fabric trace"},
      {"C", "contacts per grain"},
      {"C_star", "contacts per loaded grain"},
      {"phi_r", "rattler fraction"},
      {"s_max", "saturation"},
      {"beta_s", "rate"},
      {"F_max", "saturation"},
      {"beta_F", "rate"},
  }};
  const Symbol* known = find_symbol(name);
  if (!known) return enhanced(fallback.empty() ? name : fallback);
  const std::string unit = " (" + std::string(known->unit) + ")";
  for (const auto& [key, word] : words) {
    if (key == name) return std::string(word) + " " + std::string(known->plot) + unit;
  }
  return std::string(known->plot) + unit;
}

std::string mode_name(const std::string& mode) {
  if (mode == "iso") return "ISO";
  if (mode == "uni") return "UNI";
  if (mode == "d2") return "D2";
  if (mode == "d3") return "D3";
  return mode;
}

std::string form_name(const std::string& form) {
  if (form == "reduced_closed") return "reduced, closed form";
  if (form == "reduced") return "reduced, rate form";
  return form;
}

std::string mode_colour(const std::string& mode) {
  if (mode == "iso") return "#0072b2";
  if (mode == "uni") return "#009e73";
  if (mode == "d2") return "#d55e00";
  if (mode == "d3") return "#cc79a7";
  return measured_colour;
}

std::string form_colour(const std::string& form) {
  if (form == "reduced_closed") return "#56b4e9";
  if (form == "reduced") return "#0072b2";
  if (form == "coupled") return "#d55e00";
  if (form.starts_with("memory")) return "#009e73";
  return ink;
}

std::string nth_colour(std::size_t n) {
  static const std::array<const char*, 6> colours{"#0072b2", "#d55e00", "#009e73",
                                                  "#cc79a7", "#e69f00", "#56b4e9"};
  return colours[n % colours.size()];
}

std::string seed_grey(std::size_t n) {
  static const std::array<const char*, 3> greys{"#666666", "#b0b0b0", "#8a8a8a"};
  return greys[n % greys.size()];
}

std::string ramp(double share) {
  constexpr std::array<std::array<int, 3>, 4> anchors{
      {{0x44, 0x01, 0x54}, {0x3b, 0x52, 0x8b}, {0x21, 0x91, 0x8c}, {0x5e, 0xc9, 0x62}}};
  const double at = std::clamp(share, 0.0, 1.0) * (anchors.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(at), anchors.size() - 2);
  const double t = at - static_cast<double>(i);
  std::array<char, 8> text{};
  std::array<int, 3> c{};
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = static_cast<int>(std::lround((1 - t) * anchors[i][k] + t * anchors[i + 1][k]));
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", c[0], c[1], c[2]);
  return text.data();
}

}  // namespace grainlaw::report
