// The jamming density's memory in the account of all fits: the tests of role memory. Internal to fit_records.
#pragma once

#include <vector>

#include "grainlaw/calibrate/fit_account.hpp"

namespace grainlaw::calibrate {

/// Fits group memory to the tests of role memory: cycles of iso, and d2 from a state on the unloading of one
/// of these, and to what is `measured` besides; nothing where there is neither. Relaxed states along d2 tell
/// phi_SJ, too; unloadings of tapped packings are measured, and enter no parameter. Others of that role are
/// listed as left out. Needs account.packing of iso, at whose laws branches are extrapolated.
void fit_memory_of(Account& account, const RecordFolder& folder, const Reference& reference,
                   const MeasuredMemory& measured, const Selection& selection);

/// What stands under `memory` in fits.json: the growth laws compared, which parameters are entangled, how far
/// the signs of jamming agree, the relaxed states with the phi_SJ of the steady ones, and the tapped
/// packings. account.memory must be there.
Json memory_json(const Account& account);

}  // namespace grainlaw::calibrate
