// A material point: a law, its state, and the integrator that walks it along stretches of strain, through
// loss of contact and back. The integrator is kept and re-initialised for every stretch.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/status.hpp"
#include "grainlaw/model/walk/integrator.hpp"
#include "grainlaw/model/walk/walk.hpp"

namespace grainlaw::model {

class MaterialPoint {
 public:
  /// An unjammed start has P = sigma_dev = F_dev = 0.
  MaterialPoint(Law law, const State& start, Tolerance tolerance, Method method = Method::bdf);

  const Law& law() const { return law_; }
  const State& state() const { return state_; }

  /// Called with the index of a sample and the state there.
  using Visit = std::function<void(std::size_t, const State&)>;

  /// Walks a straight stretch of strain (eps_vol = change of ln nu, eps_dev signed; both may be 0) to its
  /// end, visiting the states at the fractions `samples` (ascending, in [0, 1]). On failure the state is as
  /// before the call.
  Status walk(double eps_vol, double eps_dev, std::span<const double> samples, const Visit& visit);
  Status walk(double eps_vol, double eps_dev) { return walk(eps_vol, eps_dev, {}, {}); }

  /// A rest: the next shear begins a new direction (S_I and S_F,I are taken anew).
  void relax() { state_.direction.q = 0; }

  const std::vector<Event>& events() const { return events_; }
  void note(const Event& event) { events_.push_back(event); }

  /// Goes on from another state, as one that was kept, or that another way of walking came to.
  void set_state(const State& state) { state_ = state; }

 private:
  Law law_;
  State state_;
  std::optional<Integrator> integrator_;  // none where there is nothing to integrate
  std::vector<Event> events_;
};

}  // namespace grainlaw::model
