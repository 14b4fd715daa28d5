// How isotropic, transversely isotropic or orthotropic a stiffness is: projections onto these classes, in the
// norm of the elastic tensor.
#pragma once

#include <array>

#include "grainlaw/element/stiffness.hpp"

namespace grainlaw {

using Direction = std::array<double, 3>;  ///< of any length but 0

/// The nearest stiffness of each class: the orthogonal projection, which is the mean over all rotations of
/// the class. Only the symmetric part of C counts.
Stiffness isotropic_part(const Stiffness& c);
Stiffness transversely_isotropic_part(const Stiffness& c, const Direction& axis);
/// With planes of symmetry across the axes of this frame.
Stiffness orthotropic_part(const Stiffness& c, const Rotation& frame);

/// |part|^2/|C|^2, in [0, 1]: 1 where C is of the class. The part and what is left of C are orthogonal, so
/// that |C - part|/|C| = sqrt(1 - share).
double share(const Stiffness& part, const Stiffness& c);

struct SymmetryClass {
  double isotropic = 0;                            ///< share
  std::array<double, 3> transversely_isotropic{};  ///< shares, about x, y and z
  double best_transversely_isotropic = 0;          ///< the largest share that an axis has ...
  Direction best_axis{0, 0, 1};                    ///< ... and which, of length 1, its largest component >= 0
  double orthotropic = 0;                          ///< share, across x, y and z
  double best_orthotropic = 0;                     ///< the largest share that a frame has
  Rotation best_frame{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

/// The best axis and frame are local maxima of the shares, found from several starts, to about 1e-6 in their
/// angles.
SymmetryClass symmetry_class(const Stiffness& c);

}  // namespace grainlaw
