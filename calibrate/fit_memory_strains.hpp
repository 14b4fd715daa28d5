// The two strains of the form with memory: eps_c, in which shear along its fabric takes the jamming density
// away, from whole D2 tests; eps_r, in which shear against it gives it back, from those of them that are
// reversed.
#pragma once

#include <filesystem>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

/// Gives group memory of `parameters` eps_c and eps_r, where it has what that form needs: fitted to the tests
/// of role fit in `dir`, and assumed (with a note that says why) where these do not tell. Values found in
/// cycles of 9261 grains.
void add_memory_strains(const std::filesystem::path& dir, const RecordFolder& folder,
                        model::ParameterSet& parameters);

}  // namespace grainlaw::calibrate
