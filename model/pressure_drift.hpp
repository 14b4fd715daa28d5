// How much pressure cycles of shear pump: Eq. 4.16 has no restoring term in dP*.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/element/path.hpp"

namespace grainlaw::model {

/// The largest change of P per half cycle of shear at constant volume, as a part of P, over closed cycles;
/// `P_at_ends` of the legs that were walked.
double pressure_drift(const std::vector<Leg>& legs, const std::vector<double>& P_at_ends);

/// Adds a warning where that is more than 1 %.
void tell_drift(double drift, std::vector<std::string>& warnings);

}  // namespace grainlaw::model
