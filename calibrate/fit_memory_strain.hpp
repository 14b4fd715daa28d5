// The strain of the form with memory: eps_c, by which the memory of shear is later than the fabric, from
// whole D2 tests.
#pragma once

#include <filesystem>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Gives group memory of `parameters` eps_c, where it has what that form needs: fitted to the tests of role
/// fit in `dir`, and assumed (with a note that says why) where these do not tell.
void add_memory_strain(const std::filesystem::path& dir, model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
