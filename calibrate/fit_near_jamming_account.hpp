// The laws of chapter 5 near jamming as a stage of fit_records: what they are fitted to, what of them the
// parameter set takes, and what fits.json says of them.
#pragma once

#include "grainlaw/calibrate/fit_account.hpp"

namespace grainlaw::calibrate {

/// Fits Tables 5.1 and 5.2 to the tests of role fit near phi_SJ, which the fits of group memory have found;
/// nothing where they have not. `tables` are these tables of the thesis, to stand beside them and in place of
/// what is open.
void fit_near_jamming_of(Account& account, const RecordFolder& folder, const Reference& tables,
                         const Selection& selection);

/// Group near_jamming: the isotropic column and that of steady flow, the shear laws counted from phi_SJ. None
/// where nothing was fitted, or a row is open and nobody knows it.
std::optional<model::NearJammingLaws> near_jamming_laws(const Account& account, const Reference& tables);

}  // namespace grainlaw::calibrate
