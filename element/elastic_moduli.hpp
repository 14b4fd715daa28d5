// Young's moduli and Poisson's ratios of a stiffness, by direction.
#pragma once

#include "grainlaw/element/stiffness.hpp"
#include "grainlaw/element/symmetry_class.hpp"

namespace grainlaw {

/// From the inverse S of the derivative of the STRESS by strain (not of the second derivative of the energy:
/// under prestress they differ, and a test in a cell measures stress). Directions need not have length one;
/// under prestress S has no symmetry, so that Poisson's ratios say which direction is which.
class ElasticModuli {
 public:
  /// Throws Error where the stiffness is singular.
  explicit ElasticModuli(const Stiffness& of_stress) : compliance_(inverse(of_stress)) {}

  /// 1/(nn : S : nn): stress over strain along n where only the stress along n changes, in the unit of C.
  double young(const Direction& n) const;
  /// -(mm : S : nn)/(nn : S : nn): what m gives way when n is compressed so, over what n does. Throws Error
  /// unless m and n are orthogonal to 1e-9.
  double poisson(const Direction& n, const Direction& m) const;

 private:
  double strain(const Direction& along, const Direction& from) const;

  Stiffness compliance_;
};

}  // namespace grainlaw
