// The jamming density phi_J that an isotropic over-compression leaves behind (thesis Eqs. 5.1, 5.5), and the
// one that a measured pressure implies (inversion of Eq. 5.9). Pure functions.
#pragma once

#include <cmath>
#include <optional>
#include <type_traits>

#include "grainlaw/model/laws/packing_laws.hpp"

namespace grainlaw::model {

/// Numbers of Eqs. 5.1 and 5.5.
template <class P>
struct BasicOverCompression {
  P phi_SJ = 0.5;     ///< shear-jamming density, the lowest phi_J
  P mu = 1;           ///< number of cycles the memory takes to fill
  P beta = 1;         ///< stretching of that exponential
  P alpha_max = 0;    ///< strength of over-compression
  P alpha_phi = 0.3;  ///< its exponent
};
using OverCompression = BasicOverCompression<double>;

/// Eq. 5.5: phi_J after infinitely many compressions to phi_max,
/// phi_SJ + alpha_max (phi_max/phi_SJ - 1)^alpha_phi; phi_SJ where phi_max <= phi_SJ.
template <class P, class T>
Meet<P, T> jamming_density_limit(const BasicOverCompression<P>& o, const T& phi_max) {
  using std::pow;
  if (phi_max <= o.phi_SJ) return o.phi_SJ;
  return o.phi_SJ + o.alpha_max * pow(phi_max / o.phi_SJ - 1, o.alpha_phi);
}

/// Eq. 5.1: phi_J after M compressions to phi_max,
/// phi_inf - (phi_inf - phi_SJ) exp[-(M/mu)^beta]. M = 0 is phi_SJ, M = 1 the first compression.
template <class P, class T, class N>
Meet<P, T> jamming_density_after(const BasicOverCompression<P>& o, const T& phi_max, const N& M) {
  using std::expm1, std::pow;
  const auto limit = jamming_density_limit(o, phi_max);
  return o.phi_SJ - (limit - o.phi_SJ) * expm1(-pow(M / o.mu, o.beta));
}

/// What one compression leaves of the way from phi_SJ to the limit (M = 1 in Eq. 5.1).
template <class P>
P share_of_first(const BasicOverCompression<P>& o) {
  using std::expm1, std::pow;
  return -expm1(-pow(1 / o.mu, o.beta));
}

/// The largest volume fraction whose first compression leaves phi (M = 1 in Eq. 5.1); phi_SJ for phi at or
/// below it. `share` is share_of_first().
template <class P, class T>
Meet<P, T> first_compression_to(const BasicOverCompression<P>& o, const std::type_identity_t<P>& share,
                                const T& phi) {
  using std::pow;
  if (phi <= o.phi_SJ) return o.phi_SJ;
  return o.phi_SJ * (1 + pow((phi - o.phi_SJ) / (o.alpha_max * share), 1 / o.alpha_phi));
}
template <class P, class T>
Meet<P, T> first_compression_to(const BasicOverCompression<P>& o, const T& phi) {
  return first_compression_to(o, share_of_first(o), phi);
}

/// d phi_J/d ln nu of a packing that jams at phi and is compressed at nu, having been compressed to phi_max
/// >= nu: up to the density whose first compression leaves phi, compression is part of one more cycle of
/// Eq. 5.1, M growing with ln nu; from there on it goes as first compressions do, the one passing into the
/// other over the last 2 % of nu. It is 0 at nu <= phi, begins over 0.2 % of nu, and is at most phi/2: next
/// to phi_SJ the slope of Eq. 5.1 is infinite, and compression must not unjam. `share` is share_of_first(),
/// `limit` jamming_density_limit() of phi_max.
template <class P, class T>
Meet<P, T> growth_by_compression(const BasicOverCompression<P>& o, const std::type_identity_t<P>& share,
                                 const T& limit, const T& phi, const T& nu, const T& phi_max) {
  using std::log, std::pow;
  using R = Meet<P, T>;
  constexpr double passing = 0.02, beginning = 0.002;  // of ln nu
  if (nu <= phi || phi <= o.phi_SJ) return 0.0;
  const R first = first_compression_to(o, share, phi);
  R to_go = 1.0;  // and beyond
  if (first < nu * (1 + 1.02 * passing)) to_go = log(first / nu) / passing;
  R as_cycle = 0.0, as_first = 0.0, part = 0.0;
  if (to_go < 1) {
    as_first = o.alpha_max * share * o.alpha_phi * pow(nu / o.phi_SJ - 1, o.alpha_phi - 1) * nu / o.phi_SJ;
    part = 1.0;
    if (to_go > 0) part = (1 - to_go) * (1 - to_go) * (1 + 2 * to_go);
  }
  if (to_go > 0) {
    const bool less = phi_max < first;  // phi is what several compressions have left
    const R reached = less ? R(phi_max) : first, most = less ? R(limit) : o.phi_SJ + (phi - o.phi_SJ) / share;
    if (phi < most) {
      const R x = -log((most - phi) / (most - o.phi_SJ));
      R M = 1.0;
      if (less) M = o.mu * pow(x, 1 / o.beta);
      R length = log(reached / phi);
      if (length < 1e-3) length = 1e-3;  // next to phi_max all cycles are short
      as_cycle = (most - phi) * o.beta * x / (M * length);
    }
  }
  R grown = as_cycle + part * (as_first - as_cycle);
  if (grown > phi / 2) grown = phi / 2;
  if (nu > phi * (1 + 1.02 * beginning)) return grown;
  const R above = log(nu / phi) / beginning;
  if (above >= 1) return grown;
  return grown * above * above * (3 - 2 * above);
}
template <class P, class T>
Meet<P, T> growth_by_compression(const BasicOverCompression<P>& o, const T& phi, const T& nu,
                                 const T& phi_max) {
  using R = Meet<P, T>;
  return growth_by_compression<P, R>(o, share_of_first(o), jamming_density_limit(o, phi_max), phi, nu,
                                     phi_max);
}

/// Where `holds` turns from true to false between low and high.
template <class Holds>
double turning_point(double low, double high, Holds holds) {
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The range of e = ln(nu/phi_J) over which Eq. 2.14 is inverted, from 0 up: to where P* has its maximum (a
/// gamma_p > 0 gives it one, beyond e = 1/(2 gamma_p)), at most to 1.
template <class P>
double range_of_inversion(const BasicPressureCurve<P>& law) {
  const auto rises = [&](double e) { return pressure_slope(law, P(law.nu_c * std::exp(e))) > 0; };
  return rises(1) ? 1 : turning_point(0, 1, rises);
}

/// The phi_J for which the pressure law gives P* at nu, with_jamming_density() inverted. nu itself for P* =
/// 0; nothing where P* is more than the law gives in range_of_inversion(). A Newton step after the bisection
/// gives it its slopes.
template <class P>
std::optional<P> jamming_density_from_pressure(const BasicPressureCurve<P>& law,
                                               const std::type_identity_t<P>& nu,
                                               const std::type_identity_t<P>& pressure_) {
  using std::exp;
  if (pressure_ <= 0) return nu;
  const auto at = [&](const P& e) { return P(law.nu_c * exp(e)); };
  const auto too_little = [&](double e) { return pressure(law, at(e)) < pressure_; };
  const double range = range_of_inversion(law);
  if (too_little(range)) return std::nullopt;
  P e = turning_point(0, range, too_little);
  const double slope = value(pressure_slope(law, at(e)));
  if (slope > 0) e = e - (pressure(law, at(e)) - pressure_) / slope;
  return nu * exp(-e);
}

}  // namespace grainlaw::model
