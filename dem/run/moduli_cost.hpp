// What it takes to measure the moduli of one state, from a trial on a smaller packing.
#pragma once

#include <cstddef>

#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

struct ModuliCost {
  double seconds = 0;
  double bytes = 0;  ///< held meanwhile beside the grains
};

/// One state of `grains` grains: what a trial state takes to be brought into balance and solved for its
/// linear response, in processor seconds times (grains over its own)^1.4, in bytes times their ratio. The
/// power is that of packings of 1000 to 100000 grains (docs/stiffness.md): larger ones need more iterations,
/// and leave the cache.
ModuliCost moduli_cost(const Material& material, const State& trial, std::size_t grains);

}  // namespace grainlaw::dem
