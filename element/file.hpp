// Writing files so that a reader never sees half of one.
#pragma once

#include <filesystem>
#include <string>

namespace grainlaw {

/// Writes `text` to a temporary file beside `file`, flushes it to disk and renames it. Where `file` is a
/// symbolic link, what it points to is replaced; a device or a pipe is written to. Throws Error ("disk full"
/// in words).
void write_file(const std::filesystem::path& file, const std::string& text);
/// Removes from `dir` what write_file left there when it was killed: files NAME.partNUMBER.
void remove_half_written(const std::filesystem::path& dir);
std::string read_file(const std::filesystem::path& file);
/// 64 bits as hexadecimal digits, to see whether a text is still the same; no protection against forgery.
std::string digest(const std::string& text);

}  // namespace grainlaw
