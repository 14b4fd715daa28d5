// Jamming densities of packings that were sheared before they expanded: small strain to and fro packs them
// (tapping), far strain loosens them.
#pragma once

#include <cstddef>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/memory_branches.hpp"

namespace grainlaw::calibrate {

/// The unloading of a packing after shear at one volume fraction.
struct TappedDensity {
  CycleDensity density;  ///< its phi_max is the volume fraction of the shear
  double phi_max = 0;    ///< the largest volume fraction before the shear; 0 where nothing says
  double amplitude = 0;  ///< half the range of eps_dev of the record it comes from, up to there
  double strain = 0;     ///< that record's strain up to there, to and fro added up
};

/// The first unloading of an iso test that starts where a leg of the record `sheared` ends; none where it
/// does not unload.
std::vector<TappedDensity> tapped_density(const TestRecord& test, const TestRecord& sheared,
                                          const KnownValues& laws, const Selection& selection);

/// The largest volume fraction at the ends of the legs of a record up to this one.
double largest_nu(const TestRecord& test, std::size_t leg);

}  // namespace grainlaw::calibrate
