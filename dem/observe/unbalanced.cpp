#include "grainlaw/dem/observe/unbalanced.hpp"

#include <cmath>

namespace grainlaw::dem::observe {

std::array<double, 1> Unbalanced::values(const View& view) const {
  std::vector<Vec3> net(view.grains().count());
  double sizes = 0;
  for (const Touch& c : view.network.contacts) {
    const double strength = c.force / c.distance;
    for (std::size_t k = 0; k < 3; ++k) {
      net[c.i][k] += strength * c.branch[k];
      net[c.j][k] -= strength * c.branch[k];
    }
    sizes += std::abs(c.force);
  }
  double sum = 0;
  std::uint64_t touching = 0;
  for (std::size_t i = 0; i < net.size(); ++i)
    if (view.network.contacts_of[i] > 0) {
      sum += norm(net[i]);
      ++touching;
    }
  if (!(sizes > 0)) return {undefined};
  return {sum / static_cast<double>(touching) * static_cast<double>(view.network.contacts.size()) / sizes};
}

}  // namespace grainlaw::dem::observe
