// What is measured in a packing: volume fraction, stress, fabric, contacts, energies. Observers never change
// the grains.
#pragma once

#include <limits>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

/// What is to be measured beside the volume fraction. The rest takes no time.
struct Wanted {
  bool stress = false, kinetic_stress = false, fabric = false;
  bool coordination = false;  ///< contacts, C, C*, f_NR
  bool energies = false;      ///< kinetic and elastic

  static constexpr Wanted everything() { return {true, true, true, true, true}; }
  /// Whether the contacts are to be walked through.
  constexpr bool of_contacts() const { return stress || fabric || coordination || energies; }
  /// Whether the velocities of the full step are needed.
  constexpr bool of_velocity() const { return stress || kinetic_stress || energies; }
  constexpr Wanted operator|(const Wanted& other) const {
    return {stress || other.stress, kinetic_stress || other.kinetic_stress, fabric || other.fabric,
            coordination || other.coordination, energies || other.energies};
  }
  bool operator==(const Wanted&) const = default;
};

/// All sums run over every contact (overlap >= 0), those of rattlers included, except where said. What is not
/// Wanted is NaN.
struct Measurement {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  static constexpr Sym6 unknown_tensor{unknown, unknown, unknown, unknown, unknown, unknown};

  double nu = unknown;           ///< volume fraction; overlaps are not subtracted
  Sym6 stress = unknown_tensor;  ///< (1/V) sum f (x) l, Eq. 2.5, compression positive, ug/(mm us^2); f with
                                 ///< its viscous part
  Sym6 kinetic_stress = unknown_tensor;  ///< (1/V) sum m v (x) v of the fluctuation velocity; not in `stress`
  Sym6 fabric = unknown_tensor;          ///< (1/V) sum_p V_p sum_c n (x) n, Eq. 2.9
  double contacts = unknown;             ///< each once
  double C = unknown;                    ///< M4/N: contacts of grains with at least four contacts, per grain
  double C_star = unknown;               ///< M4/N4; NaN where no grain has four contacts
  double f_NR = unknown;                 ///< N4/N = 1 - phi_r
  double kinetic = unknown;              ///< energy of the fluctuation velocity, ug mm^2/us^2
  double elastic = unknown;              ///< energy of the contacts, ug mm^2/us^2
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

/// Measurement::kinetic alone: a pass over the grains.
double kinetic_energy(const Grains& grains, const Quads& velocity);

/// What is wanted at once, each to the same bit whatever else is. `velocity` is the fluctuation velocity at
/// the time of the positions, mm/us, in the order of the grains; it may be empty unless wanted.of_velocity().
Measurement measure(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                    const Pairs& pairs, const Wanted& wanted = Wanted::everything());

}  // namespace grainlaw::dem
