// Whether the boxes of a campaign stay wide enough for its grains.
#pragma once

#include "grainlaw/calibrate/campaign.hpp"

namespace grainlaw::calibrate {

/// Throws Error (file, tests[i].path.segments[k]) for the first test whose path makes the box too narrow for
/// its largest grain, or tilts it until its edges no longer hold it (see dem/drive/stage.hpp), of all tests
/// that no servo precedes: there the box is known. Of the others it is when their turn comes.
void check_boxes(const Campaign& campaign);

}  // namespace grainlaw::calibrate
