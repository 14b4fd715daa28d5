// A minimiser that was tried and is slower than those of the engine: non-linear conjugate gradients (Polak
// and Ribiere, restarted where beta < 0), preconditioned by each grain's own stiffness.
#pragma once

#include "grainlaw/dem/balance/minimise.hpp"

namespace grainlaw::dem {

MinimiseResult minimise_by_conjugate_gradients(StaticPacking& packing, const MinimiseOptions& options);

}  // namespace grainlaw::dem
