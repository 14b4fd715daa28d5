// The numbers of the form with memory: exponent and strain of Eq. 5.3 from whole D2 tests; what a reversal
// does (eps0_R, eps_r, hold) from those of them that are reversed.
#pragma once

#include <filesystem>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Gives group memory of `parameters` what that form needs, where it can be taken at all: fitted to the tests
/// of role fit in `dir`, and assumed (with a note that says why) where these do not tell.
void add_memory_numbers(const std::filesystem::path& dir, const RecordFolder& folder,
                        model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
