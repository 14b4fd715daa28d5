// An initial value problem solved by CVODE (variable order BDF, analytic Jacobian, dense solver), which stops
// exactly where it is told and where an event function crosses zero. One object is kept and re-initialised
// for every stretch.
#pragma once

#include <functional>
#include <memory>

#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

/// Asked errors of the solution along a path: rtol relative to its size (L2 over the path), atol where it is
/// smaller.
struct Tolerance {
  double rtol = 1e-8;
  double atol = 1e-12;
};
/// Throws Error for a tolerance that is not > 0 and finite.
void check(Tolerance tolerance);

/// dy/dt = rate(t, y). Functions return false where they are not defined; a smaller step is then tried. They
/// must be smooth on the stretch that is integrated and stay so a little beyond an event.
struct System {
  std::function<bool(double t, const double* y, double* dydt)> rate;
  std::function<bool(double t, const double* y, double* J)> jacobian;  ///< J[i + size j] = d rate_i/d y_j
  std::function<double(double t, const double* y)> event;  ///< stop where it crosses zero; may be empty
};

class Integrator {
 public:
  /// `size` variables. Throws Error for a tolerance that is not > 0.
  Integrator(int size, Tolerance tolerance);
  ~Integrator();
  Integrator(Integrator&&) noexcept;
  Integrator& operator=(Integrator&&) noexcept;

  /// Begins at t with y. `end` is never passed. `system` must outlive the calls of advance().
  Status start(const System& system, double t, double end, const double* y);

  struct Arrival {
    Status status;       ///< ok, or failed with CVODE's reason
    double t = 0;        ///< where y belongs: `to`, or the event
    bool event = false;  ///< an event came first
  };
  /// Goes on to t = `to` <= end; y receives the solution there, or is left alone on failure.
  Arrival advance(double to, double* y);

  long steps() const;  ///< taken since start()

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace grainlaw::model
