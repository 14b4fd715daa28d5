#include "grainlaw/dem/measure.hpp"

#include <limits>

namespace grainlaw::dem {

namespace {

/// sum += factor a (x) b, the symmetric part, for parallel a and b all of it.
void add(Sym6& sum, double factor, const Vec3& a) {
  sum[0] += factor * a[0] * a[0];
  sum[1] += factor * a[1] * a[1];
  sum[2] += factor * a[2] * a[2];
  sum[3] += factor * a[1] * a[2];
  sum[4] += factor * a[0] * a[2];
  sum[5] += factor * a[0] * a[1];
}

void scale(Sym6& q, double factor) {
  for (double& component : q) component *= factor;
}

double kinetic_energy(const Grains& grains, const std::vector<Quad>& velocity, std::size_t i) {
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

double closing_speed(const Contact& c, const std::vector<Quad>& velocity, const Cell& cell) {
  const Quad &a = velocity[c.i], &b = velocity[c.j];
  const Vec3 flow = cell.affine_velocity(c.branch);
  const Vec3 relative{a.x - b.x + flow[0], a.y - b.y + flow[1], a.z - b.z + flow[2]};
  return -dot(c.branch, relative) / c.distance;
}

Sym6 static_stress(const LinearContact& law, const Grains& grains, const std::vector<Quad>& velocity,
                   const Cell& cell, const Pairs& pairs) {
  Sym6 stress{};
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    add(stress, law.force(c.overlap, closing_speed(c, velocity, cell)) / c.distance, c.branch);
  });
  scale(stress, 1 / cell.volume());
  return stress;
}

Energies energies(const LinearContact& law, const Grains& grains, const std::vector<Quad>& velocity,
                  const Cell& cell, const Pairs& pairs) {
  Energies e;
  for (std::size_t i = 0; i < grains.count(); ++i) e.kinetic += kinetic_energy(grains, velocity, i);
  for_each_contact(pairs, grains, cell, [&](const Contact& c) { e.elastic += law.energy(c.overlap); });
  return e;
}

Measurement measure(const LinearContact& law, const Grains& grains, const std::vector<Quad>& velocity,
                    const Cell& cell, const Pairs& pairs) {
  Measurement m;
  std::vector<std::uint32_t> contacts_of(grains.count(), 0);
  double solid = 0;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    solid += sphere_volume(grains.place[i].w);
    m.kinetic += kinetic_energy(grains, velocity, i);
    add(m.kinetic_stress, 1 / grains.acceleration[i].w, {velocity[i].x, velocity[i].y, velocity[i].z});
  }
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    ++contacts_of[c.i];
    ++contacts_of[c.j];
    ++m.contacts;
    add(m.stress, law.force(c.overlap, closing_speed(c, velocity, cell)) / c.distance, c.branch);
    const double volumes = sphere_volume(grains.place[c.i].w) + sphere_volume(grains.place[c.j].w);
    add(m.fabric, volumes / (c.distance * c.distance), c.branch);
    m.elastic += law.energy(c.overlap);
  });
  const double per_volume = 1 / cell.volume();
  m.nu = solid * per_volume;
  scale(m.stress, per_volume);
  scale(m.kinetic_stress, per_volume);
  scale(m.fabric, per_volume);
  count_contacts(contacts_of, m);
  return m;
}

}  // namespace grainlaw::dem
