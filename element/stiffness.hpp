// Elastic constants as six by six numbers, and what is the same in every notation and frame.
#pragma once

#include <array>

#include "grainlaw/element/tensor.hpp"

namespace grainlaw {

/// C[a][b] = C_ijkl with ij the component a and kl the component b of xx, yy, zz, yz, xz, xy: stress from
/// strains whose shears are counted twice.
using Stiffness = std::array<Sym6, 6>;

/// A rotation; its rows are the axes of the new frame in the old one.
using Rotation = std::array<std::array<double, 3>, 3>;

/// The component of a tensor with indices i, j in {0, 1, 2}.
constexpr std::size_t component(std::size_t i, std::size_t j) { return i == j ? i : 6 - i - j; }

/// With shears times sqrt(2) (Mandel, or Kelvin): a matrix that turns like a tensor, so that its eigenvalues
/// and its norm belong to no frame.
Stiffness mandel(const Stiffness& c);

/// The same solid seen from another frame.
Stiffness rotated(const Stiffness& c, const Rotation& rotation);

/// |C|: root of the sum of squares of C_ijkl, in the unit of C.
double norm(const Stiffness& c);

/// The six stiffnesses of a symmetric C, rising, in its unit: what resists each of six orthogonal strains of
/// size one. Those of an isotropic solid are 3 K once and 2 mu five times. Only the symmetric part of C
/// counts.
Sym6 eigenvalues(const Stiffness& c);

/// Its inverse S, so that S C = 1: strains, with shears counted twice, from stresses. Throws Error where C is
/// singular to rounding.
Stiffness inverse(const Stiffness& c);

}  // namespace grainlaw
