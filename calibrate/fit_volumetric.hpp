// Fit of how the deviatoric fabric changes when only the volume does, over isotropic compression and
// decompression of sheared packings. Group volumetric of a parameter set.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// Fabric along the axis of the shear before, over volume, of one isotropic leg.
struct VolumetricCurve {
  std::string test;   ///< name of the record
  std::string group;  ///< its seed
  bool compression = true;
  std::vector<double> strain;  ///< ln nu since the leg began
  std::vector<double> share;   ///< F_dev over that at the start of the leg
};

/// The isotropic legs of a test whose packing was sheared before; `P_min` keeps out rows that carry nothing,
/// and ends a leg there. Without a record of the fabric's components there is none.
std::vector<VolumetricCurve> volumetric_curves(const TestRecord& test, double P_min);

/// F_dev/F_dev,0 = exp(-k ln(nu/nu_0)), through all curves of one direction. Parameter `name`: compression or
/// decompression.
FitProblem volumetric_problem(const std::vector<VolumetricCurve>& curves, const std::string& name);

/// Group volumetric.
struct VolumetricFit {
  FitResult compression, decompression;
  FitProblem compression_law, decompression_law;  ///< as fitted, with their data
};

/// Both directions; never throws for want of data, see FitEstimate::determined.
VolumetricFit fit_volumetric(const std::vector<VolumetricCurve>& curves);

}  // namespace grainlaw::calibrate
