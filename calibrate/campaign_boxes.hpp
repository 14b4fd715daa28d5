// Whether the boxes of a campaign stay wide enough for its grains.
#pragma once

#include "grainlaw/calibrate/campaign.hpp"

namespace grainlaw::calibrate {

/// Throws Error (file, tests[i].path.segments[k]) for the first test whose path makes the box too narrow for
/// its largest grain, or tilts it until its edges no longer hold it (see dem/drive/stage.hpp), of all tests
/// that are known to begin in a cube: those of a new packing, and those that start where isotropic strains
/// have led. Of the others this is known when their turn comes.
void check_boxes(const Campaign& campaign);

}  // namespace grainlaw::calibrate
