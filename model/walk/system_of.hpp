// One stretch of a form of the law as the initial value problem that the integrator takes.
#pragma once

#include <type_traits>

#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/form.hpp"
#include "grainlaw/model/forms/memory.hpp"
#include "grainlaw/model/walk/integrator.hpp"

namespace grainlaw::model {

/// All three must outlive the system. The coupled form's stops where P* reaches smallest_pressure.
template <class Form>
System system_of(const Form& form, const Stretch& stretch, const Direction& direction) {
  System system;
  system.rate = [&](double t, const double* y, double* dydt) {
    return rate_at(form, stretch, direction, t, y, dydt);
  };
  system.jacobian = [&](double t, const double* y, double* J) {
    return jacobian_of(form, stretch, direction, t, y, J);
  };
  if constexpr (std::is_base_of_v<Coupled, Form>)
    system.event = [](double, const double* y) { return y[0] - smallest_pressure; };
  if constexpr (std::is_same_v<Form, Memory>)
    system.event = [&](double t, const double* y) {
      return form.distance_to_event(form.coefficients(stretch.nu(t), direction), direction, y);
    };
  return system;
}

}  // namespace grainlaw::model
