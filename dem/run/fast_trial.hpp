// What fast compressions take: their grains move as they have since the beginning, which no packing at rest
// tells. They are run from there in fewer grains.
#pragma once

#include <optional>
#include <vector>

#include "grainlaw/dem/run/leg_trial.hpp"
#include "grainlaw/dem/run/scene_cost.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Whether a stage changes the density at more than 1e-5 of strain (its largest component) a step, in steps
/// that are known in advance. From there on a trial of grains that were at rest tells too little: 0.8 of what
/// it takes at 1e-5 in jammed grains, 0.85 at 2e-5 in a gas, 0.6 at 5e-5 in both.
bool compresses_fast(const Stage& stage);

/// Time that the background takes to bring moving grains to rest, us: seven times m/gamma_b, m the mass of a
/// grain of radius r_mean; infinite without it.
double time_to_rest(const Material& material);

/// Of each stage, whether its grains move as a fast compression has left them: such a compression, and what
/// comes after it until most of its time is at rest, or the energy has been minimised.
std::vector<bool> still_moving(const std::vector<StageCost>& stages, double time_to_rest);

/// How long such stages are run in all, unless one asks for more, in processor seconds.
constexpr double usual_fast_trial = 2;

/// Runs fast compressions, and the relaxations and fast shear between and after them, in the grains of `few`
/// without their copies, until `budget` processor seconds are over; stages between that are slow leave grains
/// at rest, at their density. `few` is the gas that a run begins with, or at rest. Told is what these grains
/// take if each takes as long as among as many as few.state() has, by equal steps of both: for known steps
/// within exp(0.25), mostly, for a relaxation that comes to its end early within exp(0.5). None of a stage
/// that was not run to its end, and none after a servo.
std::vector<std::optional<LegCost>> try_fast_stages(TrialPacking few, const Material& material,
                                                    const std::vector<StageCost>& stages, double budget);

}  // namespace grainlaw::dem
