// What is measured in a packing: volume fraction, stress, fabric, contacts, energies. Observers never change
// the grains.
#pragma once

#include <cstdint>
#include <vector>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

/// All sums run over every contact (overlap >= 0), those of rattlers included, except where said.
struct Measurement {
  double nu = 0;  ///< volume fraction; overlaps are not subtracted
  Sym6 stress{};  ///< (1/V) sum f (x) l, Eq. 2.5, compression positive, ug/(mm us^2); f with its viscous part
  Sym6 kinetic_stress{};  ///< (1/V) sum m v (x) v of the fluctuation velocity; not in `stress`
  Sym6 fabric{};          ///< (1/V) sum_p V_p sum_c n (x) n, Eq. 2.9
  double C = 0;           ///< M4/N: contacts of grains with at least four contacts, per grain
  double C_star = 0;      ///< M4/N4; NaN where no grain has four contacts
  double f_NR = 0;        ///< N4/N = 1 - phi_r
  double C_r = 0;         ///< M/N
  double kinetic = 0;     ///< energy of the fluctuation velocity, ug mm^2/us^2
  double elastic = 0;     ///< energy of the contacts, ug mm^2/us^2
  std::uint64_t contacts = 0;
};

struct Energies {
  double kinetic = 0;  ///< of the fluctuation velocity, ug mm^2/us^2
  double elastic = 0;  ///< of the contacts, ug mm^2/us^2
};

/// d(delta)/dt of a contact, that of the true motion: the box's is in it, mm/us.
double closing_speed(const Contact& contact, const Quads& velocity, const Cell& cell);

/// Measurement::stress alone, for a servo.
Sym6 static_stress(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                   const Pairs& pairs);
/// Measurement::kinetic and elastic alone, for a relaxation.
Energies energies(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                  const Pairs& pairs);

/// Everything at once. `velocity` is the fluctuation velocity at the time of the positions, mm/us, in the
/// order of the grains.
Measurement measure(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                    const Pairs& pairs);

}  // namespace grainlaw::dem
