// What fast compressions take: their grains fly as they have since the beginning, which no packing at rest
// tells. They are run from there in fewer grains.
#pragma once

#include <optional>
#include <vector>

#include "grainlaw/dem/run/leg_trial.hpp"
#include "grainlaw/dem/run/scene_cost.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Whether a stage changes the density by more than 1e-5 of strain a step, of known steps. From there on a
/// trial of what was at rest tells too little: 0.85 of what a step takes at 2e-5, 0.6 at 5e-5.
bool compresses_fast(const Stage& stage);

/// Runs the fast compressions among `stages`, and the relaxations and fast shear between and after them, in
/// the grains of `few` before they are laid out beside themselves; stages between that are slow leave grains
/// at rest at their density. `few` is at rest, or the gas that a run begins with. What one grain takes in so
/// few is made what it takes in as many as few.state() has, by the time of equal steps of both. The range is
/// what we saw it to be off. None of a stage that was not run, or not to its end; after a servo, none.
std::vector<std::optional<LegCost>> try_fast_stages(TrialPacking few, const Material& material,
                                                    const std::vector<StageCost>& stages);

}  // namespace grainlaw::dem
