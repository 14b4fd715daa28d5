// Which rows of a record a fit reads: the unloading branch, the steady state of large shear, the first
// loading. The rules stand here, in docs/fits.md and, with the number of rows left out, in fits.json.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_shear.hpp"

namespace grainlaw::calibrate {

/// All rules ask for what is controlled (volume fraction, strain) or for pressure, never for the quantity
/// that is fitted: rows with C* < 6 are not left out for that, since it would lift the fit towards 6.
struct Selection {
  double P_min = 2e-4;            ///< P* from which a packing counts as jammed throughout
  double Ek_over_Ep_max = 1e-2;   ///< rows that move too much to be states
  double steady_from = 0.15;      ///< |eps_dev| from which shear counts as steady
  std::size_t steady_rows = 10;   ///< fewest rows of a steady state
  std::size_t loading_rows = 10;  ///< fewest rows of a loading
};

/// What a rule left of one record.
struct Counted {
  std::size_t rows = 0;      ///< taken
  std::size_t left_out = 0;  ///< of the same leg
  std::string reason;        ///< why nothing was taken, else empty
};

/// Rows of one leg, with P >= P_min and E_k/E_p <= Ek_over_Ep_max.
PackingSeries unloading_leg(const TestRecord& test, std::size_t leg, const Selection& selection,
                            Counted& counted);

/// Rows of the last leg in which nu decreases, with P >= P_min and E_k/E_p <= Ek_over_Ep_max.
PackingSeries unloading_branch(const TestRecord& test, const Selection& selection, Counted& counted);
std::string unloading_rule(const Selection& selection);

/// One state: means over the rows of the first loading with |eps_dev| >= steady_from, with their errors
/// from the rows' autocorrelation. Nothing is taken if the leg has too few such rows or if the mean of P is
/// below P_min.
PackingSeries steady_state(const TestRecord& test, const Selection& selection, Counted& counted);
std::string steady_rule(const Selection& selection);

/// The stress ratio or the fabric ("s_dev", "F_dev") over the first loading, counted positive along it: the
/// projection on its deviator where the record has components.
ShearCurve first_loading(const TestRecord& test, const std::string& quantity, const Selection& selection,
                         Counted& counted);
std::string loading_rule(const Selection& selection);

/// Mean of the rows with |eps_dev| >= steady_from, with its error from their autocorrelation; none if they
/// are too few.
std::optional<RunValue> steady_mean(const ShearCurve& curve, const Selection& selection);
std::string steady_mean_rule(const Selection& selection);

}  // namespace grainlaw::calibrate
