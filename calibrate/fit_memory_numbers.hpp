// The numbers of the form with memory: exponent and strain of Eq. 5.3 from whole D2 tests; what a reversal
// does (eps0_R, eps_r, phi_pack from P, hold from F_dev) from those that are reversed.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Whether it is one of those that the numbers of a reversal are fitted to: D2 of role fit that turns its
/// shear round.
bool tells_of_reversals(const TestRecord& test);

/// Gives group memory of `parameters` what that form needs, where it can be taken at all: fitted to the D2
/// tests of role fit in `folder`, what a reversal does to those in `reversals` that turn their shear round
/// (where it is empty: of `folder`), and assumed (with a note that says why) where these do not tell. Returns
/// the names of those that were asked of tests in vain.
std::vector<std::string> add_memory_numbers(const RecordFolder& folder, const RecordFolder& reversals,
                                            model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
