// A material point that carries the derivatives of its state with respect to parameters and start values
// along a path: across reversals, and across the loss of contact and back, whose place on the path depends on
// them too.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "grainlaw/model/integrator.hpp"
#include "grainlaw/model/law.hpp"
#include "grainlaw/model/status.hpp"

namespace grainlaw::model {

/// An Event and how it moves with the parameters.
struct SensitiveEvent {
  bool jammed;
  Slopes nu, eps_vol, eps_dev;
};

/// Walks as MaterialPoint does. Slope k of every number is its derivative with respect to variable k; the
/// values and the slopes are within the tolerance.
class SensitivePoint {
 public:
  /// `law` and `slopes_law` are the same law. `scales` are the natural sizes of the variables, > 0, at most
  /// most_slopes of them.
  SensitivePoint(Law law, BasicLaw<Slopes> slopes_law, const BasicState<Slopes>& start, Tolerance tolerance,
                 const std::vector<double>& scales, Method method = Method::bdf);

  const Law& law() const { return law_; }
  const BasicState<Slopes>& state() const { return state_; }

  using Visit = std::function<void(std::size_t, const BasicState<Slopes>&)>;
  /// As MaterialPoint::walk(). The strains themselves depend on no variable.
  Status walk(double eps_vol, double eps_dev, std::span<const double> samples, const Visit& visit);

  void relax() { state_.direction.q = 0; }

  const std::vector<SensitiveEvent>& events() const { return events_; }

 private:
  Law law_;
  BasicLaw<Slopes> slopes_law_;
  BasicState<Slopes> state_;
  std::size_t count_;
  std::optional<Integrator> integrator_;  // none where there is nothing to integrate
  std::vector<SensitiveEvent> events_;
};

}  // namespace grainlaw::model
