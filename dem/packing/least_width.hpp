// How narrow a periodic box may be.
#pragma once

namespace grainlaw::dem {

/// The least distance between faces of a box, mm: its largest grain, and the least skin of a list of
/// neighbours that is worth making. In a narrower one a grain would touch its own image.
inline double least_width(double largest_radius, double mean_radius) {
  return 2 * largest_radius + 0.02 * mean_radius;
}

}  // namespace grainlaw::dem
