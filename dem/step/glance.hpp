// What servo and steering read every few steps: a measurement reduced to the few sums they need.
#pragma once

#include <cstdint>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"

namespace grainlaw::dem {

/// Which components of the stress are looked at: shear takes 2 % of the time of a flow, so it is left
/// out where nobody asks for it.
enum class Stresses { normal, all };

struct Glance {
  Sym6 stress{};       ///< static, with the forces of the last step, ug/(mm us^2); shear only if asked for
  double bulk = 0;     ///< bulk modulus if the grains moved affinely, (1/9V) sum k l^2, ug/(mm us^2)
  double kinetic = 0;  ///< energies as in Measurement, ug mm^2/us^2
  double elastic = 0;
  std::uint64_t contacts = 0;
};

Glance glance(const ContactLaw& law, const Grains& grains, const Cell& cell, const Pairs& pairs,
              Stresses which);

}  // namespace grainlaw::dem
