// What a leg takes whose work depends on how the grains fare: under stress control, at a steered rate, or in
// increments that are brought into balance. A part of it is run.
#pragma once

#include <optional>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Whether the work of a stage is known only when the grains have run.
inline bool needs_trial(const Stage& stage) { return stage.leg.controlled() || stage.leg.minimises(); }

struct LegCost {
  double seconds = 0;  ///< of the whole leg, by the part that was run
  double passes = 0;   ///< over the contacts, likewise
  double bytes = 0;    ///< of a leg that minimises: held beside the grains while it does
};

/// What trial grains have in common with those of the scene.
enum class Likeness {
  density,  ///< not their stress: stress targets are taken to be what they start with, and the way to others
            ///< is left out
  all       ///< they are those that the leg begins with
};

/// Runs a stage that needs it for half a second, or, from the grains that it begins with, as a whole if it
/// takes no more than 1.5 seconds: how a leg begins is not what it is like. None where that tells nothing:
/// where more time is needed (for an increment, too), where the leg only waits for stresses, and where the
/// grains bear none.
std::optional<LegCost> try_leg(const Material& material, const State& grains, const Stage& stage,
                               Likeness like);

}  // namespace grainlaw::dem
