// A packing and its force chains as a VTK PolyData file (VTP), for ParaView.
#pragma once

#include <string>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// The text of a VTP file. Points are the grains, wrapped into the box, with their fields; lines are the
/// contacts (docs/commands.md lists both). Forces are the elastic ones, k delta: the viscous part needs the
/// rate of the box, which a frame does not hold. A contact that meets through a face of the box is two lines,
/// each from a grain to the middle of the overlap, so that nothing crosses the box; the ends are points of
/// radius 0 after the grains.
///
/// The pressure of a grain is sum_c f a_c/(3 V_p) over k*, with a_c = r - delta/2 its share of the branch:
/// the sum of V_p times pressure over all grains is V P, with the P of a record.
std::string vtp_text(const Frame& frame, const Material& material);

}  // namespace grainlaw::dem
