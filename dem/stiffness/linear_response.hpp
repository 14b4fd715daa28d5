// The stiffness of a packing in balance, from its contact network alone: no strain is applied.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/stiffness.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

using grainlaw::Stiffness;

/// The answer of a packing in balance to a small strain, with grains free to move beyond it.
///
/// The energy of second order in a strain E_a and displacements u of the grains is that of the branches l
/// with the blocks K of ContactHessian,
///
///   C_ab = (1/V) sum_c w_a . K w_b,   w_a = E_a l + u_a,i - u_a,j,
///
/// where u_a makes it smallest: H u_a = -g_a, the forces that the affine strain leaves on the grains. Six
/// systems, one for each component, are solved in step by conjugate gradients (SixSystems); C errs by the
/// square of what is left of them. Contacts of rattlers (grains outside the backbone) carry nothing in
/// balance and are left out.
struct LinearResponse {
  Stiffness energy{};  ///< second derivative of the energy per volume for l -> (1 + E) l, ug/(mm us^2)
  Stiffness stress{};  ///< derivative of the stress: energy - (sigma e)_sym + sigma tr e; not symmetric
  Stiffness affine{};  ///< `energy` with no displacement beyond the strain: its upper bound
  Sym6 prestress{};    ///< sigma of the backbone, compression positive, ug/(mm us^2)
  std::size_t backbone = 0, contacts = 0;  ///< grains that bear load, contacts between them
  std::uint64_t iterations = 0;            ///< of the six systems in step
  std::uint64_t products = 0;              ///< of the Hessian with a displacement, over the six
  /// Systems, out of six, in which a displacement was met that no stiffness resists while the box is
  /// held: the network is not in a stable balance, and C no limit of small strains.
  int unstable = 0;
};

struct LinearResponseOptions {
  double residual = 1e-6;  ///< what is left of the forces g_a, over them, in the norm of the preconditioner
  std::uint64_t most_iterations = 30'000;
};

/// Finds the contacts of `packing` first. Throws Error where it has no backbone, where its
/// contacts are too few to hold it (Backbone::isostatic), or where most_iterations do not suffice.
LinearResponse linear_response(StaticPacking& packing, const LinearResponseOptions& options = {});

/// energy - (sigma e)_sym + sigma tr e for each strain e of one component: what the prestress sigma makes of
/// the second derivative of the energy (l -> (1 + E) l), compression positive.
Stiffness derivative_of_stress(const Stiffness& energy, const Sym6& sigma);

/// The four moduli of Eqs. 4.9 and 4.10 along an axis of shear (sigma_dev: what of the stress lies along it,
/// see deviator_along), in the unit of C: from strain (3 d(eps_v), d(eps_dev)) to stress (dP, d(sigma_dev)).
struct Moduli {
  double B = 0;      ///< dP/(3 d(eps_v)): bulk modulus
  double A1 = 0;     ///< dP/d(eps_dev)
  double A2 = 0;     ///< d(sigma_dev)/(3 d(eps_v))
  double G_oct = 0;  ///< d(sigma_dev)/d(eps_dev): twice the shear modulus of an isotropic solid
};

/// `axis`: that of the deviatoric scalars, D2's (-1, 1, 0) or D3's (-1/2, -1/2, 1) or any deviator.
Moduli moduli_of(const Stiffness& stiffness, const StrainTensor& axis);

}  // namespace grainlaw::dem
