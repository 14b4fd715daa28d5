#include "grainlaw/dem/files/snapshot_resume.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace fs = std::filesystem;

namespace {

/// What the run left, while its frames are copied.
fs::path left_aside(const fs::path& file) { return file.string() + ".left"; }

}  // namespace

void drop_snapshots(const fs::path& file) {
  fs::remove(file);
  fs::remove(left_aside(file));
}

/// Copied frame by frame: a file whose writer died cannot be opened for writing again, only read.
SnapshotWriter resume_snapshots(const fs::path& file, std::size_t frames) {
  const fs::path left = left_aside(file);
  if (!fs::exists(left)) {
    const std::size_t there = list_frames(file).size();
    if (there < frames)
      throw Error(file.string(), "",
                  "must hold the " + std::to_string(frames) + " frames taken before the checkpoint, holds " +
                      std::to_string(there));
    fs::rename(file, left);
  }
  fs::remove(file);
  const auto frame_at = [&left](std::size_t k) {
    return read_whole_frame(left, {.nu = {}, .frame = k, .segment = {}});
  };
  SnapshotWriter writer(file, frame_at(0).state.radius);
  for (std::size_t k = 0; k < frames; ++k) {
    const Frame frame = frame_at(k);
    writer.append(frame.state, frame.observables);
  }
  bring_to_disk(file);
  fs::remove(left);
  return writer;
}

void bring_to_disk(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool well = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS);
  const int failure = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!well) throw Error::cannot_write(file.string(), std::strerror(failure));
}

}  // namespace grainlaw::dem
