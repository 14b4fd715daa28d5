#include "grainlaw/dem/packing/state.hpp"

#include <numbers>

namespace grainlaw::dem {

double State::volume_fraction() const {
  double cubes = 0;
  for (const double r : radius) cubes += r * r * r;
  return 4.0 / 3.0 * std::numbers::pi * cubes / determinant(box);
}

}  // namespace grainlaw::dem
