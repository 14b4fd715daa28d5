// The motion kernel: what one step does to every grain between two computations of forces.
#pragma once

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"

namespace grainlaw::dem {

/// dv/dt of a grain, mm/us^2 | 1/mass, of the fluctuation velocity (see Dynamics): from its contact force and
/// the velocity that force was computed with. `last` is an earlier one of the same grain, for its mass.
inline Quad acceleration(const Quad& force, const Quad& motion, const Quad& last, double gamma_b,
                         const Mat3& gradient) {
  Mat3 damping = gradient;
  for (std::size_t c = 0; c < 3; ++c) damping(c, c) += gamma_b * last.w;
  const Vec3 damped = damping * Vec3{motion.x, motion.y, motion.z};
  return {force.x * last.w - damped[0], force.y * last.w - damped[1], force.z * last.w - damped[2], last.w};
}

struct Stride {
  double dt;         ///< us
  Mat3 deformation;  ///< F of the box during the step
  Mat3 gradient;     ///< G of the box at its beginning, 1/us
  double gamma_b;    ///< ug/us
  bool tilted;       ///< false: nothing beside the diagonals, here and in the reach of the list
};

/// How far grains may stray before the list of pairs could miss one; see Neighbours.
struct ListReach {
  const Quad* reference;  ///< X | s^2 for each grain
  Mat3 deformation;       ///< E, of the box since the list was made, at the end of the step
};

/// From the forces at time n, which it uses up and leaves at zero: takes the velocity from n - 1/2 to n +
/// 1/2, moves the grains with it and with the box, and predicts the velocity at n + 1. Returns the largest |x
/// - E X|^2 - s^2 of a grain, mm^2; not a number if the place of any grain is not finite.
double advance(const Stride& stride, const ListReach& list, Grains& grains);
/// The same for grains first ... last - 1 alone.
double advance(const Stride& stride, const ListReach& list, std::size_t first, std::size_t last,
               Grains& grains);

}  // namespace grainlaw::dem
