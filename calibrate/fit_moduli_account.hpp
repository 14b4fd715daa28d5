// The moduli in the account of all fits: the tables of moduli that d2 tests kept. Internal to fit_records.
#pragma once

#include "grainlaw/calibrate/fit_account.hpp"

namespace grainlaw::calibrate {

/// Fits group moduli to the d2 tests of role fit that have a table of moduli; nothing where none has. Needs
/// account.packing of d2, whose laws give Eq. 4.11 its slope of F_v and its nu_c. Other tests with a table
/// are listed as left out, and so are refused states.
void fit_moduli_of(Account& account, const RecordFolder& folder, const Reference& reference);

}  // namespace grainlaw::calibrate
