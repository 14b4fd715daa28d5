// The strains at which packings below their jamming density jam under shear, and again after each reversal,
// by three criteria that know nothing of each other.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_selection.hpp"
#include "grainlaw/calibrate/memory_branches.hpp"

namespace grainlaw::calibrate {

/// Three signs of a jammed row: as many contacts as a stable balance takes, strong forces that percolate
/// along all three axes, pressure.
enum class JamSign { contacts, percolation, pressure };
inline constexpr std::array<JamSign, 3> jam_signs{JamSign::contacts, JamSign::percolation, JamSign::pressure};
std::string name_of(JamSign sign);

/// C* of frictionless grains from which a row counts as jammed.
inline constexpr double isostatic_C_star = 6;
/// A row counts by the majority of the rows up to two before and two after it, as Fig. 5.11 smooths.
inline constexpr std::size_t smoothing = 2;
/// Jammed from a row on: at least three quarters of the rows over this much strain, and of all to the leg's
/// end, which must be at least half as far. A flow near jamming loses its balance now and then; one that is
/// jammed for a while only, or as often as not, is not jammed.
inline constexpr double sustained_strain = 0.04, sustained_share = 0.75;

/// One leg of shear of one run.
struct ShearJamming {
  std::string test, group;
  double phi_max = 0, M = 0;  ///< history of the packing: cycles of over-compression
  Estimate phi_J0;            ///< its jamming density, measured on the unloading it comes from
  double nu = 0;
  std::size_t reversals = 0;   ///< before this leg: 0 is the first loading
  bool jammed_before = false;  ///< the leg before ended jammed, by contacts; false on the first loading
  /// Deviatoric strain since the leg began at which the run jams, by each sign: 0 where it is jammed
  /// throughout, NaN where it does not jam or its record does not tell. By percolation it is the first row
  /// that percolates along all axes: the strong forces of a jammed flow come and go.
  std::array<double, 3> strain{};
  /// Share of the rows that percolate along all axes, from where it is jammed by contacts; NaN where none is.
  double percolating = 0;
  double longest = 0;  ///< strain of the leg

  double by(JamSign sign) const { return strain[static_cast<std::size_t>(sign)]; }
};

/// Strain at which a run of rows that are jammed or not becomes jammed to stay, as above: `strain` since the
/// beginning, rising. 0 where all rows are jammed, NaN where it never is.
double jamming_strain(const std::vector<double>& strain, const std::vector<bool>& jammed);

/// The legs of shear of a record whose packing comes from a cycle of over-compression that left phi_J0.
std::vector<ShearJamming> shear_jammings(const TestRecord& test, const CycleDensity& from,
                                         const Selection& selection);
std::string shear_jamming_rule(const Selection& selection);

}  // namespace grainlaw::calibrate
