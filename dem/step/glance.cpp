#include "grainlaw/dem/step/glance.hpp"

#include "grainlaw/dem/numbers/dyad.hpp"
#include "grainlaw/dem/step/measure.hpp"

namespace grainlaw::dem {

namespace {

template <Stresses which>
Glance seen_of(const ContactLaw& law, const Grains& grains, const Cell& cell, const Pairs& pairs) {
  Glance seen;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Quad& v = grains.motion[i];
    seen.kinetic += 0.5 / grains.acceleration[i].w * (v.x * v.x + v.y * v.y + v.z * v.z);
  }
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    const double force = law.force(c.overlap, closing_speed(c, grains.motion, cell)) / c.distance;
    if constexpr (which == Stresses::all)
      add_dyad(seen.stress, force, c.branch);
    else
      for (std::size_t k = 0; k < 3; ++k) seen.stress[k] += force * c.branch[k] * c.branch[k];
    seen.bulk += law.stiffness(c.overlap) * c.distance * c.distance;
    seen.elastic += law.energy(c.overlap);
    ++seen.contacts;
  });
  for (double& component : seen.stress) component /= cell.volume();
  seen.bulk /= 9 * cell.volume();
  return seen;
}

}  // namespace

Glance glance(const ContactLaw& law, const Grains& grains, const Cell& cell, const Pairs& pairs,
              Stresses which) {
  return which == Stresses::all ? seen_of<Stresses::all>(law, grains, cell, pairs)
                                : seen_of<Stresses::normal>(law, grains, cell, pairs);
}

}  // namespace grainlaw::dem
