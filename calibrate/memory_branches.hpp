// Jamming densities that cycles of over-compression leave behind: each unloading branch of a record
// extrapolated to where its pressure vanishes (Eq. 5.4), and, independently, to where its contacts begin
// (Eqs. 5.7, 5.8).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"

namespace grainlaw::calibrate {

/// A number that a fit gave; NaN where it gave none.
struct Estimate {
  double value, error;
  Estimate();
  Estimate(double known, double with_error) : value(known), error(with_error) {}
  bool known() const;
};

/// What the branch after the M-th compression to phi_max says.
struct CycleDensity {
  std::string test, group;  ///< name of the record, and its seed
  std::size_t leg = 0;      ///< of the unloading on that record's path
  double phi_max = 0;       ///< the largest volume fraction so far
  double M = 0;             ///< compressions to it so far, 1 for the first
  Estimate from_P;          ///< phi_J of Eq. 5.4
  Estimate from_C_star;     ///< of Eq. 5.7
  Estimate from_f_NR;       ///< of Eq. 5.8
  double p0 = 0;            ///< slope of the scaled pressure; held where the branch is too short for it
  std::size_t rows = 0;     ///< taken; 0: not jammed at any row
};

/// A branch is extrapolated from its rows up to this nu over the lowest one taken, less one: further up the
/// curvature gamma_p takes part, which the thesis gives as 0 +- 0.1.
inline constexpr double branch_range = 0.04;
/// A branch shorter than this does not give a slope of its own.
inline constexpr double branch_slope_range = 0.008;

/// The unloading branches of a record of iso cycles that start at its largest volume fraction so far; others
/// are no cycles of over-compression. `laws` are the numbers that Eqs. 5.4, 5.7 and 5.8 are held at: C0, C1,
/// alpha, phi_c, phi_v (isotropic.iso), and p0 for branches that are too short.
std::vector<CycleDensity> cycle_densities(const TestRecord& test, const KnownValues& laws,
                                          const Selection& selection);
std::string cycle_rule(const Selection& selection);

}  // namespace grainlaw::calibrate
