#include "grainlaw/calibrate/fit_parameters.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

using model::MemoryLaws;
using model::ModuliLaws;
using model::PackingLaw;
using model::Parameter;
using model::SaturationLaw;

template <class Group>
using Keys = std::vector<std::pair<const char*, Parameter Group::*>>;

const Keys<PackingLaw> contact_keys{{"C0", &PackingLaw::C0},
                                    {"C1", &PackingLaw::C1},
                                    {"alpha", &PackingLaw::alpha},
                                    {"nu_c_contacts", &PackingLaw::nu_c_contacts}};
const Keys<PackingLaw> rattler_keys{{"phi_c", &PackingLaw::phi_c}, {"phi_v", &PackingLaw::phi_v}};
const Keys<PackingLaw> pressure_keys{
    {"p0", &PackingLaw::p0}, {"gamma_p", &PackingLaw::gamma_p}, {"nu_c", &PackingLaw::nu_c}};
const Keys<SaturationLaw> saturation_keys{{"Q_max", &SaturationLaw::Q_max},
                                          {"Q_v", &SaturationLaw::Q_v},
                                          {"alpha", &SaturationLaw::alpha},
                                          {"nu_c", &SaturationLaw::nu_c}};
const Keys<ModuliLaws> moduli_keys{{"p0", &ModuliLaws::p0},         {"gamma_p", &ModuliLaws::gamma_p},
                                   {"nu_c", &ModuliLaws::nu_c},     {"g3", &ModuliLaws::g3},
                                   {"a_I", &ModuliLaws::a_I},       {"a_II", &ModuliLaws::a_II},
                                   {"g_I", &ModuliLaws::g_I},       {"GB_max", &ModuliLaws::GB_max},
                                   {"Fv_min", &ModuliLaws::Fv_min}, {"Fv_alpha", &ModuliLaws::Fv_alpha}};
const Keys<ModuliLaws> bulk_keys{
    {"p0", &ModuliLaws::p0}, {"gamma_p", &ModuliLaws::gamma_p}, {"nu_c", &ModuliLaws::nu_c}};
const Keys<ModuliLaws> first_keys{{"a_I", &ModuliLaws::a_I}}, second_keys{{"a_II", &ModuliLaws::a_II}};
const Keys<ModuliLaws> initial_keys{
    {"GB_max", &ModuliLaws::GB_max}, {"Fv_min", &ModuliLaws::Fv_min}, {"Fv_alpha", &ModuliLaws::Fv_alpha}};
const Keys<ModuliLaws> decrease_keys{{"g_I", &ModuliLaws::g_I}};
const Keys<MemoryLaws> memory_keys{
    {"phi_SJ", &MemoryLaws::phi_SJ},       {"mu", &MemoryLaws::mu},
    {"beta", &MemoryLaws::beta},           {"alpha_max", &MemoryLaws::alpha_max},
    {"alpha_phi", &MemoryLaws::alpha_phi}, {"alpha", &MemoryLaws::alpha},
    {"eps0", &MemoryLaws::eps0},           {"eps0_R", &MemoryLaws::eps0_R}};

const Keys<MemoryLaws> over_compression_keys{{"phi_SJ", &MemoryLaws::phi_SJ},
                                             {"mu", &MemoryLaws::mu},
                                             {"beta", &MemoryLaws::beta},
                                             {"alpha_max", &MemoryLaws::alpha_max},
                                             {"alpha_phi", &MemoryLaws::alpha_phi}};
const Keys<MemoryLaws> shear_jamming_keys{{"alpha", &MemoryLaws::alpha}, {"eps0", &MemoryLaws::eps0}};
const Keys<MemoryLaws> reversal_keys{{"eps0_R", &MemoryLaws::eps0_R}};

std::optional<double> find(const KnownValues& known, const std::string& name) {
  const auto found = known.find(name);
  return found == known.end() ? std::nullopt : std::optional(found->second.value);
}

Parameter assumed(double value, const std::string& name, const std::string& note, const KnownValues& thesis) {
  Parameter p;
  p.value = value;
  p.source = "assumed";
  p.thesis = find(thesis, name);
  p.note = note;
  return p;
}

Parameter from_estimate(const FitEstimate& e, const KnownValues& thesis, const Reference& reference,
                        const std::string& left_out_of_error) {
  Parameter p;
  p.value = e.value;
  p.stderr_ = e.stderr_;
  p.unit = e.unit;
  p.thesis = find(thesis, e.name);
  if (e.held) {
    p.source = "assumed";
    if (!e.determined) p.note = reference.whose() + ": the data do not determine it: " + e.reason;
  } else if (!e.determined) {
    p.note = "not determined: " + e.reason;
  } else if (e.at_bound) {
    p.note = "rests on the bound of the law";
  } else if (e.stderr_) {
    p.note = left_out_of_error;
  }
  return p;
}

/// "its error leaves out that of alpha, ...", for the free parameters of a fit in which others are held at
/// values without an error; else empty.
std::string left_out_of_errors(const FitResult& fit, const Reference& reference) {
  std::string names;
  for (const FitEstimate& e : fit.parameters) {
    if (e.held && !e.determined && !e.stderr_) names += (names.empty() ? "" : ", ") + e.name;
  }
  if (names.empty()) return "";
  return "its error leaves out that of " + names + ", held at " + reference.whose() + ", which has none";
}

/// A parameter that is open, although free: its law cannot be used as it stands.
const FitEstimate* open_estimate(const FitResult& fit) {
  for (const FitEstimate& e : fit.parameters) {
    if (!e.determined && (!e.held || !fit.ran)) return &e;
  }
  return nullptr;
}

/// Fills the parameters `keys` of a law from its fit; false if nothing is known of one of them.
template <class Group>
bool fill(Group& group, const Keys<Group>& keys, const FitResult& fit, const KnownValues& fallback,
          const KnownValues& thesis, const Reference& reference) {
  const FitEstimate* open = open_estimate(fit);
  bool all_known = true;
  for (const auto& [name, member] : keys) all_known = all_known && find(fallback, name);
  if (open != nullptr && !all_known && !fit.ran) return false;
  for (const auto& [name, member] : keys) {
    const FitEstimate& e = fit[name];
    if (open != nullptr && all_known) {
      group.*member =
          assumed(*find(fallback, name), name,
                  reference.whose() + ": " + open->name + " is not determined: " + open->reason, thesis);
    } else {
      group.*member = from_estimate(e, thesis, reference, left_out_of_errors(fit, reference));
    }
  }
  return true;
}

template <class Group>
KnownValues values_of(const Group& group, const Keys<Group>& keys) {
  KnownValues values;
  for (const auto& [name, member] : keys) {
    const Parameter& p = group.*member;
    values.emplace(name, KnownValue(p.value, p.stderr_.value_or(0)));
  }
  return values;
}

template <class Group>
void mark_as_other_material(Group& group, const Keys<Group>& keys, const std::string& whose) {
  for (const auto& [name, member] : keys) {
    Parameter& p = group.*member;
    p.source = "assumed";
    p.thesis.reset();
    p.note = whose;
  }
}

std::optional<SaturationLaw> row_of(const model::ShearLaws& shear, const std::string& quantity) {
  if (quantity == "s_max") return shear.s_max;
  if (quantity == "beta_s") return shear.beta_s;
  if (quantity == "F_max") return shear.F_max;
  if (quantity == "beta_F") return shear.beta_F;
  return std::nullopt;
}

}  // namespace

Reference::Reference(const std::optional<model::ParameterSet>& set, const Material& material)
    : set_(set), material_(material) {
  same_material_ = set_ && std::abs(set_->material.w - material.w) < 1e-9;
}

std::string Reference::whose() const {
  return same_material_ || !set_ ? "the thesis's value"
                                 : "the thesis's value for w = " + to_text(set_->material.w);
}

KnownValues Reference::packing(const std::string& mode) const {
  if (!set_ || !set_->isotropic.contains(mode)) return {};
  const PackingLaw& row = set_->isotropic.at(mode);
  KnownValues values = values_of(row, contact_keys);
  values.merge(values_of(row, rattler_keys));
  values.merge(values_of(row, pressure_keys));
  return values;
}

KnownValues Reference::shear(const std::string& quantity) const {
  if (!set_ || !set_->shear) return {};
  const auto row = row_of(*set_->shear, quantity);
  return row ? values_of(*row, saturation_keys) : KnownValues{};
}

KnownValues Reference::thesis_packing(const std::string& mode) const {
  return same_material_ ? packing(mode) : KnownValues{};
}

KnownValues Reference::thesis_shear(const std::string& quantity) const {
  return same_material_ ? shear(quantity) : KnownValues{};
}

std::optional<ModuliLaws> Reference::moduli() const {
  if (!set_ || !set_->moduli) return std::nullopt;
  ModuliLaws moduli = *set_->moduli;
  if (!same_material_) mark_as_other_material(moduli, moduli_keys, whose());
  moduli.g3.value = fabric_size_factor(material_.w);
  moduli.g3.note = "Eq. 3.8 for w = " + to_text(material_.w);
  return moduli;
}

KnownValues Reference::moduli_values() const {
  return set_ && set_->moduli ? values_of(*set_->moduli, moduli_keys) : KnownValues{};
}

KnownValues Reference::thesis_moduli() const { return same_material_ ? moduli_values() : KnownValues{}; }

KnownValues Reference::memory_values() const {
  return set_ && set_->memory ? values_of(*set_->memory, memory_keys) : KnownValues{};
}

KnownValues Reference::thesis_memory() const { return same_material_ ? memory_values() : KnownValues{}; }

Parameter Reference::fabric_factor() const {
  Parameter g3 = assumed(fabric_size_factor(material_.w), "g3", "Eq. 3.8 for w = " + to_text(material_.w),
                         thesis_moduli());
  g3.unit = "1";
  return g3;
}

std::optional<MemoryLaws> Reference::memory() const {
  if (!set_ || !set_->memory) return std::nullopt;
  MemoryLaws memory = *set_->memory;
  if (!same_material_) {
    mark_as_other_material(memory, memory_keys, whose());
    for (auto* option : {&memory.phi_cr, &memory.alpha_P, &memory.eps0_P, &memory.eps0_R_P, &memory.eps_r,
                         &memory.hold, &memory.pack_rate, &memory.phi_pack})
      if (*option) (*option)->source = "assumed";
  }
  return memory;
}

std::optional<PackingLaw> packing_law(const PackingFit& fit, const KnownValues& fallback,
                                      const KnownValues& thesis, const Reference& reference) {
  PackingLaw law;
  const bool known = fill(law, contact_keys, fit.contacts, fallback, thesis, reference) &&
                     fill(law, rattler_keys, fit.rattlers, fallback, thesis, reference) &&
                     fill(law, pressure_keys, fit.pressure, fallback, thesis, reference);
  if (!known) return std::nullopt;
  law.C0.note = "isostatic number of frictionless spheres; the fit with C0 free is in fits.json";
  return law;
}

std::optional<ModuliLaws> moduli_laws(const ModuliFit& fit, const Reference& reference) {
  const KnownValues fallback = reference.moduli_values(), thesis = reference.thesis_moduli();
  ModuliLaws law;
  const bool known = fill(law, bulk_keys, fit.B, fallback, thesis, reference) &&
                     fill(law, first_keys, fit.A1, fallback, thesis, reference) &&
                     fill(law, second_keys, fit.A2, fallback, thesis, reference) &&
                     fill(law, initial_keys, fit.GB_ini, fallback, thesis, reference) &&
                     fill(law, decrease_keys, fit.G, fallback, thesis, reference);
  if (!known) return std::nullopt;
  law.g3 = reference.fabric_factor();
  if (fit.A.ran && fit.A.determined()) {
    law.a_F = from_estimate(fit.A["a_F"], thesis, reference, "");
    law.a_s = from_estimate(fit.A["a_s"], thesis, reference, "");
  }
  return law;
}

std::optional<model::VolumetricLaws> volumetric_laws(const VolumetricFit& fit, const Reference& reference) {
  if (!fit.compression.ran || !fit.compression.determined()) return std::nullopt;
  const FitEstimate& down = fit.decompression["decompression"];
  const bool known = fit.decompression.ran && down.determined;
  return model::VolumetricLaws{
      from_estimate(fit.compression["compression"], {}, reference, ""),
      known ? from_estimate(down, {}, reference, "")
            : assumed(0, "decompression", "neglected, as in the thesis: " + down.reason, {})};
}

model::VolumetricLaws usual_volumetric_laws() {
  // docs/model.md, Fabric under change of volume: 9.05 +- 0.55 and 0.86 +- 0.53.
  const std::string why =
      "no sheared packing of these tests changes its volume alone; that of data/records/volumetric, w = 3";
  return {assumed(9.05, "compression", why, {}), assumed(0.86, "decompression", why, {})};
}

std::optional<MemoryLaws> memory_laws(const MemoryFit& fit, const Reference& reference) {
  const KnownValues fallback = reference.memory_values(), thesis = reference.thesis_memory();
  MemoryLaws law;
  const bool known = fill(law, over_compression_keys, fit.over_compression, fallback, thesis, reference) &&
                     fill(law, shear_jamming_keys, fit.shear, fallback, thesis, reference) &&
                     fill(law, reversal_keys, fit.reversal, fallback, thesis, reference);
  if (!known) return std::nullopt;
  if (fit.phi_SJ.found()) {
    law.phi_SJ.value = fit.phi_SJ.value;
    law.phi_SJ.stderr_ = fit.phi_SJ.error;
    law.phi_SJ.source = "fit";
    std::string with;
    if (fit.phi_SJ.by_shear.known()) with = "with that of the strains that jam by shear";
    if (fit.phi_SJ.by_rest.known())
      with += (with.empty() ? "with" : " and") + std::string(" that of relaxed steady states");
    law.phi_SJ.note = with;
  }
  const FitEstimate& phi_cr = fit.reversal["phi_cr"];
  if (fit.reversal.ran && phi_cr.determined) law.phi_cr = from_estimate(phi_cr, thesis, reference, "");
  return law;
}

std::optional<SaturationLaw> saturation_law(const FitResult& fit, const KnownValues& fallback,
                                            const KnownValues& thesis, const Reference& reference) {
  SaturationLaw law;
  if (!fill(law, saturation_keys, fit, fallback, thesis, reference)) return std::nullopt;
  return law;
}

}  // namespace grainlaw::calibrate
