// Shear that is stopped to let the grains come to rest (thesis, 5.G): the relaxed states along it, whether
// they still push, and the density of shear jamming where the relaxed steady states cease to (Fig. 5.12).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/calibrate/memory_branches.hpp"

namespace grainlaw::calibrate {

/// A packing at rest after some shear.
struct RelaxedState {
  std::string test, group;
  double phi_max = 0, M = 0;  ///< history of the packing: cycles of over-compression
  Estimate phi_J0;            ///< its jamming density, measured on the unloading it comes from
  double nu = 0;
  double eps_dev = 0;        ///< sheared so far, signed
  double P_flow = 0;         ///< P* of the flow, in the last row before the rest
  double P = 0, s_dev = 0;   ///< P* and sigma_dev/P at rest; s_dev is NaN where P is 0
  double C = 0, C_star = 0;  ///< M4/N and M4/N4; C_star is NaN where no grain has four contacts
  double percolating = 0;    ///< axes along which the strong forces percolate; NaN where not observed
};

/// Whether a test rests after it began to shear: its legs are no shear without a stop.
bool rests_along_shear(const TestRecord& test);

/// The states at the ends of the rests that follow shear, of a packing that comes from this cycle.
std::vector<RelaxedState> relaxed_states(const TestRecord& test, const CycleDensity& from);

/// Steady: sheared at least this far in one direction.
inline constexpr double steady_strain = 0.18;

/// phi_SJ where P, and where the shear stress of the relaxed steady states vanishes, extrapolated linearly
/// over phi C as Eq. 5.4 does: p/(phi C) = (p0/phi_SJ) ln(phi/phi_SJ), with a slope of its own for each. Of
/// volume fractions at which all of these states push: where some do not, those that do are no fair sample.
struct RelaxedLimit {
  Estimate by_pressure, by_shear_stress;
  std::size_t states = 0;  ///< that entered: steady, P >= P_min at their volume fraction
};
RelaxedLimit relaxed_limit(const std::vector<RelaxedState>& states, const Selection& selection);

}  // namespace grainlaw::calibrate
