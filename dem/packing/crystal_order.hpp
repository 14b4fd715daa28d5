// Whether grains of nearly equal size have crystallised.
#pragma once

#include <string>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Share of the grains that stand in crystalline order (ten Wolde, Ruiz-Montero and Frenkel 1996). Neighbours
/// are grains closer than r_i + r_j + 0.3 mean diameters; q_6 of a grain is the sixth harmonic of the
/// directions to them. Two neighbours are bonded where q_6(i) . q_6(j)* > 0.7 |q_6(i)| |q_6(j)|, and a grain
/// with seven bonds or more is in order. Next to 0 in a random packing, 1 in any crystal that is close
/// packed.
double crystalline_share(const State& state);

/// Whether a material is below the size ratios that the thesis's fits hold for (w > 1.2, Table 3.2).
bool may_crystallise(const Material& material);
/// The sentence that warns of it, with the share at the end of a test.
std::string crystal_warning(const Material& material, const State& state);

}  // namespace grainlaw::dem
