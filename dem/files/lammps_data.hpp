// A packing in the data format of LAMMPS, for runs of other codes that start from one of ours.
#pragma once

#include <string>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// The text of a data file for `atom_style sphere`: one atom type; diameter, density, position (wrapped into
/// the box) and velocity of each grain, atom i + 1 being grain i. All numbers read back to the last bit. The
/// velocity is the fluctuation velocity; where the box is to deform, LAMMPS wants the affine motion added.
std::string lammps_data(const State& state, const Material& material);

}  // namespace grainlaw::dem
