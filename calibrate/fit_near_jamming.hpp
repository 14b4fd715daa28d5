// Fits of the laws that chapter 5 takes near jamming: C*, rattlers and pressure over phi/phi_J, isotropic and
// sheared (Eqs. 5.7 to 5.9, Table 5.1), and the saturation and rate of stress ratio and fabric (Eq. 5.12,
// Table 5.2). The same laws as of the whole range, by states close to it.
#pragma once

#include <map>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/calibrate/fit_shear.hpp"
#include "grainlaw/calibrate/memory_relaxed.hpp"

namespace grainlaw::calibrate {

/// Volume fractions up to this over phi_SJ, less one, are near jamming, as for free_C0_range.
inline constexpr double near_jamming_range = free_C0_range;

/// What the laws are fitted to.
struct NearJammingData {
  std::vector<PackingSeries> unloading;  ///< rows of isotropic unloading
  std::vector<PackingSeries> flowing;    ///< steady D2, a state per run
  std::vector<PackingSeries> resting;    ///< relaxed steady D2, a state per run
  std::map<ShearQuantity, std::vector<RunValue>> runs;
};

/// A state per run: the mean of its rests beyond steady_strain and its standard error. Where a rest of its
/// volume fraction does not push (P < P_min), none: those that do are no fair sample.
std::vector<PackingSeries> resting_states(const std::vector<RelaxedState>& states,
                                          const Selection& selection);

/// Saturation and rate of the first loadings of these D2 tests: the run's own fit of Eq. 5.10 or 5.11 where
/// it determines both, else the mean of its steady rows and no rate.
std::map<ShearQuantity, std::vector<RunValue>> loading_values(const std::vector<TestRecord>& tests,
                                                              const Selection& selection);

/// Everything of `tests` (isotropic and D2 of role fit) and of rests, up to `nu_max`.
NearJammingData near_jamming_data(const std::vector<TestRecord>& tests,
                                  const std::vector<RelaxedState>& rests, double nu_max,
                                  const Selection& selection);

/// What to hold where the data do not tell: numbers of Table 5.1, and Table 5.2.
struct NearJammingKnown {
  KnownValues isotropic, sheared;  ///< both columns
  std::map<ShearQuantity, KnownValues> shear;
};

struct NearJammingFit {
  PackingFit isotropic;         ///< first column of Table 5.1
  PackingFit flowing, resting;  ///< its second, in steady flow and at rest
  /// Steady flow again, C*, rattlers and P all counted from phi_SJ, as Eqs. 5.7 to 5.9 do.
  PackingFit flowing_from_phi_SJ;
  std::map<ShearQuantity, FitResult> shear;       ///< Table 5.2, counted from phi_SJ
  std::map<ShearQuantity, FitProblem> shear_law;  ///< as fitted
};

/// All of them; never throws for want of data, see FitEstimate::determined. Isotropic packings have a phi_J
/// each, which their own fits find; steady shear has one.
NearJammingFit fit_near_jamming(const NearJammingData& data, const KnownValue& phi_SJ,
                                const NearJammingKnown& known);

}  // namespace grainlaw::calibrate
