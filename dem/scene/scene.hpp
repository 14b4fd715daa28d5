// A scene: everything that defines one element test by DEM (SCENE.json in docs/formats.md).
// Reading checks every range, so that a Scene that exists can be run; writing fills in every default.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

/// When a relaxation ends: E_k/E_p below `tolerance` (without any contact: E_k down by this factor), or after
/// `duration`.
struct Relaxation {
  double tolerance = 1e-6;
  double duration = 2000;  ///< us
};

/// Preparation of the thesis (section 2.2.2): random gas, isotropic compression, relaxation.
struct NewPacking {
  std::int64_t count = 1000;
  std::uint64_t seed = 1;
  double nu_gas = 0.3;   ///< volume fraction of the gas
  double speed = 0.02;   ///< root mean square speed of the gas, mm/us
  double nu = 0.64;      ///< volume fraction after compression
  double rate = 2.0e-4;  ///< mean strain rate of the compression, 1/us
  Relaxation relax;

  /// A campaign gives seeds of its own and refuses one here.
  enum class SeedKey { optional, refused };
  static NewPacking read(Reader reader, SeedKey seed_key = SeedKey::optional);
  Json to_json() const;
};

/// A state that an earlier test left on disk.
struct FromSnapshot {
  std::filesystem::path snapshot;  ///< as written in the scene
  std::filesystem::path file;      ///< where it is: `snapshot` from the directory of the scene
  FrameChoice choice;

  static FromSnapshot read(Reader reader, const std::filesystem::path& scene_dir);
  /// For a scene file in `dir`: a relative path is rewritten so that it leads from there to the same file. An
  /// empty `dir` keeps it as written.
  Json to_json(const std::filesystem::path& dir = {}) const;
};

/// A state to keep, or to measure the moduli of: where nu or eps_dev first reaches the value in this segment,
/// or else at the segment's end.
struct StateRequest {
  std::size_t segment = 0;
  std::optional<double> nu, eps_dev;  ///< at most one is set

  bool operator==(const StateRequest&) const = default;
};

/// What to write down, how often, and how finely to step.
struct Measure {
  std::int64_t rows = 100;  ///< per segment, evenly spaced in its strain
  std::vector<StateRequest> snapshots;
  std::vector<StateRequest> moduli;  ///< states whose small-strain moduli are wanted, no two the same
  double time_step = 0.2;            ///< over the smallest contact duration
  double time_step_gas = 0.05;       ///< the same, during preparation
  std::vector<std::string> standard = column_groups();  ///< some of these groups of columns, in their order
  std::vector<std::string> observe;  ///< beside these columns; of observe::names(), in their order

  /// What is missing comes from `fallback` (in a campaign, the measure of all tests).
  static Measure read(Reader reader, const Measure& fallback);
  static Measure read(Reader reader) { return read(std::move(reader), Measure{}); }
  Json to_json() const;
};

struct Scene {
  Material material;
  std::variant<NewPacking, FromSnapshot> preparation;
  Path path;
  Measure measure;
  std::string file;  ///< where it was read from, for error messages; may be empty

  /// `scene_dir` is the directory that a relative `preparation.snapshot` starts from. Does not look at the
  /// disk.
  static Scene read(Reader reader, const std::filesystem::path& scene_dir);
  /// Reads a scene file; also throws Error if the snapshot that it starts from does not exist.
  static Scene load(const std::filesystem::path& file);
  /// The scene with every default filled in, to be written into `dir` (see FromSnapshot::to_json).
  Json to_json(const std::filesystem::path& dir = {}) const;

  /// Rows of its record: one for the start, and those of each segment.
  std::size_t record_rows() const;
  /// The volume fraction the path starts from, where the scene says it: a new packing's nu, or the nu that
  /// chooses a frame.
  std::optional<double> start_nu() const;
  /// Throws Error if grains read from a snapshot are not of this material's sizes (mean or spread off by more
  /// than 1 % of r_mean): the unit of stress k/(2<r>) would be wrong.
  void check_grains(const State& state) const;
  /// The nominal legs of the path for a start at `nu`. Throws Error where a target of the path cannot be
  /// reached from there or a wanted snapshot lies outside its segment, up to the first segment under stress
  /// control. Scene::read has done so already for a new packing;
  /// for a snapshot, the volume fraction is known only when the frame has been read.
  std::vector<Leg> legs(double nu) const;
};

}  // namespace grainlaw::dem
