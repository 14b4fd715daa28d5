#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

Network Network::gather(const Dynamics& dynamics, const Quads& velocity) {
  Network network;
  network.contacts_of.assign(dynamics.count(), 0);
  const Pairs& pairs = dynamics.neighbours().pairs();
  network.contacts.reserve(pairs.count());
  double forces = 0, overlaps = 0;
  for_each_contact(pairs, dynamics.grains(), dynamics.cell(), [&](const Contact& c) {
    const double closing = closing_speed(c, velocity, dynamics.cell());
    const double force = dynamics.law().force(c.overlap, closing);
    network.contacts.push_back({c.i, c.j, c.branch, c.distance, c.overlap, force});
    ++network.contacts_of[c.i];
    ++network.contacts_of[c.j];
    forces += force;
    overlaps += c.overlap;
  });
  if (network.contacts.empty()) return network;
  const double count = static_cast<double>(network.contacts.size());
  network.mean_force = forces / count;
  network.mean_overlap = overlaps / count;
  return network;
}

}  // namespace grainlaw::dem::observe
