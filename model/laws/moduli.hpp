// Small-strain moduli B, A1, A2, G = G_oct (thesis Eqs. 4.11 to 4.15), all over k* = k/(2<r>), from fabric
// and stress: [dP*, dsigma*_dev] = [[B, A1], [A2, G]] [3 d eps_v, d eps_dev]; 3 d eps_v = d ln nu, signed
// deviatoric quantities.
#pragma once

#include <cmath>

#include "grainlaw/model/laws/packing_laws.hpp"

namespace grainlaw::model {

/// Numbers of Eqs. 4.11 to 4.15 (Table 4.1), and of the law of the energy, which takes the place of 4.12 and
/// 4.13.
template <class P>
struct BasicModuli {
  P p0 = 0;        ///< prefactor of B; Table 4.2's b times p0 in one number
  P gamma_p = 0;   ///< non-linearity of B
  P nu_c = 0.5;    ///< volume fraction the strain of B counts from
  P g3 = 1;        ///< size distribution factor of F_v
  P a_I = 0;       ///< A1/(B F_dev)
  P a_II = 0;      ///< A2/(B F_dev)
  P g_I = 0;       ///< decrease of G/B with sigma*_dev F_dev
  P GB_max = 0;    ///< (G/B)_ini at large F_v
  P Fv_min = 0;    ///< F_v where (G/B)_ini begins
  P Fv_alpha = 1;  ///< its growth in F_v, > 0
  P a_F = 0;       ///< past the thesis: share of F_dev/F_v in A/B0
  P a_s = 0;       ///< past the thesis: share of s_dev in A/B0
};
using Moduli = BasicModuli<double>;

/// Eq. 4.11: B = p0 F_v/(g3 nu_c) [1 - 2 gamma_p e + e (1 - gamma_p e) d ln F_v/de], e = ln(nu/nu_c), from
/// F_v and its slope for this e.
template <class P, class T>
auto bulk_modulus(const BasicModuli<P>& m, const FabricWithSlope<T>& fabric, const T& e) {
  return m.p0 * fabric.F_v / (m.g3 * m.nu_c) * (1 - 2 * m.gamma_p * e + (1 - m.gamma_p * e) * fabric.e_slope);
}

/// The same with F_v(nu) from `contacts`. Finite at nu_c; 0 where nu < contacts.nu_c.
template <class P, class T>
Meet<P, T> bulk_modulus(const BasicModuli<P>& m, const BasicContactCurve<P>& contacts, const T& nu) {
  using std::log;
  if (nu < contacts.nu_c) return 0.0;
  const Meet<P, T> e = log(nu / m.nu_c);
  return bulk_modulus(m, fabric_with_slope(contacts, m.g3, nu, e), e);
}

/// Eq. 4.12: A1 = a_I B F_dev. Its derivative with respect to F_dev is a_I B.
template <class P, class C, class T>
auto anisotropy_modulus_1(const BasicModuli<P>& m, const C& B, const T& F_dev) {
  return m.a_I * B * F_dev;
}

/// Eq. 4.13: A2 = a_II B F_dev. Its derivative with respect to F_dev is a_II B.
template <class P, class C, class T>
auto anisotropy_modulus_2(const BasicModuli<P>& m, const C& B, const T& F_dev) {
  return m.a_II * B * F_dev;
}

/// A1 and A2 as derivatives of the stress.
template <class T>
struct AnisotropyModuli {
  T A1, A2;
};

/// Past the thesis: A1 and A2 from one energy, whose second derivative is symmetric. With the prestress taken
/// out, B0 = B - (2/3) P* and A = B0 (a_F F_dev/F_v + a_s s_dev); the stress, where it is coaxial with the
/// strain, has the derivatives A1 = A - (2/9) sigma*_dev and A2 = (3/2) A + (2/3) sigma*_dev. P* > 0.
template <class P, class C, class T>
AnisotropyModuli<Meet<C, T>> anisotropy_moduli_of_energy(const BasicModuli<P>& m, const C& B, const C& F_v,
                                                         const T& pressure, const T& sigma_dev,
                                                         const T& F_dev) {
  const auto A = (B - 2.0 / 3 * pressure) * (m.a_F * F_dev / F_v + m.a_s * sigma_dev / pressure);
  return {A - 2.0 / 9 * sigma_dev, 1.5 * A + 2.0 / 3 * sigma_dev};
}

/// Eq. 4.14: (G/B)_ini = GB_max {1 - exp[-(F_v - Fv_min)/Fv_alpha]}. The thesis prints the exponent without
/// its minus.
template <class P, class T>
auto initial_shear_ratio(const BasicModuli<P>& m, const T& F_v) {
  using std::expm1;
  return -m.GB_max * expm1(-(F_v - m.Fv_min) / m.Fv_alpha);
}

/// Eq. 4.15: G = B [(G/B)_ini - g_I sigma*_dev F_dev]. Derivatives: -B g_I F_dev with respect to sigma*_dev,
/// -B g_I sigma*_dev with respect to F_dev.
template <class P, class C, class S, class F>
auto shear_modulus(const BasicModuli<P>& m, const C& B, const C& ratio_ini, const S& sigma_dev,
                   const F& F_dev) {
  return B * (ratio_ini - m.g_I * sigma_dev * F_dev);
}

}  // namespace grainlaw::model
