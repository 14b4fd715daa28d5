// The checkpoints of a test under way: files in its directory from which it goes on as if it had never
// stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::dem {

/// The newest one and the one before, which stays in case the newest is spoilt.
inline constexpr auto checkpoint_file = "checkpoint.bin", earlier_checkpoint_file = "checkpoint.old.bin";

/// Whether `dir` holds a checkpoint, be it whole or not.
bool has_checkpoint(const std::filesystem::path& dir);

/// Writes a checkpoint of a test of `scene`: aside, to the disk, and only then under its name. `keep` writes
/// the test itself. Throws Error where the disk cannot be written; earlier checkpoints are then as they were.
void write_checkpoint(const std::filesystem::path& dir, const Scene& scene,
                      const std::function<void(ArchiveWriter&)>& keep);

/// The newest whole checkpoint in `dir`, at the place where `keep` began. Throws Error, saying what would be
/// right, if none is whole, or if it is of another scene, another grainlaw (version, commit or compiler) or
/// another instruction set: then the test could not go on with the same numbers.
ArchiveReader read_checkpoint(const std::filesystem::path& dir, const Scene& scene);

/// Throws Error as read_checkpoint does.
void check_checkpoint(const std::filesystem::path& dir, const Scene& scene);

/// Removes the checkpoints of a test that is complete.
void remove_checkpoints(const std::filesystem::path& dir);

}  // namespace grainlaw::dem
