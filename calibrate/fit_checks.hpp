// What theory and the thesis demand of the fitted numbers: printed with every fit, never used by one.
#pragma once

#include "grainlaw/calibrate/fit_account.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw::calibrate {

/// A list of {"name", "value", "holds"}; `holds` is null where the records do not tell.
Json physics_checks(const Account& account);

}  // namespace grainlaw::calibrate
