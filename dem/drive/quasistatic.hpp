// Takes grains along a leg from one balance to the next, athermal and overdamped. Between rearrangements
// these are the states of a slow flow; beyond them they need not be.
#pragma once

#include "grainlaw/dem/drive/drive.hpp"

namespace grainlaw::dem {

/// Increments of equal strain, none of which strains any component by more than leg.increment; as many for
/// each of `rows` rows. A relaxation is one increment without strain. `dt` is a share of the leg, not of
/// time.
StepPlan plan_increments(const Leg& leg, std::uint64_t rows);

/// Follows a leg that minimises, from where `state` says it is: each step deforms box and grains affinely by
/// one increment and minimises the elastic energy (see dem/balance/minimise.hpp). No time passes, and grains
/// are at rest after each step. state.passes tells the work of a step. Throws Error where the energy cannot
/// be minimised to leg.residual, unless rounding is in the way. Where `stop` turns true in the midst of an
/// increment, the leg is left before that increment.
void follow_quasistatic(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
                        const AfterStep& after_step, const std::atomic<bool>* stop = nullptr);

}  // namespace grainlaw::dem
