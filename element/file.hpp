// Writing files so that a reader never sees half of one.
#pragma once

#include <filesystem>
#include <string>

namespace grainlaw {

/// Writes `text` to a temporary file beside `file`, flushes it to disk and renames it. Throws Error ("disk
/// full" in words).
void write_file(const std::filesystem::path& file, const std::string& text);
std::string read_file(const std::filesystem::path& file);

}  // namespace grainlaw
