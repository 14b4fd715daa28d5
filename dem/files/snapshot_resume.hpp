// Going on with the snapshot file of a run that was interrupted.
#pragma once

#include <cstddef>
#include <filesystem>

#include "grainlaw/dem/files/snapshot.hpp"

namespace grainlaw::dem {

/// A writer for a file that a run left behind, of which only the first `frames` frames count (at least one):
/// all later ones are dropped. May itself be interrupted and repeated. Throws Error if the file holds fewer.
SnapshotWriter resume_snapshots(const std::filesystem::path& file, std::size_t frames);

/// Removes such a file, where none of its frames counts.
void drop_snapshots(const std::filesystem::path& file);

/// Returns when all of the file is on the disk, not only with the operating system; throws Error where that
/// fails.
void bring_to_disk(const std::filesystem::path& file);

}  // namespace grainlaw::dem
