#include "grainlaw/dem/step/measure.hpp"

#include <limits>

#include "grainlaw/dem/numbers/dyad.hpp"

namespace grainlaw::dem {

namespace {

double kinetic_energy(const Grains& grains, const Quads& velocity, std::size_t i) {
  const Vec3 v{velocity[i].x, velocity[i].y, velocity[i].z};
  return 0.5 / grains.acceleration[i].w * dot(v, v);
}

void count_contacts(const std::vector<std::uint32_t>& contacts_of, Measurement& m) {
  const double grains = static_cast<double>(contacts_of.size());
  std::uint64_t bearing = 0, held = 0;  // N4, M4
  for (const std::uint32_t c : contacts_of)
    if (c >= 4) {
      ++bearing;
      held += c;
    }
  m.C = static_cast<double>(held) / grains;
  m.C_star = bearing > 0 ? static_cast<double>(held) / static_cast<double>(bearing)
                         : std::numeric_limits<double>::quiet_NaN();
  m.f_NR = static_cast<double>(bearing) / grains;
  m.C_r = 2 * static_cast<double>(m.contacts) / grains;
}

}  // namespace

double closing_speed(const Contact& c, const Quads& velocity, const Cell& cell) {
  const Quad &a = velocity[c.i], &b = velocity[c.j];
  const Vec3 flow = cell.affine_velocity(c.branch);
  const Vec3 relative{a.x - b.x + flow[0], a.y - b.y + flow[1], a.z - b.z + flow[2]};
  return -dot(c.branch, relative) / c.distance;
}

Sym6 static_stress(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                   const Pairs& pairs) {
  Sym6 stress{};
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    add_dyad(stress, law.force(c.overlap, closing_speed(c, velocity, cell)) / c.distance, c.branch);
  });
  stress = times(1 / cell.volume(), stress);
  return stress;
}

Energies energies(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                  const Pairs& pairs) {
  Energies e;
  for (std::size_t i = 0; i < grains.count(); ++i) e.kinetic += kinetic_energy(grains, velocity, i);
  for_each_contact(pairs, grains, cell, [&](const Contact& c) { e.elastic += law.energy(c.overlap); });
  return e;
}

Measurement measure(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                    const Pairs& pairs) {
  Measurement m;
  std::vector<std::uint32_t> contacts_of(grains.count(), 0);
  double solid = 0;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    solid += sphere_volume(grains.place[i].w);
    m.kinetic += kinetic_energy(grains, velocity, i);
    add_dyad(m.kinetic_stress, 1 / grains.acceleration[i].w, {velocity[i].x, velocity[i].y, velocity[i].z});
  }
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    ++contacts_of[c.i];
    ++contacts_of[c.j];
    ++m.contacts;
    add_dyad(m.stress, law.force(c.overlap, closing_speed(c, velocity, cell)) / c.distance, c.branch);
    const double volumes = sphere_volume(grains.place[c.i].w) + sphere_volume(grains.place[c.j].w);
    add_dyad(m.fabric, volumes / (c.distance * c.distance), c.branch);
    m.elastic += law.energy(c.overlap);
  });
  const double per_volume = 1 / cell.volume();
  m.nu = solid * per_volume;
  m.stress = times(per_volume, m.stress);
  m.kinetic_stress = times(per_volume, m.kinetic_stress);
  m.fabric = times(per_volume, m.fabric);
  count_contacts(contacts_of, m);
  return m;
}

}  // namespace grainlaw::dem
