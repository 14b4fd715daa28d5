// The numbers of the form with memory: eps_c, the strain by which the memory of shear is later than the
// fabric, from whole D2 tests; hold, by which it slows the fabric, from those of them that are reversed.
#pragma once

#include <filesystem>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Gives group memory of `parameters` eps_c and hold, where it has what that form needs: fitted to the tests
/// of role fit in `dir`, and assumed (with a note that says why) where these do not tell.
void add_memory_numbers(const std::filesystem::path& dir, const RecordFolder& folder,
                        model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
