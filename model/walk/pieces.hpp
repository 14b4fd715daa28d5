// A stretch cut where the derivatives of its rates become infinite: where a point of the form with memory
// comes up to the density at which the contacts of its pressure law begin, above which C* goes as (nu/nu_c -
// 1)^alpha, alpha < 1. From there t goes with the cube of the variable of integration, so that they stay
// finite.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "grainlaw/model/walk/integrator.hpp"

namespace grainlaw::model {

/// From t = begin to end, tau from 0 to 1.
struct Piece {
  double begin = 0, end = 1;
  bool singular = false;  ///< where it begins

  double t(double tau) const { return begin + (end - begin) * (singular ? tau * tau * tau : tau); }
  /// dt/dtau.
  double slope(double tau) const { return (end - begin) * (singular ? 3 * tau * tau : 1); }
  double tau(double t) const {
    if (t >= end) return 1;
    const double part = (t - begin) / (end - begin);
    return singular ? std::cbrt(part) : part;
  }
};

/// Where a point passes that density.
struct Crossing {
  double t;
  bool rises;             ///< from below: contacts begin
  bool of_shear = false;  ///< those of steady shear, not those of the pressure law
};

/// Pieces between `crossings` (ascending, inside (0, 1)); each ends `gap` before the next one begins, since
/// where that is is known no better.
inline std::vector<Piece> pieces_of(const std::vector<Crossing>& crossings, double gap) {
  std::vector<Piece> pieces{Piece{}};
  for (const Crossing& crossing : crossings) {
    Piece& before = pieces.back();
    before.end = std::max(crossing.t - gap, 0.5 * (before.begin + crossing.t));
    pieces.push_back({crossing.t, 1, crossing.rises});
  }
  return pieces;
}

/// `system` over tau; both must outlive it.
inline System over(const Piece& piece, const System& system, std::size_t size, std::size_t sensitivities) {
  const auto scale = [&piece](double tau, std::size_t numbers, double* rates, auto find) {
    if (!find(piece.t(tau))) return false;
    const double slope = piece.slope(tau);
    for (std::size_t i = 0; i < numbers; ++i) rates[i] = slope * rates[i];
    return true;
  };
  System mapped;
  mapped.rate = [=, &system](double tau, const double* y, double* dydt) {
    return scale(tau, size, dydt, [&](double t) { return system.rate(t, y, dydt); });
  };
  mapped.jacobian = [=, &system](double tau, const double* y, double* J) {
    return scale(tau, size * size, J, [&](double t) { return system.jacobian(t, y, J); });
  };
  mapped.sensitivity_rate = [=, &system](double tau, const double* y, const double* s, double* dsdt) {
    return scale(tau, size * sensitivities, dsdt,
                 [&](double t) { return system.sensitivity_rate(t, y, s, dsdt); });
  };
  if (system.event)
    mapped.event = [&piece, &system](double tau, const double* y) { return system.event(piece.t(tau), y); };
  return mapped;
}

}  // namespace grainlaw::model
