// What the shear laws are fitted to: the stress ratio and the fabric along the deviator of the mode.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"

namespace grainlaw::calibrate {

/// The stress ratio or the fabric of every row, with its sign; NaN or infinite where it is undefined.
struct ShearColumn {
  std::vector<double> values;
  bool projected = false;  ///< false: the record has no components, and these are its signed columns
};

/// Q = stress/P ("s_dev") or fabric ("F_dev"), projected on the deviator of the leg: sqrt(3)/2 (Qyy - Qxx) in
/// D2, Qzz - (Qxx + Qyy)/2 in D3. This is the signed sqrt(3 J2) of the record's column where the deviator of
/// Q is along that of the mode. Elsewhere the column adds the fluctuations of all six components and, near
/// isotropy, jumps between plus and minus their size; the projection fluctuates about its own mean.
ShearColumn shear_column(const TestRecord& test, std::size_t leg, const std::string& quantity);
/// The same on a given axis.
ShearColumn shear_column(const TestRecord& test, const StrainTensor& axis, const std::string& quantity);

}  // namespace grainlaw::calibrate
