// How often this test program has allocated.
#pragma once

namespace grainlaw::model {

long allocations();

}  // namespace grainlaw::model
