#include "grainlaw/dem/packing/size_distribution.hpp"

namespace grainlaw::dem {

std::vector<double> draw_radii(const Material& material, std::size_t count, Random& random) {
  const double low = material.r_min(), width = material.r_max() - low;
  std::vector<double> radii(count);
  for (std::size_t i = 0; i < count; ++i)
    radii[i] = low + width * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
  random.shuffle(radii);
  return radii;
}

}  // namespace grainlaw::dem
