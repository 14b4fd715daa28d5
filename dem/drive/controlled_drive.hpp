// Follows a leg whose strain is not known in advance: under stress control, or at a rate that is steered by
// E_k/E_p. Its box is strained step by step, and it ends by how far it is, not by the time.
#pragma once

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/drive/servo.hpp"

namespace grainlaw::dem {

/// Every so many steps the stress and the energies are looked at.
constexpr std::uint64_t look_interval = 10;
/// A steered rate stays within these factors of the segment's.
constexpr double slowest_steered = 1.0 / 30, fastest_steered = 10;

/// Follows a controlled leg from where `state` says it is, until it is done or state.control.lost.
void follow_controlled(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
                       const AfterStep& after_step);

/// Where a leg stopped because a stress could not be reached: which, the target and what there was.
std::string why_lost(const Material& material, const Leg& leg, const LegState& state);

}  // namespace grainlaw::dem
