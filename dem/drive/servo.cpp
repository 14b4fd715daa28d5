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
/// Of central springs that move affinely: longitudinal over bulk modulus.
constexpr double longitudinal = 9.0 / 5.0;

double stress_of(const Servo::Target& target, const Glance& seen) {
  return target ? seen.stress[*target] : (seen.stress[0] + seen.stress[1] + seen.stress[2]) / 3;
}

}  // namespace

Servo::Servo(const Material& material, const Control& control)
    : control_(control),
      stress_unit_(material.stress_unit()),
      response_(response_over_contact * material.contact_duration(material.r_mean)) {
  if (control.mean) targets_.emplace_back(std::nullopt);
  for (std::size_t c = 0; c < 3; ++c)
    if (control.by_stress(c)) targets_.emplace_back(c);
}

ServoState Servo::start(const Glance& seen) const {
  ServoState state;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const StressTarget& wanted =
        targets_[i] ? std::get<StressTarget>(control_.axis[*targets_[i]]) : *control_.mean;
    state.reached[i] = stress_of(targets_[i], seen);
    state.target[i] = wanted.stress ? *wanted.stress * stress_unit_ : state.reached[i];
  }
  return state;
}

double Servo::error(const ServoState& state, std::size_t target) const {
  if (!(state.target[target] > 0)) return -std::numeric_limits<double>::infinity();
  return state.reached[target] / state.target[target] - 1;
}

std::size_t Servo::worst(const ServoState& state) const {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < targets_.size(); ++i)
    if (std::abs(error(state, i)) > std::abs(error(state, worst))) worst = i;
  return worst;
}

bool Servo::possible(const ServoState& state) const {
  return targets_.empty() || std::isfinite(error(state, worst(state)));
}

bool Servo::within_tolerance(const ServoState& state) const {
  return targets_.empty() || std::abs(error(state, worst(state))) <= control_.servo.tolerance;
}

void Servo::look(ServoState& state, const Glance& seen, double elapsed, double driven) const {
  if (targets_.empty()) return;
  const double granted = driven * state.throttle;
  for (std::size_t i = 0; i < targets_.size(); ++i) state.reached[i] = stress_of(targets_[i], seen);
  const double off = std::abs(error(state, worst(state))) / control_.servo.tolerance;
  state.throttle = std::clamp(2 - 2 * off, 0.0, 1.0);
  state.off = off > 1 ? state.off + elapsed : 0;
  state.on = off > 1 ? 0 : state.on + elapsed;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const double stiffness =
        std::max((targets_[i] ? longitudinal : 3.0) * seen.bulk, least_stiffness * stress_unit_);
    const double missing = (state.target[i] - state.reached[i]) / stiffness;  // as a strain
    const double wanted = missing / response_ + state.follow[i] * driven * state.throttle;
    state.rate[i] = std::clamp(wanted, -control_.servo.rate, control_.servo.rate);
    // Critically damped. Nothing is learnt at the limit, nor while the driven axes wait.
    if (state.rate[i] == wanted && granted > 0)
      state.follow[i] += missing * elapsed / (4 * response_ * response_ * granted);
  }
}

Vec3 Servo::rates(const ServoState& state) const {
  Vec3 rates{};
  for (std::size_t i = 0; i < targets_.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      if (!targets_[i] || *targets_[i] == c) rates[c] += state.rate[i];
  return rates;
}

}  // namespace grainlaw::dem
