#include "grainlaw/dem/balance/contact_network.hpp"

#include <algorithm>

namespace grainlaw::dem {

void ContactNetwork::build(const ContactLaw& law, const Pairs& list, const Cell& cell, Grains& grains) {
  if (pairs.size() < list.count()) {
    pairs.resize(list.count());
    normal.resize(list.count());
    force.resize(list.count());
    stiffness.resize(list.count());
  }
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  count = 0;
  energy = largest_overlap = 0;
  for_each_contact(list, grains, cell, [&](const Contact& c) {
    const double f = law.force(c.overlap, 0), inverse = 1 / c.distance;
    const Quad n{c.branch[0] * inverse, c.branch[1] * inverse, c.branch[2] * inverse, c.distance};
    pairs[count] = {c.i, c.j};
    normal[count] = n;
    force[count] = f;
    stiffness[count] = law.stiffness(c.overlap);
    ++count;
    energy += law.energy(c.overlap);
    largest_overlap = std::max(largest_overlap, c.overlap);
    Quad &on_i = grains.force[c.i], &on_j = grains.force[c.j];
    on_i = {on_i.x + f * n.x, on_i.y + f * n.y, on_i.z + f * n.z, 0};
    on_j = {on_j.x - f * n.x, on_j.y - f * n.y, on_j.z - f * n.z, 0};
  });
}

}  // namespace grainlaw::dem
