// The jamming density phi_J that an isotropic over-compression leaves behind (thesis Eqs. 5.1, 5.5), and the
// one that a measured pressure implies (inversion of Eq. 5.9). Pure functions.
#pragma once

#include <cmath>
#include <optional>

#include "grainlaw/model/packing_laws.hpp"

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

/// The phi_J for which the pressure law gives P* at nu: Eq. 2.14 with phi_J in every place of nu_c, inverted.
/// nu itself for P* = 0; nothing where even ln(nu/phi_J) = 1 gives less.
inline std::optional<double> jamming_density_from_pressure(const PressureCurve& law, double nu, double P) {
  if (P <= 0) return nu;
  const auto missing = [&](double e) {
    return P - pressure(with_jamming_density(law, nu * std::exp(-e)), nu);
  };
  double low = 0, high = 1;
  if (missing(high) > 0) return std::nullopt;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (missing(middle) > 0 ? low : high) = middle;
  }
  return nu * std::exp(-0.5 * (low + high));
}

}  // namespace grainlaw::model
