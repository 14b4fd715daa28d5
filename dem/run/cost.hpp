// What a scene will take: its planned steps, its memory, and the time of a step, of a row and of each
// observer, measured in a short trial on this machine.
#pragma once

#include <optional>

#include "grainlaw/dem/run/scene_cost.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::dem {

/// What a run is told beside its scene (see RunHooks).
struct CostOptions {
  int threads = 1;
  double checkpoint_every = 60;  ///< s
  /// Processor seconds for which each stage may be tried whose work is known only when the grains have run,
  /// and which each stage on the way to it may take; if not said, usual_trial() and 3, and 6 in all. Also for
  /// which fast compressions may be run in fewer grains; if not said, usual_fast_trial.
  std::optional<double> trial_seconds = {};
};

/// Throws Error as run_element_test does for bad input.
SceneCost cost_of(const Scene& scene, const CostOptions& options = {});

}  // namespace grainlaw::dem
