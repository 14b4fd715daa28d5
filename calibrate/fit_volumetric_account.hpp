// Fabric under change of volume in the account of all fits: isotropic tests of sheared packings. Internal to
// fit_records.
#pragma once

#include "grainlaw/calibrate/fit_account.hpp"

namespace grainlaw::calibrate {

/// Fits group volumetric to the isotropic tests of role fit whose packings were sheared before; nothing where
/// there are none. Those without the fabric's components are listed as left out.
void fit_volumetric_of(Account& account, const RecordFolder& folder, const Selection& selection);

}  // namespace grainlaw::calibrate
