// The jamming density that an isotropic over-compression leaves behind (thesis Eqs. 5.1, 5.5), as pure
// functions. Volume fractions in, volume fractions out.
#pragma once

#include <cmath>

namespace grainlaw::model {

/// Numbers of Eqs. 5.1 and 5.5.
struct OverCompression {
  double phi_SJ = 0.5;     ///< shear-jamming density, the lowest phi_J
  double mu = 1;           ///< number of cycles the memory takes to fill
  double beta = 1;         ///< stretching of that exponential
  double alpha_max = 0;    ///< strength of over-compression
  double alpha_phi = 0.3;  ///< its exponent
};

/// Eq. 5.5: phi_J after infinitely many compressions to phi_max,
/// phi_SJ + alpha_max (phi_max/phi_SJ - 1)^alpha_phi; phi_SJ where phi_max <= phi_SJ.
inline double jamming_density_limit(const OverCompression& o, double phi_max) {
  if (phi_max <= o.phi_SJ) return o.phi_SJ;
  return o.phi_SJ + o.alpha_max * std::pow(phi_max / o.phi_SJ - 1, o.alpha_phi);
}

/// Eq. 5.1: phi_J after M compressions to phi_max,
/// phi_inf - (phi_inf - phi_SJ) exp[-(M/mu)^beta]. M = 0 is phi_SJ, M = 1 the first compression.
inline double jamming_density_after(const OverCompression& o, double phi_max, double M) {
  const double limit = jamming_density_limit(o, phi_max);
  return o.phi_SJ - (limit - o.phi_SJ) * std::expm1(-std::pow(M / o.mu, o.beta));
}

}  // namespace grainlaw::model
