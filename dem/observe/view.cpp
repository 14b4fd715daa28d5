#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

void Network::gather(const Dynamics& dynamics, const Quads& velocity) {
  mean_force = mean_overlap = undefined;
  contacts.clear();
  contacts_of.assign(dynamics.count(), 0);
  const Pairs& pairs = dynamics.neighbours().pairs();
  contacts.reserve(pairs.count());
  double forces = 0, overlaps = 0;
  for_each_contact(pairs, dynamics.grains(), dynamics.cell(), [&](const Contact& c) {
    const double closing = closing_speed(c, velocity, dynamics.cell());
    const double force = dynamics.law().force(c.overlap, closing);
    contacts.push_back({c.i, c.j, c.branch, c.distance, c.overlap, force});
    ++contacts_of[c.i];
    ++contacts_of[c.j];
    forces += force;
    overlaps += c.overlap;
  });
  if (contacts.empty()) return;
  const double count = static_cast<double>(contacts.size());
  mean_force = forces / count;
  mean_overlap = overlaps / count;
}

}  // namespace grainlaw::dem::observe
