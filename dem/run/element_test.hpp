// Runs one element test: prepares or loads a packing, takes it along its path and writes the record.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/dem/run/watch.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::dem {

struct RunSummary {
  double wall_s = 0;
  std::uint64_t particle_steps = 0;
  std::vector<std::string> warnings;
  bool stopped = false;
  /// A sentence, where a stress target could not be reached: the record ends there. Empty where all is well.
  std::string cut_short;
};

/// Writes into `out_dir`, which must not exist, be empty, or hold a checkpoint of this very test: then the
/// test goes on from there. It writes scene.json at the start, snapshots.h5 as they are taken,
/// provenance.json and, last, record.csv. So a directory without record.csv is an incomplete one: the test
/// was stopped or failed. While it runs, and when it is told to stop, it leaves checkpoints there. The record
/// has one row for the start of the path, and then measure.rows per segment. Bad input throws Error before
/// anything is written. The run does not depend on hooks, interruptions, checkpoints, rows (as long as a
/// segment takes more than two steps per row anyway) or snapshots: on one instruction set, the same scene
/// gives the same record to the last bit.
RunSummary run_element_test(const Scene& scene, const std::filesystem::path& out_dir,
                            const RunHooks& hooks = {});

/// Whether `dir` holds a record whose test came to its end: record.csv is written last, and then checkpoints
/// go.
bool has_whole_record(const std::filesystem::path& dir);

}  // namespace grainlaw::dem
