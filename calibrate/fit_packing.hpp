// Fits of the packing laws over volume fraction: C*(nu) of Eq. 2.11, phi_r(nu) of Eq. 2.12, p(nu) of
// Eq. 2.14. One row of Table 2.1 (isotropic.MODE of a parameter set) from measured states of one mode.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// What somebody else found for a parameter.
struct KnownValue {
  double value = 0;
  double error = 0;  ///< standard error; 0: none is stated
  KnownValue(double known, double with_error = 0) : value(known), error(with_error) {}
};
/// Values to hold a parameter at if the data cannot determine it, by name; empty where nobody knows any.
using KnownValues = std::map<std::string, KnownValue>;

/// A parameter of a fit that can be held at its known value, after those of a lower `hold_order`. `initial`
/// is taken into the bounds.
FitParameter known_parameter(const KnownValues& known, const std::string& name, double initial, double low,
                             double high, double scale, int hold_order = 0);

/// A measured state, all numbers over one volume fraction. Errors are standard errors, 0 where unknown.
struct PackingState {
  double nu = 0;
  double P = 0;       ///< P*, over k*
  double C = 0;       ///< M4/N
  double C_star = 0;  ///< M4/N4
  double phi_r = 0;   ///< 1 - N4/N
  double P_error = 0, C_star_error = 0, phi_r_error = 0;
};

/// States of one record.
struct PackingSeries {
  std::string test;   ///< name of the record
  std::string group;  ///< its seed: series of one group are not independent
  std::vector<PackingState> states;
};

/// C* = C0 + C1 (nu/nu_c - 1)^alpha, C0 = 6 held, or free (`free_C0`). Parameters C0, C1, alpha,
/// nu_c_contacts. nu_c_contacts stays below the lowest nu of the data, where the law ends.
FitProblem contacts_problem(const std::vector<PackingSeries>& series, Points points, const KnownValues& known,
                            bool free_C0 = false);

/// phi_r = phi_c exp[-phi_v (nu/nu_c - 1)] at a given nu_c, that of the contacts. Parameters phi_c, phi_v,
/// nu_c_contacts (held; its error goes into the errors of the others).
FitProblem rattlers_problem(const std::vector<PackingSeries>& series, Points points, const KnownValues& known,
                            double nu_c_contacts, double nu_c_error);

/// p = p0 (nu C/nu_c) e (1 - gamma_p e), e = ln(nu/nu_c), with the measured C: that p is proportional to the
/// number of contacts is not in question, so an error of the fitted C must not be made up for by p0.
/// Parameters p0, gamma_p, nu_c.
FitProblem pressure_problem(const std::vector<PackingSeries>& series, Points points,
                            const KnownValues& known);

/// C0 is a limit, and Eq. 2.11 its approach: over a wider range of volume fractions a single exponent does
/// not hold, and a free C0 would take up the difference. So the fit with C0 free takes states up to this nu
/// over the lowest one, less one.
inline constexpr double free_C0_range = 0.12;
std::vector<PackingSeries> near_jamming(const std::vector<PackingSeries>& series);

/// A row of Table 2.1.
struct PackingFit {
  FitResult contacts, contacts_free_C0, rattlers, pressure;
  FitProblem contacts_law, contacts_free_C0_law, rattlers_law, pressure_law;  ///< as fitted, with their data
};

/// C over nu by the fitted contact and rattler laws: what the pressure law needs for its curve. Empty where
/// they were not fitted.
std::function<double(double)> coordination_of(const PackingFit& fit);

/// All of them; never throws for want of data, see FitEstimate::determined.
PackingFit fit_packing(const std::vector<PackingSeries>& series, Points points, const KnownValues& known);

}  // namespace grainlaw::calibrate
