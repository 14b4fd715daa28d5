// A packing made at once: a random gas squeezed affinely, its energy minimised.
#pragma once

#include <cmath>
#include <cstdint>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

inline StaticPacking random_packing(const Material& material, std::int64_t count, std::uint64_t seed,
                                    double nu, double residual) {
  NewPacking start;
  start.count = count;
  start.seed = seed;
  start.nu_gas = 0.4;
  StaticPacking packing(material, random_gas(material, start));
  packing.deform(std::cbrt(0.4 / nu) * packing.cell().edges());
  MinimiseOptions options;
  options.residual = residual;
  const MinimiseResult result = minimise(packing, options);
  if (result.outcome == Outcome::gave_up || result.outcome == Outcome::unjammed)
    throw Error("the packing is " + result.text());
  return packing;
}

}  // namespace grainlaw::dem
