// Snapshots of a packing on disk, in HDF5 in the H5MD 1.1 layout (docs/formats.md): written frame by frame,
// read one frame at a time. Safe to call from several threads: Debian's HDF5 is serial, so one mutex guards
// every call into it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/dem/packing/state.hpp"

namespace grainlaw::dem {

/// What is stored beside a state, under the names of record.csv.
struct Observables {
  double nu = 0;              ///< volume fraction
  double eps_vol = 0;         ///< ln(nu/nu_start), compression positive
  double eps_dev = 0;         ///< signed sqrt(3 J2) of the strain since the start of the path
  std::uint64_t segment = 0;  ///< index of the leg, repeats written out

  bool operator==(const Observables&) const = default;
};

/// Which frame to read: the one at `frame`, or the one nearest to `nu` (in `segment`, if given), or the last
/// (of `segment`). At most one of `nu` and `frame` is set; `segment` never goes with `frame`.
struct FrameChoice {
  std::optional<double> nu;
  std::optional<std::uint64_t> frame;
  std::optional<std::uint64_t> segment;

  bool operator==(const FrameChoice&) const = default;
};

/// Appends frames to one new file. No handle stays open between frames: after each append the file is
/// complete and closed, and whatever happens to the run afterwards, every frame appended so far can be read.
/// A run that dies inside append loses that frame only.
class SnapshotWriter {
 public:
  /// Creates `file` for grains of these radii (mm), which no frame changes. Throws Error if it exists or
  /// cannot be written.
  SnapshotWriter(std::filesystem::path file, std::vector<double> radius);

  /// Throws Error if the radii differ from those of the file, if a number is not finite, or if the disk is
  /// full.
  void append(const State& state, const Observables& observables);

  std::size_t frames() const { return frames_; }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::vector<double> radius_;
  std::size_t frames_ = 0;
};

/// A whole frame: the state, and where on its path it was taken.
struct Frame {
  State state;
  Observables observables;
  std::size_t index = 0;
};

/// The observables of all frames, in order.
/// Throws Error (naming the file) if it is missing, cut short, corrupt, of another layout, or has no frame.
std::vector<Observables> list_frames(const std::filesystem::path& file);

/// The index `choice` stands for. Throws Error if no frame lies within 1e-3 of the wanted nu, or if two fit
/// equally well (to 1e-4), which happens where a path passes the same nu twice: `segment` or `frame` then
/// says which is meant.
std::size_t find_frame(const std::vector<Observables>& frames, const FrameChoice& choice,
                       const std::filesystem::path& file);

/// Reads one frame and checks it: finite numbers, radii and box edges > 0, nu as stored. Throws Error as
/// list_frames does.
Frame read_whole_frame(const std::filesystem::path& file, const FrameChoice& choice);
State read_frame(const std::filesystem::path& file, const FrameChoice& choice);

}  // namespace grainlaw::dem
