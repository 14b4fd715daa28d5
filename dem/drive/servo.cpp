#include "grainlaw/dem/drive/servo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::dem {

namespace {

/// Response time over the contact duration of two mean grains: slower than grains answer to a strain of their
/// box, which takes them a few contact durations.
constexpr double response_over_contact = 5;
/// Least stiffness that the gain is made for, over k*: grains that hardly touch have none.
constexpr double least_stiffness = 0.05;
/// Least pressure that a shear stress is held against, over k*: below, contacts are rounding.
constexpr double least_pressure = 1e-12;
/// Stiffness over the bulk modulus K = (1/9V) sum k l^2, of central springs that move affinely and point
/// everywhere alike: C_ijkl = (1/V) sum k l^2 <n_i n_j n_k n_l> = 9K <n_i n_j n_k n_l>, with <n_x^4> = 1/5
/// and <n_x^2 n_y^2> = 1/15. The mean stress answers to the same strain of all axes with 3K, a normal stress
/// to that of its axis with C_xxxx, a shear stress to a component eps_xy of the tensor with 2 C_xyxy = 2G.
constexpr double isotropic = 3, longitudinal = 9.0 / 5.0, shear = 6.0 / 5.0;

double stiffness_over_bulk(const Servo::Target& target) {
  if (!target) return isotropic;
  return Servo::is_shear(target) ? shear : longitudinal;
}

double mean_stress(const Glance& seen) { return trace(seen.stress) / 3; }

double stress_of(const Servo::Target& target, const Glance& seen) {
  return target ? seen.stress[*target] : mean_stress(seen);
}

}  // namespace

Servo::Servo(const Material& material, const Control& control)
    : control_(control),
      stress_unit_(material.stress_unit()),
      response_(response_over_contact * material.contact_duration(material.r_mean)) {
  if (control.mean) targets_.emplace_back(std::nullopt);
  for (std::size_t c = 0; c < control.component.size(); ++c)
    if (control.by_stress(c)) targets_.emplace_back(c);
}

ServoState Servo::start(const Glance& seen) const {
  ServoState state;
  state.P = mean_stress(seen);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const StressTarget& wanted =
        targets_[i] ? std::get<StressTarget>(control_.component[*targets_[i]]) : *control_.mean;
    state.reached[i] = stress_of(targets_[i], seen);
    state.target[i] = wanted.stress ? *wanted.stress * stress_unit_ : state.reached[i];
  }
  return state;
}

double Servo::error(const ServoState& state, std::size_t target) const {
  const double wanted = state.target[target], reached = state.reached[target];
  if (is_shear(targets_[target]))
    return (reached - wanted) / std::max({state.P, std::abs(wanted), least_pressure * stress_unit_});
  return wanted > 0 ? reached / wanted - 1 : -std::numeric_limits<double>::infinity();
}

std::size_t Servo::worst(const ServoState& state) const {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < targets_.size(); ++i)
    if (std::abs(error(state, i)) > std::abs(error(state, worst))) worst = i;
  return worst;
}

bool Servo::possible(const ServoState& state) const {
  for (std::size_t i = 0; i < targets_.size(); ++i)
    if (!is_shear(targets_[i]) && !(state.target[i] > 0)) return false;
  return true;
}

bool Servo::within_tolerance(const ServoState& state) const {
  return targets_.empty() || std::abs(error(state, worst(state))) <= control_.servo.tolerance;
}

void Servo::look(ServoState& state, const Glance& seen, double elapsed, double driven) const {
  if (targets_.empty()) return;
  const double granted = driven * state.throttle;
  state.P = mean_stress(seen);
  for (std::size_t i = 0; i < targets_.size(); ++i) state.reached[i] = stress_of(targets_[i], seen);
  const double off = std::abs(error(state, worst(state))) / control_.servo.tolerance;
  state.throttle = std::clamp(2 - 2 * off, 0.0, 1.0);
  state.off = off > 1 ? state.off + elapsed : 0;
  state.on = off > 1 ? 0 : state.on + elapsed;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const double stiffness =
        std::max(stiffness_over_bulk(targets_[i]) * seen.bulk, least_stiffness * stress_unit_);
    const double missing = (state.target[i] - state.reached[i]) / stiffness;  // as a strain
    const double wanted = missing / response_ + state.follow[i] * driven * state.throttle;
    state.rate[i] = std::clamp(wanted, -control_.servo.rate, control_.servo.rate);
    // Critically damped. Nothing is learnt at the limit, nor while the driven components wait.
    if (state.rate[i] == wanted && granted > 0)
      state.follow[i] += missing * elapsed / (4 * response_ * response_ * granted);
  }
}

Sym6 Servo::rates(const ServoState& state) const {
  Sym6 rates{};
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (targets_[i])
      rates[*targets_[i]] += state.rate[i];
    else
      for (std::size_t c = 0; c < 3; ++c) rates[c] += state.rate[i];
  }
  return rates;
}

}  // namespace grainlaw::dem
