// What the forms of the law share: rates at a point of a stretch, their Jacobian, and the start of a
// direction.
#pragma once

#include <array>
#include <cstddef>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// dy/dt at t of a stretch. False where the rate is not defined.
template <class F, class S, class X, class Y>
bool rate_at(const F& form, const BasicStretch<S>& stretch, const BasicDirection<S>& direction, const X& t,
             const Y* y, Y* dydt) {
  return form.rate(form.coefficients(stretch.nu(t), direction), stretch, direction, y, dydt);
}

/// J[i + size j] = d rate_i/d y_j at t of a stretch, by dual numbers. False where the rate is not defined.
template <class F>
bool jacobian_of(const F& form, const Stretch& stretch, const Direction& direction, double t, const double* y,
                 double* J) {
  constexpr std::size_t n = F::size;
  std::array<Dual<n>, n> variables, rates;
  for (std::size_t j = 0; j < n; ++j) variables[j] = Dual<n>(y[j], j);
  if (!rate_at(form, stretch, direction, t, variables.data(), rates.data())) return false;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) J[i + n * j] = rates[i].slope[j];
  return true;
}

/// Begins a direction of shear q at a jammed state: S_I, S_F,I, s_0, F_0.
template <class P, class T>
void begin_direction_of(const BasicLaws<P>& laws, BasicState<T>& state, const Sign<T>& q) {
  const T s = state.s_dev();
  state.direction = {.q = q,
                     .S_I = distance_scale<T>(q, s, saturation(laws.s_max, state.nu)),
                     .S_F_I = distance_scale<T>(q, state.F_dev, saturation(laws.F_max, state.nu)),
                     .s_0 = s,
                     .F_0 = state.F_dev,
                     .eps_dev_0 = state.eps_dev};
}

}  // namespace grainlaw::model
