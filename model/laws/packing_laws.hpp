// Isotropic packing laws: contacts per grain, rattlers, isotropic fabric and pressure as functions of volume
// fraction (thesis Eqs. 2.11, 2.12, 2.14, 3.8). Pure functions, templates over the scalar of the numbers (P)
// and of the volume fraction (T); all results are non-dimensional.
#pragma once

#include <cmath>
#include <limits>

#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

/// Numbers of Eqs. 2.11 and 2.12.
template <class P>
struct BasicContactCurve {
  P C0 = 6;      ///< isostatic C* of frictionless spheres
  P C1 = 0;      ///< growth of C* above nu_c
  P alpha = 1;   ///< its exponent, > 0
  P nu_c = 0.5;  ///< volume fraction where contacts begin
  P phi_c = 0;   ///< fraction of rattlers at nu_c, in [0, 1)
  P phi_v = 0;   ///< its decay rate

  template <class T>
  auto excess(const T& nu) const {
    return nu / nu_c - 1;
  }
};
using ContactCurve = BasicContactCurve<double>;

/// Numbers of Eq. 2.14.
template <class P>
struct BasicPressureCurve {
  BasicContactCurve<P> contacts;  ///< C of the prefactor nu C / nu_c
  P p0 = 0;
  P gamma_p = 0;  ///< weak non-linearity; may be negative
  P nu_c = 0.5;   ///< volume fraction where pressure begins: phi_J
};
using PressureCurve = BasicPressureCurve<double>;

/// Eq. 2.11: C* = C0 + C1 (nu/nu_c - 1)^alpha, contacts per grain that has at least four.
/// NaN (undefined: no grain has four contacts) where nu < nu_c.
template <class P, class T>
Meet<P, T> corrected_coordination(const BasicContactCurve<P>& c, const T& nu) {
  using std::pow;
  if (nu < c.nu_c) return std::numeric_limits<double>::quiet_NaN();
  return c.C0 + c.C1 * pow(c.excess(nu), c.alpha);
}

/// dC*/d nu of Eq. 2.11; infinite at nu_c where alpha < 1, NaN below.
template <class P, class T>
Meet<P, T> corrected_coordination_slope(const BasicContactCurve<P>& c, const T& nu) {
  using std::pow;
  if (nu < c.nu_c) return std::numeric_limits<double>::quiet_NaN();
  return c.C1 * c.alpha / c.nu_c * pow(c.excess(nu), c.alpha - 1);
}

/// Eq. 2.12: phi_r = phi_c exp[-phi_v (nu/nu_c - 1)], fraction of rattlers; 1 where nu < nu_c.
template <class P, class T>
Meet<P, T> rattlers(const BasicContactCurve<P>& c, const T& nu) {
  using std::exp;
  if (nu < c.nu_c) return 1.0;
  return c.phi_c * exp(-c.phi_v * c.excess(nu));
}

/// d phi_r/d nu of Eq. 2.12; 0 below nu_c.
template <class P, class T>
Meet<P, T> rattlers_slope(const BasicContactCurve<P>& c, const T& nu) {
  if (nu < c.nu_c) return 0.0;
  return -c.phi_v / c.nu_c * rattlers(c, nu);
}

/// C = (1 - phi_r) C*, contacts of grains with at least four, per grain; 0 where nu < nu_c.
template <class P, class T>
Meet<P, T> coordination(const BasicContactCurve<P>& c, const T& nu) {
  if (nu < c.nu_c) return 0.0;
  return (1 - rattlers(c, nu)) * corrected_coordination(c, nu);
}

/// dC/d nu; infinite at nu_c where alpha < 1, 0 below.
template <class P, class T>
Meet<P, T> coordination_slope(const BasicContactCurve<P>& c, const T& nu) {
  if (nu < c.nu_c) return 0.0;
  return (1 - rattlers(c, nu)) * corrected_coordination_slope(c, nu) -
         rattlers_slope(c, nu) * corrected_coordination(c, nu);
}

/// nu, but not below where contacts begin. A packing under pressure has at least the contacts of nu_c: with
/// the rows of Table 2.1 pressure may begin before the contacts do (D2: 0.6581 before 0.6601).
template <class P, class T>
Meet<P, T> at_least_isostatic(const BasicContactCurve<P>& c, const T& nu) {
  if (nu < c.nu_c) return c.nu_c;
  return nu;
}

/// F_v = tr F = g3 nu C (Eqs. 3.6, 4.6); 0 where nu < nu_c.
template <class P, class T>
Meet<P, T> isotropic_fabric(const BasicContactCurve<P>& c, const std::type_identity_t<P>& g3, const T& nu) {
  return g3 * nu * coordination(c, nu);
}

/// Isotropic fabric and the product that Eq. 4.11 needs of its slope.
template <class T>
struct FabricWithSlope {
  T F_v;      ///< g3 nu C
  T e_slope;  ///< e d ln F_v/d ln nu
};

/// Both for e = ln(nu/nu_e), with each power and exponential taken once. The product is finite, namely 0,
/// where nu, nu_c and nu_e meet and the slope itself is infinite. Needs nu >= nu_c.
template <class P, class T>
FabricWithSlope<Meet<P, T>> fabric_with_slope(const BasicContactCurve<P>& c,
                                              const std::type_identity_t<P>& g3, const T& nu,
                                              const Meet<P, T>& e) {
  using std::exp, std::pow;
  const auto x = c.excess(nu);
  const auto power = pow(x, c.alpha), C_star = c.C0 + c.C1 * power, phi = c.phi_c * exp(-c.phi_v * x);
  const auto F_v = g3 * nu * (1 - phi) * C_star;
  if (e == 0) return {F_v, 0.0};
  // d C*/d nu = C1 alpha x^(alpha - 1)/nu_c, d phi_r/d nu = -phi_v phi_r/nu_c.
  return {F_v, e * (1 + nu / c.nu_c * (c.C1 * c.alpha * power / (x * C_star) + c.phi_v * phi / (1 - phi)))};
}

/// The product alone.
template <class P, class T>
Meet<P, T> strain_times_fabric_slope(const BasicContactCurve<P>& c, const T& nu, const Meet<P, T>& e) {
  return fabric_with_slope(c, P(1.0), nu, e).e_slope;
}

/// The volume fraction at and below which Eq. 2.14 gives no pressure.
template <class P>
P jamming_density(const BasicPressureCurve<P>& p) {
  return p.nu_c;
}

/// Eq. 2.14 with its e = ln(nu/nu_c) > 0.
template <class P, class T, class E>
Meet<P, T> pressure_at_strain(const BasicPressureCurve<P>& p, const T& nu, const E& e) {
  const auto C = coordination(p.contacts, at_least_isostatic(p.contacts, nu));
  return p.p0 * nu * C / p.nu_c * e * (1 - p.gamma_p * e);
}

/// Eq. 2.14: P* = p0 (nu C/nu_c) e (1 - gamma_p e), e = ln(nu/nu_c); over k* = k/(2<r>), compression
/// positive. Rises from 0 at jamming_density(); C is the one of at_least_isostatic().
template <class P, class T>
Meet<P, T> pressure(const BasicPressureCurve<P>& p, const T& nu) {
  using std::log;
  if (nu <= jamming_density(p)) return 0.0;
  return pressure_at_strain(p, nu, log(nu / p.nu_c));
}

/// dP*/d ln nu of Eq. 2.14; 0 at and below jamming_density().
template <class P, class T>
Meet<P, T> pressure_slope(const BasicPressureCurve<P>& p, const T& nu) {
  using std::log;
  if (nu <= jamming_density(p)) return 0.0;
  const auto e = log(nu / p.nu_c), C = coordination(p.contacts, at_least_isostatic(p.contacts, nu));
  const auto dC = nu * coordination_slope(p.contacts, nu);
  return p.p0 * nu / p.nu_c * ((C + dC) * e * (1 - p.gamma_p * e) + C * (1 - 2 * p.gamma_p * e));
}

/// The same law for another history: phi_J in place of nu_c (Eqs. 5.7 to 5.9), the nu_c of its contacts moved
/// in proportion. P* at nu is then that of `p` at nu p.nu_c/phi_J.
template <class P>
BasicPressureCurve<P> with_jamming_density(BasicPressureCurve<P> p, const P& phi_J) {
  p.contacts.nu_c = p.contacts.nu_c * phi_J / p.nu_c;
  p.nu_c = phi_J;
  return p;
}

}  // namespace grainlaw::model
