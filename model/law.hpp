// The law in its three forms behind one interface: state of a material point, memory of the direction of
// shear, and the rates of each form along a straight stretch of strain (rate independent: the path variable t
// runs from 0 to 1).
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "grainlaw/model/closure.hpp"

namespace grainlaw::model {

/// A straight stretch of logarithmic strain, compression positive; t in [0, 1].
struct Stretch {
  double nu_0 = 0.5;   ///< volume fraction at t = 0
  double eps_vol = 0;  ///< change of ln nu: the full volume strain, 3 d eps_v of the thesis
  double eps_dev = 0;  ///< signed deviatoric strain

  double nu(double t) const { return nu_0 * std::exp(eps_vol * t); }
  Stretch rest(double t) const { return {nu(t), eps_vol * (1 - t), eps_dev * (1 - t)}; }
  /// q = sgn(d eps_dev): -1, 0 or 1.
  double q() const { return static_cast<double>((eps_dev > 0) - (eps_dev < 0)); }
};

/// What a direction of shear remembers of its start. A direction begins at the start of a path, at a
/// reversal, after a relaxation, and with the first shear after a purely isotropic stretch.
struct Direction {
  double q = 0;          ///< +1 or -1; 0: the next shear begins a new one
  double S_I = 1;        ///< |S| at its start, S = 1 - q s/s_max (Eq. 4.16), at least 1e-6
  double S_F_I = 1;      ///< the same of 1 - q F_dev/F_max
  double s_0 = 0;        ///< s_dev at its start (Eq. 2.17)
  double F_0 = 0;        ///< F_dev at its start (Eq. 2.18)
  double eps_dev_0 = 0;  ///< eps_dev at its start
};

/// A material point. Stresses over k*, compression positive; deviatoric values signed.
struct State {
  double nu = 0.5;
  double eps_vol = 0;  ///< ln(nu/nu_start)
  double eps_dev = 0;
  double P = 0;
  double sigma_dev = 0;
  double F_dev = 0;
  double phi_J = 0;     ///< jamming density: at and below it the point is unjammed
  bool jammed = false;  ///< unjammed: P = sigma_dev = F_dev = 0, no contacts
  Direction direction;

  /// sigma_dev/P; NaN where unjammed.
  double s_dev() const;
};

/// The variables that are integrated, and their Jacobian by columns: J[i + size j] = d rate_i/d y_j.
using Variables = std::array<double, 3>;

/// Eqs. 2.17, 2.18 evaluated at the current volume fraction; nothing to integrate.
struct ReducedClosed {
  Laws laws;
  State at(const State& begin, const Stretch& stretch, double t) const;
};

/// ds = beta_s (q s_max - s)|d eps_dev|, dF = beta_F (q F_max - F)|d eps_dev|, P* = Eq. 2.14; variables
/// s_dev, F_dev.
struct Reduced {
  static constexpr int size = 2;
  Laws laws;
  Variables variables(const State& begin) const;
  bool rate(const Stretch& stretch, const Direction& direction, double t, const double* y,
            double* dydt) const;
  bool jacobian(const Stretch& stretch, const Direction& direction, double t, const double* y,
                double* J) const;
  State state(const State& begin, const Stretch& stretch, double t, const double* y) const;
};

/// Eq. 4.16; variables P*, sigma*_dev, F_dev.
struct Coupled {
  static constexpr int size = 3;
  Laws laws;
  Variables variables(const State& begin) const;
  bool rate(const Stretch& stretch, const Direction& direction, double t, const double* y,
            double* dydt) const;
  bool jacobian(const Stretch& stretch, const Direction& direction, double t, const double* y,
                double* J) const;
  State state(const State& begin, const Stretch& stretch, double t, const double* y) const;
};

using Law = std::variant<ReducedClosed, Reduced, Coupled>;

Law make_law(const ParameterSet& parameters, Form form);
Form form_of(const Law& law);
const Laws& laws_of(const Law& law);

/// At and below this P* (over k*) the coupled form is unjammed: sigma*_dev/P* has no limit at P* = 0.
inline constexpr double smallest_pressure = 1e-9;

/// The volume fraction at and below which a jammed point has no contacts whatever it carries.
double unjamming_density(const Law& law);

/// Takes stress, fabric and direction away. In the coupled form phi_J becomes the current nu: the density at
/// which the pressure vanished.
void unjam(const Law& law, State& state);

/// The volume fraction at which an unjammed point jams when compressed. For the coupled form a little above
/// phi_J, where P* is well above smallest_pressure.
double jamming_density(const Law& law, const State& state);

/// Jams a point that has reached jamming_density() on this stretch: isotropic before, at the start of a
/// direction now. The coupled form is put on the solution of Eq. 4.16 for P* -> 0 (both stresses and F_dev
/// proportional to the volume strain since phi_J).
void jam(const Law& law, State& state, const Stretch& stretch);

/// Begins a direction of shear q at a jammed state: S_I, S_F,I, s_0, F_0.
void begin_direction(const Law& law, State& state, double q);

/// What keeps the law from this stretch, in words ("s_max is -0.01 at nu = 0.9 and must be > 0"), if
/// anything.
std::optional<std::string> objection(const Law& law, const Stretch& stretch);

/// Isotropic contact quantities of a state. Unjammed: no contacts, C_star is NaN (undefined). Where the point
/// is jammed below the density at which the contact law begins, C, C_star and f_NR are those of that density.
struct Contacts {
  double F_v, C, C_star, f_NR;
};
Contacts contacts_of(const Law& law, const State& state);

}  // namespace grainlaw::model
