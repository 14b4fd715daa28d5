// A point of the form with memory, of the thesis's set, and the ways of walking it.
#pragma once

#include <array>
#include <cmath>

#include "checks.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/walk/point.hpp"

namespace grainlaw::model {

inline const Law& memory_law() {
  static const Law law = make_law(thesis_with_memory(), Form::memory);
  return law;
}
inline const Memory& form() { return std::get<Memory>(memory_law()); }
inline const OverCompression& over() { return form().laws.memory.over; }

/// m of a state.
inline double memory_in(const State& state) { return form().memory(state.shear); }

/// An isotropic point of jamming density phi_J that has seen phi_max.
inline State isotropic(double nu, double phi_J = 0.6649, double phi_max = 0.82, const Memory& of = form()) {
  State state;
  state.nu = nu;
  state.phi_J = phi_J;
  state.history = {phi_J, phi_max, nu};
  state.shear.steady = of.steady_density(nu);
  state.P = of.pressure_of(nu, phi_J);
  state.jammed = state.P > smallest_pressure;
  if (!state.jammed) state.P = 0;
  return state;
}

inline MaterialPoint point_at(const State& start, Tolerance tolerance = {1e-10, 1e-13}) {
  return MaterialPoint(memory_law(), start, tolerance);
}

enum class WalkedBy { bdf, adams, light };
inline constexpr std::array integrators{WalkedBy::bdf, WalkedBy::adams, WalkedBy::light};
inline const char* name_of(WalkedBy integrator) {
  return std::array{"Bdf", "Adams", "Light"}[static_cast<std::size_t>(integrator)];
}

/// Walks the state; says how it went.
inline Status walk_by(WalkedBy integrator, State& state, double eps_vol, double eps_dev,
                      Tolerance tolerance = {1e-9, 1e-12}, const Law& law = memory_law()) {
  if (integrator == WalkedBy::light) return LightLaw(law, tolerance).update(state, eps_vol, eps_dev);
  MaterialPoint point(law, state, tolerance, integrator == WalkedBy::bdf ? Method::bdf : Method::adams);
  const Status status = point.walk(eps_vol, eps_dev);
  state = point.state();
  return status;
}

}  // namespace grainlaw::model
