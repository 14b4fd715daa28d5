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

Measurement measure(const LinearContact& law, const Grains& grains, const std::vector<Quad>& velocity,
                    const Cell& cell, const Pairs& pairs) {
  Measurement m;
  std::vector<std::uint32_t> contacts_of(grains.count(), 0);
  double solid = 0;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const double mass = 1 / grains.acceleration[i].w;
    const Vec3 v{velocity[i].x, velocity[i].y, velocity[i].z};
    solid += sphere_volume(grains.place[i].w);
    m.kinetic += 0.5 * mass * dot(v, v);
    add(m.kinetic_stress, mass, v);
  }
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    ++contacts_of[c.i];
    ++contacts_of[c.j];
    ++m.contacts;
    const Quad &a = velocity[c.i], &b = velocity[c.j];
    const Vec3 flow = cell.affine_velocity(c.branch);
    const Vec3 relative{a.x - b.x + flow[0], a.y - b.y + flow[1], a.z - b.z + flow[2]};
    const double closing = -dot(c.branch, relative) / c.distance;
    add(m.stress, law.force(c.overlap, closing) / c.distance, c.branch);
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
