#include "grainlaw/dem/run/moduli_cost.hpp"

#include <cmath>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/run/cost.hpp"
#include "grainlaw/dem/stiffness/probed_packing.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr StrainTensor axis{-1, 1, 0};  // any: linear response solves for all six strains
constexpr double power = 1.4;
constexpr double strain = 1e-3;

/// As far from balance as the states of a slow flow are: trial packings are made much faster.
State strained(StaticPacking packing) {
  packing.deform(Mat3::diagonal({std::exp(strain), std::exp(-strain), 1}) * packing.cell().edges());
  return packing.state();
}

}  // namespace

double moduli_seconds(const Material& material, const State& trial, std::size_t grains) {
  double begin = thread_seconds();
  try {
    const State flowing = strained(ProbedPacking(material, trial, axis).packing());
    begin = thread_seconds();
    ProbedPacking(material, flowing, axis).row();
  } catch (const Error&) {  // a trial that cannot be brought into balance has cost its time all the same
  }
  const double size = static_cast<double>(grains) / static_cast<double>(trial.count());
  return (thread_seconds() - begin) * std::pow(size, power);
}

}  // namespace grainlaw::dem
