// What a leg takes whose work depends on how the grains fare: under stress control, at a steered rate, or in
// increments that are brought into balance. A part of it is run.
#pragma once

#include <optional>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// Whether the work of a stage is known only when the grains have run.
inline bool needs_trial(const Stage& stage) { return stage.leg.controlled() || stage.leg.minimises(); }

struct LegCost {
  double seconds = 0;          ///< of the whole leg, by the part that was run
  double least = 0, most = 0;  ///< s: between which it mostly lies; both `seconds` where all of it was run
  double passes = 0;           ///< over the contacts, likewise
  double bytes = 0;            ///< of a leg that minimises: held beside the grains while it does
  bool ended = false;          ///< whether all of it was run
};

/// What trial grains have in common with those of the scene.
enum class Likeness {
  density,  ///< not their stress: stress targets are taken to be what they start with, and the way to others
            ///< is left out
  all       ///< they are those that the leg begins with
};

/// How long a leg is tried, at most, unless one asks for more, in processor seconds.
constexpr double usual_trial(Likeness like) { return like == Likeness::all ? 4 : 0.5; }

/// Runs a stage for so many seconds, or as a whole if it takes no more. Of one that does not end, with p the
/// share that was done in n passes and N the passes that are planned,
///
///   passes = n + (1 - p) r,   r = (n + w N)/(p + w),   w = 0.1:
///
/// the plan counts as much as a tenth of the leg that was seen. The rest is off by a factor of exp(e),
/// mostly, with e^2 = (2 s)^2 + c^2/(p + w), s the standard error of the passes per share in eight equal
/// pieces of what was seen, c = 0.2; of grains that are only as dense, all of it by another 0.6. How these
/// numbers were found, and how often they held: docs/engine.md. None where a trial tells nothing: where the
/// grains come no way along in that time (in no increment, too), where a leg that only waits for stresses has
/// not ended, or one loses them, and where the grains bear none.
std::optional<LegCost> try_leg(const Material& material, const State& grains, const Stage& stage,
                               Likeness like, double budget);
/// Of the run's own grains, which it takes along.
std::optional<LegCost> try_leg(Dynamics& grains, const Stage& stage, double budget);

/// A trial of a leg after any look: the share that was done and the passes until then, both rising.
struct LegMark {
  double share = 0, passes = 0;
};

struct LegPasses {
  double all, least, most;
};

/// Passes of a whole leg of which `seen` was run and `planned` is the plan, by the equations above.
LegPasses passes_of(const std::vector<LegMark>& seen, double planned, Likeness like);

}  // namespace grainlaw::dem
