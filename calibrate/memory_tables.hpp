// over_compression.csv, shear_jamming.csv, relaxed.csv and tapped.csv (docs/formats.md): what tests of role
// memory measured, small enough to be kept where their records are not. The fits of group memory read nothing
// else.
#pragma once

#include <filesystem>
#include <vector>

#include "grainlaw/calibrate/memory_branches.hpp"
#include "grainlaw/calibrate/memory_relaxed.hpp"
#include "grainlaw/calibrate/memory_shear.hpp"
#include "grainlaw/calibrate/memory_tapping.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {

/// One row per cycle, numbers to 1e-7; phi_J is empty where the packing was not jammed.
Record over_compression_table(const std::vector<CycleDensity>& cycles);
/// One row per leg of shear.
Record shear_jamming_table(const std::vector<ShearJamming>& runs);
/// One row per rest.
Record relaxed_table(const std::vector<RelaxedState>& states);
/// One row per unloading.
Record tapped_table(const std::vector<TappedDensity>& packings);

/// Read such a file back. Rows of one seed and phi_max that follow each other are one record. Throws Error as
/// Record::read_csv does, and for a seed that is not a whole number.
std::vector<CycleDensity> read_over_compression(const std::filesystem::path& file);
std::vector<ShearJamming> read_shear_jamming(const std::filesystem::path& file);
std::vector<RelaxedState> read_relaxed(const std::filesystem::path& file);
std::vector<TappedDensity> read_tapped(const std::filesystem::path& file);

}  // namespace grainlaw::calibrate
