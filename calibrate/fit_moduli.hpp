// Fits of the small-strain moduli over the state of a packing: B of Eq. 4.11, A1/B and A2/B of Eqs. 4.12 and
// 4.13, the initial G/B of Eq. 4.14 and its decrease of Eq. 4.15; and, past the thesis, A/B0 of the energy,
// which gives A1 and A2 at once. Group moduli of a parameter set.
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"
#include "grainlaw/model/laws/packing_laws.hpp"

namespace grainlaw::calibrate {

/// A packing in balance and its moduli, all over k* = k/(2<r>); signs count along the axis of shear.
struct ModuliState {
  double eps_dev = 0;  ///< of the test's path, where it was taken
  double nu = 0, P = 0, sigma_dev = 0, F_v = 0, F_dev = 0;
  double B = 0, A1 = 0, A2 = 0, G = 0;  ///< G = G_oct
};

/// States of one test, in the order they were passed.
struct ModuliSeries {
  std::string test;   ///< name of the record
  std::string group;  ///< its seed: series of one group are not independent
  std::vector<ModuliState> states;
};

/// Strain up to which G/B counts as that of the isotropic packing, as in Fig. 4.13c.
inline constexpr double initial_strain = 0.008;

/// B = p0 F_v/(g3 nu_c) [1 - 2 gamma_p e + e (1 - gamma_p e) d ln F_v/de], e = ln(nu/nu_c) (Eq. 4.11), over
/// the measured F_v; the slope d ln F_v/de is that of the contacts' laws, and states at or below their nu_c
/// are left out. Parameters p0, gamma_p, nu_c (held: that of the pressure in shear, as in the thesis; its
/// error goes into those of the others). b of Eq. 4.17 multiplies p0 and is no parameter of its own.
FitProblem bulk_modulus_problem(const std::vector<ModuliSeries>& series, const model::ContactCurve& contacts,
                                double g3, const KnownValue& nu_c, const KnownValues& known);

/// A1/B = a_I F_dev (Eq. 4.12), A2/B = a_II F_dev (Eq. 4.13). One parameter.
FitProblem first_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known);
FitProblem second_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known);

/// A/B0 = a_F F_dev/F_v + a_s s_dev, with B0 = B - (2/3) P* and A those of the second derivative of the
/// energy: A = A1 + (2/9) sigma*_dev = (2/3) (A2 - (2/3) sigma*_dev), of which y is the mean. x is F_dev/F_v,
/// known is s_dev. Parameters a_F, a_s.
FitProblem energy_anisotropy_problem(const std::vector<ModuliSeries>& series, const KnownValues& known);

/// (G/B)_ini = GB_max {1 - exp[-(F_v - Fv_min)/Fv_alpha]} (Eq. 4.14): one point per test, the means over its
/// states with |eps_dev| <= initial_strain. Parameters GB_max, Fv_min, Fv_alpha.
FitProblem initial_ratio_problem(const std::vector<ModuliSeries>& series, const KnownValues& known);

/// G/B - (G/B)_ini = -g_I sigma*_dev F_dev (Eq. 4.15), (G/B)_ini being that of the same test; tests without
/// it are left out. Parameter g_I.
FitProblem shear_modulus_problem(const std::vector<ModuliSeries>& series, const KnownValues& known);

/// Group moduli.
struct ModuliFit {
  FitResult B, A1, A2, A, GB_ini, G;
  FitProblem B_law, A1_law, A2_law, A_law, GB_ini_law, G_law;  ///< as fitted, with their data
};

/// All of them; never throws for want of data, see FitEstimate::determined.
ModuliFit fit_moduli(const std::vector<ModuliSeries>& series, const model::ContactCurve& contacts, double g3,
                     const KnownValue& nu_c, const KnownValues& known);

}  // namespace grainlaw::calibrate
