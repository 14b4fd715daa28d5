// Pictures of what `grainlaw predict` writes: a table along a path, and a response envelope.
#pragma once

#include <filesystem>

#include "grainlaw/element/record.hpp"

namespace grainlaw::apps {

/// Whether pictures can be written to a file of that name: it ends in .svg or .png. Throws Error (--plot)
/// otherwise.
void check_picture(const std::filesystem::path& file);

/// Stress, fabric and volume fraction over the strain that changes most, and the path in stress. Stresses are
/// in kPa where the columns say so.
void write_picture(const std::filesystem::path& file, const Record& prediction);

/// Strain increments, and beside them the stresses they lead to.
void write_envelope_picture(const std::filesystem::path& file, const Record& responses);

}  // namespace grainlaw::apps
