// Whether a record that an earlier run left can be gone on with. All that is found wrong throws Error, which
// says what to remove to have the record made again.
#pragma once

#include <filesystem>
#include <string>

#include "grainlaw/element/json.hpp"

namespace grainlaw::calibrate {

/// The record in `dir` must be whole (its files are there and can be read, it has the rows that its scene
/// asks for) and of `scene`, the one that the campaign wants.
void check_kept_record(const std::filesystem::path& dir, const Json& scene);

/// Why the record in `dir` ends before its path does; empty where it does not, or where nothing says so.
std::string cut_short(const std::filesystem::path& dir);

/// Throws Error unless a table of `rows` rows may be the record in `dir` of a path with `wanted` rows: all of
/// them, or, of one that is cut short, as many as its provenance says.
void check_row_count(const std::filesystem::path& dir, std::size_t rows, std::size_t wanted);

/// Its snapshots must be readable, for another test to start from.
void check_kept_snapshots(const std::filesystem::path& dir);

}  // namespace grainlaw::calibrate
