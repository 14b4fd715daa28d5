// What it takes to measure the moduli of one state, from a trial on a smaller packing.
#pragma once

#include <cstddef>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// With which power of the number of grains the work of a minimisation grows, from 1000 to 100000 of them
/// (docs/stiffness.md): larger packings need more iterations, and leave the cache.
constexpr double minimiser_power = 1.4;

struct ModuliCost {
  double seconds = 0;
  double bytes = 0;  ///< held meanwhile beside the grains
};

/// One state of `grains` grains: what a trial state takes to be brought into balance and solved for its
/// linear response, in processor seconds times (grains over its own)^minimiser_power, in bytes times their
/// ratio.
ModuliCost moduli_cost(const Material& material, const State& trial, std::size_t grains);

}  // namespace grainlaw::dem
