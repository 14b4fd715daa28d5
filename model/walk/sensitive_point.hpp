// A material point that carries the derivatives of its state with respect to parameters and start values
// along a path: across reversals, and across the loss of contact and back, whose place on the path depends on
// them too.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/status.hpp"
#include "grainlaw/model/walk/integrator.hpp"

namespace grainlaw::model {

/// An Event and how it moves with the parameters.
template <class S>
struct BasicSensitiveEvent {
  bool jammed;
  S nu, eps_vol, eps_dev;
};
using SensitiveEvent = BasicSensitiveEvent<Slopes>;

/// Walks as MaterialPoint does. S is Slopes or FewSlopes; slope k of every number is its derivative with
/// respect to variable k; the values and the slopes are within the tolerance.
template <class S>
class SensitivePoint {
 public:
  /// `law` and `slopes_law` are the same law. `scales` are the natural sizes of the variables, > 0, at most
  /// as many as S has.
  SensitivePoint(Law law, BasicLaw<S> slopes_law, const BasicState<S>& start, Tolerance tolerance,
                 const std::vector<double>& scales, Method method = Method::bdf);

  const Law& law() const { return law_; }
  const BasicState<S>& state() const { return state_; }

  using Visit = std::function<void(std::size_t, const BasicState<S>&)>;
  /// As MaterialPoint::walk(). The strains themselves depend on no variable.
  Status walk(double eps_vol, double eps_dev, std::span<const double> samples, const Visit& visit);

  void relax() { state_.direction.q = 0; }

  const std::vector<BasicSensitiveEvent<S>>& events() const { return events_; }

 private:
  Law law_;
  BasicLaw<S> slopes_law_;
  BasicState<S> state_;
  std::size_t count_;
  double rtol_;
  std::optional<Integrator> integrator_, plain_;  // none where there is nothing to integrate; of values alone
  std::vector<BasicSensitiveEvent<S>> events_;
};

}  // namespace grainlaw::model
