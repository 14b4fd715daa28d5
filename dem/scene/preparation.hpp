// Preparation of a packing as in the thesis (section 2.2.2): a random gas, compressed and relaxed.
#pragma once

#include <vector>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

/// Grains of these radii, which have no places yet, and a cube in which their volume fraction is `nu`.
State without_places(std::vector<double> radii, double nu);

/// The gas: grains at random places in a cube at packing.nu_gas, pushed apart until none overlap, with random
/// velocities of root mean square packing.speed and no total momentum. The same seed gives the same gas to
/// the last bit.
State random_gas(const Material& material, const NewPacking& packing);

/// Moves grains apart, starting from any places, until no two overlap: a step takes four fifths off the
/// overlap of a pair by itself, of grains 2 % larger than they are. Velocities stay. Throws Error if it
/// cannot be done within some thousand steps.
void push_apart(State& state);

/// The two legs that follow the gas: isotropic compression to packing.nu along a half cosine, and relaxation.
Leg compression_leg(const NewPacking& packing);
Leg relaxation_leg(const Relaxation& relaxation);

}  // namespace grainlaw::dem
