// An initial value problem solved by CVODES (variable order BDF or Adams, analytic Jacobian, dense solver),
// with sensitivities of its solution where asked, which stops exactly where it is told and where an event
// function crosses zero. One object is kept and re-initialised for every stretch.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

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

/// Linear multistep formulas: BDF (orders 1 to 5, for stiff stretches) or Adams (1 to 12); both corrected by
/// Newton's method.
enum class Method { bdf, adams };
std::string name_of(Method method);
/// Throws Error listing the names.
Method method_of(const std::string& name);

/// dy/dt = rate(t, y). Functions return false where they are not defined; a smaller step is then tried. They
/// must be smooth on the stretch that is integrated and stay so a little beyond an event.
struct System {
  std::function<bool(double t, const double* y, double* dydt)> rate;
  std::function<bool(double t, const double* y, double* J)> jacobian;  ///< J[i + size j] = d rate_i/d y_j
  using Event = std::function<double(double t, const double* y)>;
  Event event;                ///< stop where it crosses zero; may be empty
  std::vector<Event> others;  ///< stop where one of these does, too
  /// ds/dt of the sensitivities s[i + size k] = dy_i/dp_k, J s_k + d rate/dp_k; only where they are asked
  /// for.
  std::function<bool(double t, const double* y, const double* s, double* dsdt)> sensitivity_rate;
};

class Integrator {
 public:
  /// `size` variables, and their sensitivities to as many parameters as there are `scales`, the parameters'
  /// natural sizes (> 0): scale dy/dp is held to the same tolerances as y. Throws Error for a tolerance or
  /// scale that is not > 0.
  Integrator(int size, Tolerance tolerance, Method method = Method::bdf,
             const std::vector<double>& scales = {});
  ~Integrator();
  Integrator(Integrator&&) noexcept;
  Integrator& operator=(Integrator&&) noexcept;

  /// Begins at t with y, and with the sensitivities s (s[i + size k]) if it has any. `end` is never passed.
  /// `system` must outlive the calls of advance().
  Status start(const System& system, double t, double end, const double* y, const double* s = nullptr);

  struct Arrival {
    Status status;       ///< ok, or failed with CVODE's reason
    double t = 0;        ///< where y belongs: `to`, or the event
    bool event = false;  ///< an event came first
    /// Which: the place in `others`, or their number for `event` itself.
    std::size_t which = 0;
  };
  /// Goes on to t = `to` <= end; y and s receive the solution there, or are left alone on failure.
  Arrival advance(double to, double* y, double* s = nullptr);

  long steps() const;  ///< taken since start()

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace grainlaw::model
