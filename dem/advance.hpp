// The motion kernel: what one step does to every grain between two computations of forces.
#pragma once

#include "grainlaw/dem/cell.hpp"
#include "grainlaw/dem/grains.hpp"

namespace grainlaw::dem {

/// dv/dt of a grain, mm/us^2 | 1/mass, of the fluctuation velocity (see Dynamics): from its contact force and
/// the velocity that force was computed with. `last` is an earlier one of the same grain, for its mass.
inline Quad acceleration(const Quad& force, const Quad& motion, const Quad& last, double gamma_b,
                         const Vec3& rate) {
  const double drag = gamma_b * last.w;
  return {force.x * last.w - (drag + rate[0]) * motion.x, force.y * last.w - (drag + rate[1]) * motion.y,
          force.z * last.w - (drag + rate[2]) * motion.z, last.w};
}

struct Stride {
  double dt;       ///< us
  Vec3 stretch;    ///< edges of the box at the end of the step over those at its beginning
  Vec3 rate;       ///< of the box at its beginning, 1/us
  double gamma_b;  ///< ug/us
};

/// How far grains may stray before the list of pairs could miss one; see Neighbours.
struct ListReach {
  const Quad* reference;  ///< X | s^2 for each grain
  Vec3 stretch;           ///< E, of the box at the end of the step
};

/// From the forces at time n: takes the velocity from n - 1/2 to n + 1/2, moves the grains with it and with
/// the box, and predicts the velocity at n + 1. Returns the largest |x - E X|^2 - s^2 of a grain, mm^2;
/// not a number if the place of any grain is not finite.
double advance(const Stride& stride, const ListReach& list, Grains& grains);

}  // namespace grainlaw::dem
