// How shear lowers the jamming density and so jams a packing below it, and how a reversal undoes that (thesis
// Eqs. 5.2, 5.3, 5.13). Pure functions, over any scalar that knows pow, exp and log.
#pragma once

#include <cmath>
#include <limits>

namespace grainlaw::model {

/// Numbers of Eqs. 5.2 and 5.3, and, with phi_cr in place of the jamming density, of Eq. 5.13.
template <class T = double>
struct ShearMemory {
  T phi_SJ = T(0.5);  ///< jamming density of endless shear: nothing jams at or below it
  T alpha = T(1);     ///< exponent, > 0
  T eps0 = T(0.1);    ///< strain over which the memory fades
};

/// Eq. 5.3 in the form without eps_SJ: phi_J = phi_SJ + (phi_J0 - phi_SJ) exp[-(eps_d/eps0)^alpha] after the
/// deviatoric strain eps_d >= 0 from phi_J0. Serves phi above and below phi_J0 alike.
template <class T>
T sheared_jamming_density(const ShearMemory<T>& law, const T& phi_J0, const T& eps_d) {
  using std::exp;
  using std::pow;
  if (!(eps_d > T(0))) return phi_J0;  // pow has no derivative at 0 where alpha < 1
  return law.phi_SJ + (phi_J0 - law.phi_SJ) * exp(-pow(eps_d / law.eps0, law.alpha));
}

/// Eq. 5.2: eps_SJ = eps0 {-ln[(phi - phi_SJ)/(phi_J0 - phi_SJ)]}^(1/alpha), the deviatoric strain at which
/// the jamming density has come down to phi. 0 where phi >= phi_J0 (jammed before shear), infinite where phi
/// <= phi_SJ (never). With phi_J0 = phi_cr and eps0 = eps0_R it is Eq. 5.13, counted from the reversal.
template <class T>
T shear_jamming_strain(const ShearMemory<T>& law, const T& phi_J0, const T& phi) {
  using std::log;
  using std::pow;
  if (phi >= phi_J0) return T(0);
  if (phi <= law.phi_SJ) return T(std::numeric_limits<double>::infinity());
  return law.eps0 * pow(-log((phi - law.phi_SJ) / (phi_J0 - law.phi_SJ)), T(1) / law.alpha);
}

}  // namespace grainlaw::model
