// Every fit of a folder of records: rows of each mode and role, each shear test, and the laws over volume
// fraction. Internal to fit_records.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_entry.hpp"
#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_memory.hpp"
#include "grainlaw/calibrate/fit_moduli.hpp"
#include "grainlaw/calibrate/fit_near_jamming.hpp"
#include "grainlaw/calibrate/fit_parameters.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/calibrate/fit_volumetric.hpp"
#include "grainlaw/calibrate/memory_relaxed.hpp"
#include "grainlaw/calibrate/memory_tapping.hpp"

namespace grainlaw::calibrate {

/// What tests of role memory have measured (memory_tables.hpp).
struct MeasuredMemory {
  std::vector<CycleDensity> cycles;
  std::vector<ShearJamming> shear_jammings;
  std::vector<RelaxedState> relaxed;
  std::vector<TappedDensity> tapped;
  bool any() const {
    return !(cycles.empty() && shear_jammings.empty() && relaxed.empty() && tapped.empty());
  }
};

struct Account {
  std::vector<FitEntry> entries;              ///< all fits, in the order of fits.json
  std::vector<LeftOut> left_out;              ///< records that a fit did not take, and why
  std::map<std::string, PackingFit> packing;  ///< by mode, role fit only
  std::map<std::string, PackingFit> narrow;   ///< the same from narrow_P_min on, where that leaves out rows
  double narrow_P_min = 0;
  /// Eq. 2.20 through the tests of role fit, by mode: d2 always, d3 where there are such tests.
  std::map<std::string, std::map<ShearQuantity, FitResult>> density;
  std::map<std::string, std::map<ShearQuantity, std::vector<RunValue>>>
      run_values;   ///< what it was fitted to
  double nu_c = 0;  ///< of Eq. 2.20: that of the isotropic pressure
  bool nu_c_fitted = false;
  std::optional<ModuliFit> moduli;             ///< none where no test has a table of moduli
  bool moduli_nu_c_fitted = false;             ///< the nu_c that its B counts from is that of the d2 tests
  std::vector<CycleDensity> cycles;            ///< of the tests of role memory
  std::vector<ShearJamming> shear_jammings;    ///< likewise
  std::vector<RelaxedState> relaxed;           ///< likewise
  RelaxedLimit relaxed_limit;                  ///< of these
  std::vector<TappedDensity> tapped;           ///< likewise
  std::optional<MemoryFit> memory;             ///< none where no test has that role
  std::optional<NearJammingFit> near_jamming;  ///< none where memory has no phi_SJ
  std::optional<VolumetricFit> volumetric;     ///< none where no sheared packing changed its volume alone

  Json to_json() const;
};

/// Fits everything that the folder holds. The entries of role predict are made from records of that role
/// alone, the others and everything else from records of role fit alone, those of memory from records of that
/// role and what is `measured` besides. `near_jamming` are Tables 5.1 and 5.2 of the thesis.
Account fit_all(const RecordFolder& folder, const Reference& reference, const Reference& near_jamming,
                const MeasuredMemory& measured, const Selection& selection);

}  // namespace grainlaw::calibrate
