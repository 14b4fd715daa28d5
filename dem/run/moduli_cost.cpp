#include "grainlaw/dem/run/moduli_cost.hpp"

#include <cmath>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/run/measured_cost.hpp"
#include "grainlaw/dem/stiffness/probed_packing.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr StrainTensor axis{-1, 1, 0};  // any: linear response solves for all six strains

}  // namespace

ModuliCost moduli_cost(const Material& material, const State& trial, std::size_t grains) {
  double spent = 0;
  const double held = peak_bytes([&] {
    const double begin = thread_seconds();
    try {
      ProbedPacking(material, trial, axis).row();
    } catch (const Error&) {  // a trial that cannot be brought into balance has cost its time all the same
    }
    spent = thread_seconds() - begin;
  });
  const double size = static_cast<double>(grains) / static_cast<double>(trial.count());
  return {spent * std::pow(size, minimiser_power), held * size};
}

}  // namespace grainlaw::dem
