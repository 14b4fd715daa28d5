// A point of the form with memory, of the thesis's set.
#pragma once

#include "checks.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::model {

inline ParameterSet with_memory() {
  ParameterSet set = thesis();
  set.memory->eps_c.emplace().value = 0.0423;
  return set;
}

inline Memory form() { return std::get<Memory>(make_law(with_memory(), Form::memory)); }

/// An isotropic point of jamming density phi_J that has seen phi_max.
inline State isotropic(double nu, double phi_J, double phi_max = 0.82) {
  const Memory law = form();
  State state;
  state.nu = nu;
  state.phi_J = phi_J;
  state.history = {phi_J, phi_max, nu};
  state.P = law.pressure_of(nu, phi_J, 0.0);
  state.jammed = state.P > smallest_pressure;
  if (!state.jammed) state.P = 0;
  return state;
}

inline MaterialPoint point_at(const State& start, Tolerance tolerance = {1e-10, 1e-13}) {
  return MaterialPoint(make_law(with_memory(), Form::memory), start, tolerance);
}

}  // namespace grainlaw::model
