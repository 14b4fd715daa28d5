// Displacements of a packing's grains that no contact resists, counted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "grainlaw/dem/balance/static_packing.hpp"

namespace grainlaw::dem {

struct FloppyModes {
  /// Independent displacements of the backbone, beyond the three translations of the whole, that stretch or
  /// compress no contact. Under load they are unstable; without load (grains that just touch) the packing is
  /// soft along them.
  std::size_t count = 0;
  bool at_least = false;  ///< counting ended at most_modes
  std::uint64_t iterations = 0;
};

struct FloppyOptions {
  std::size_t most_modes = 400;
  /// A displacement counts as floppy whose stiffness, per size squared, is below this share of a contact's.
  double softest = 1e-9;
  std::uint64_t most_iterations = 100'000;
};

/// Of the contacts at the last find_contacts(); rattlers are left out. Random displacements, six at a time,
/// lose by conjugate gradients all that the springs of the network (without its prestress) can resist; what
/// is left lies among the floppy modes. It goes on until six in a row lead to nothing new: the count is that
/// of the modes softer than `softest`, with a chance to miss one that can be neglected ((1e-3)^6). Grains
/// that hang together without touching the rest count three translations more. Throws Error where
/// most_iterations do not suffice.
FloppyModes floppy_modes(const StaticPacking& packing, const FloppyOptions& options = {});

}  // namespace grainlaw::dem
