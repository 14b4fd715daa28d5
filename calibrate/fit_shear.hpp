// Fits of the shear laws: s_dev(e) and F_dev(e) of one run (Eqs. 2.17, 2.18), and Q(nu) through many
// (Eq. 2.20). The rows s_max, beta_s, F_max, beta_F of Table 2.2 (group shear of a parameter set).
#pragma once

#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// One quantity over deviatoric strain, of the first loading of one run: both counted positive along the
/// loading.
struct ShearCurve {
  std::string test;   ///< name of the record
  std::string group;  ///< its seed
  double nu = 0;
  std::vector<double> strain, value;
  bool projected = false;  ///< on the deviator of the mode (shear_column); false: the record's signed column
};

/// y = max - (max - initial) exp(-beta e). Parameters max, initial, beta.
FitProblem approach_problem(const ShearCurve& curve);
FitResult fit_approach(const ShearCurve& curve);

/// A number that each of several runs gave, over their volume fraction.
struct RunValue {
  std::string test, group;
  double nu = 0, value = 0, error = 0;
  bool steady_mean = false;  ///< the mean at large strain; false: a parameter of the run's own fit
};

/// The quantities that Eq. 2.20 is fitted to.
enum class ShearQuantity { s_max, beta_s, F_max, beta_F };
inline constexpr ShearQuantity shear_quantities[] = {ShearQuantity::s_max, ShearQuantity::beta_s,
                                                     ShearQuantity::F_max, ShearQuantity::beta_F};
std::string name_of(ShearQuantity quantity);

/// Q = Q_max + Q_v exp[-alpha (nu/nu_c - 1)] at a given nu_c (held; its error goes into those of the others).
/// Parameters Q_max, Q_v, alpha, nu_c. Q_max of the two fabric quantities is held at 0, as in Table 2.2. Q_v
/// may be negative: that Q falls with nu is for the data to say.
FitProblem density_problem(ShearQuantity quantity, const std::vector<RunValue>& values, double nu_c,
                           double nu_c_error, const KnownValues& known);

/// Slope of a straight line through the values over nu, with its standard error; says without any law whether
/// they fall.
struct Trend {
  double slope = 0, error = 0;
  bool known = false;  ///< false: fewer than three different nu
};
Trend trend_of(const std::vector<RunValue>& values);

}  // namespace grainlaw::calibrate
