// The force kernel: contact forces of all listed pairs. The one loop that the engine's speed depends on.
#pragma once

#include <cstddef>
#include <span>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/pairs.hpp"

namespace grainlaw::dem {

struct Share;

/// How many pairs the loops compute at a time.
std::size_t force_lanes();

/// Fills grains.force from grains.place and grains.motion (Eq. 2.1). The closing velocity of a contact is
/// that of the true motion: fluctuation plus the affine motion of the box over the branch.
void contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Grains& grains);
/// Adds them to what grains.force holds, which advance() leaves at zero.
void add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Grains& grains);
/// The same for the grains of a share, to the last bit. What it adds to the foreign ones among share.grains
/// means nothing. Meanwhile, where the grains lie in a cache, it takes memory that will be written soon into
/// this core's, out of others'.
void add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Share& share,
                        std::span<const std::span<std::byte>> written_soon = {});

}  // namespace grainlaw::dem
