// From fits to a parameter set: what was fitted, what is held at the thesis's value, and what the thesis says
// beside it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_memory.hpp"
#include "grainlaw/calibrate/fit_moduli.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"
#include "grainlaw/calibrate/fit_volumetric.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// The thesis's parameter set as a reference: values beside the fitted ones, where it is of the same w;
/// values to fall back on, whatever its w.
class Reference {
 public:
  Reference() = default;
  Reference(const std::optional<model::ParameterSet>& set, const Material& material);

  bool same_material() const { return same_material_; }
  /// isotropic.MODE and shear.QUANTITY by parameter name, to fall back on; empty where the set has none.
  KnownValues packing(const std::string& mode) const;
  KnownValues shear(const std::string& quantity) const;
  /// The same, only where it is the thesis's value for this very material.
  KnownValues thesis_packing(const std::string& mode) const;
  KnownValues thesis_shear(const std::string& quantity) const;
  /// Group moduli by parameter name, likewise.
  KnownValues moduli_values() const;
  KnownValues thesis_moduli() const;
  /// Group memory, likewise.
  KnownValues memory_values() const;
  KnownValues thesis_memory() const;
  /// The groups as a whole, where no fit fills them; source thesis, or assumed where the set is of another w.
  /// g3 is Eq. 3.8 for the records' own w.
  std::optional<model::ModuliLaws> moduli() const;
  std::optional<model::MemoryLaws> memory() const;
  /// "the thesis's value", "the thesis's value for w = 3", to be used in notes.
  std::string whose() const;
  /// g3 of Eq. 3.8 for the records' own w, beside that of the thesis where it is of the same w.
  model::Parameter fabric_factor() const;

 private:
  std::optional<model::ParameterSet> set_;
  Material material_;
  bool same_material_ = false;
};

/// isotropic.MODE out of the fits of one mode. A law with a parameter that is open and could not be held
/// falls back as a whole. None if a law could not be fitted and nobody knows its values.
std::optional<model::PackingLaw> packing_law(const PackingFit& fit, const KnownValues& fallback,
                                             const KnownValues& thesis, const Reference& reference);
/// Group moduli out of its fits; g3 is Eq. 3.8 for the records' own w.
std::optional<model::ModuliLaws> moduli_laws(const ModuliFit& fit, const Reference& reference);
/// Group volumetric out of its fits; none where the data do not determine compression. Decompression that
/// they do not determine is assumed to do nothing, as in the thesis.
std::optional<model::VolumetricLaws> volumetric_laws(const VolumetricFit& fit, const Reference& reference);
/// What is assumed where no test tells.
model::VolumetricLaws usual_volumetric_laws();
/// Group memory out of its fits; without phi_cr where the data do not tell it. None if a law could not be
/// fitted and nobody knows its values.
std::optional<model::MemoryLaws> memory_laws(const MemoryFit& fit, const Reference& reference);
/// shear.QUANTITY out of its fit over volume fraction.
std::optional<model::SaturationLaw> saturation_law(const FitResult& fit, const KnownValues& fallback,
                                                   const KnownValues& thesis, const Reference& reference);

}  // namespace grainlaw::calibrate
