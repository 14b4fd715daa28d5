// Acoustic tensor and speeds of plane waves that are long against the grains, in a solid under prestress.
#pragma once

#include <array>

#include "grainlaw/element/stiffness.hpp"
#include "grainlaw/element/symmetry_class.hpp"

namespace grainlaw {

/// Q = c(n) - (n . sigma n) I, with c(n)_ik = c_ijkl n_j n_l, |n| = 1: force per displacement u exp(i q n .
/// x) and q^2, in the unit of C. c, which does not know rotations, is
///
///   c_ijkl = C_ijkl + (d_ik s_jl + d_il s_jk + d_jk s_il + d_jl s_ik)/4,
///
/// C the second derivative of the ENERGY for symmetric strains l -> (1 + E) l, s = sigma the prestress,
/// compression positive: a wave also turns what it strains, and that costs what the prestress makes of it.
Sym6 acoustic_tensor(const Stiffness& energy, const Sym6& prestress, const Direction& n);

/// A plane wave: its speed is sqrt(value of Q/rho).
struct Wave {
  double speed;  ///< of its phase; mm/us for C in ug/(mm us^2) and rho in ug/mm^3; not a number where Q < 0
  Direction polarisation;  ///< of length one
};

/// Slowest first. `density` of the whole packing, rattlers and voids included: nu times that of the grains.
std::array<Wave, 3> waves(const Stiffness& energy, const Sym6& prestress, double density, const Direction& n);

}  // namespace grainlaw
