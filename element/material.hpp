// The material of grains and its units: what a scene and a parameter set both state.
#pragma once

#include "grainlaw/element/json.hpp"

namespace grainlaw {

/// Reduced units: mm, us, ug (Table 3.1, section 2.2.2).
struct Material {
  double w = 3;          ///< r_max / r_min of the uniform size distribution
  double k = 1e5;        ///< normal stiffness, ug/us^2
  double r_mean = 1;     ///< mm
  double rho = 2000;     ///< ug/mm^3 = kg/m^3
  double gamma = 1000;   ///< contact viscosity, ug/us; where a file leaves it out, times damping_scale()
  double gamma_b = 100;  ///< background viscosity, ug/us; likewise

  double r_min() const { return 2 * r_mean / (w + 1); }
  double r_max() const { return w * r_min(); }
  /// Stress unit k* = k/(2<r>), ug/(mm us^2) = MPa.
  double stress_unit() const { return k / (2 * r_mean); }
  double stress_unit_kPa() const { return 1e3 * stress_unit(); }
  /// Contact duration of two grains of radius r (Eq. after 2.1), us. Infinite for an overdamped pair.
  double contact_duration(double r) const;

  /// sqrt(k rho <r>^3) over that of the defaults: viscosities times this damp a contact of such grains as
  /// much as the thesis's damp its own.
  double damping_scale() const;

  static Material read(Reader reader);
  Json to_json() const;
};

/// g3(w) of the isotropic fabric law F_v = g3 nu C (Eq. 3.8) for the uniform size distribution on [2/(w+1),
/// 2w/(w+1)] r_mean.
double fabric_size_factor(double w);

}  // namespace grainlaw
