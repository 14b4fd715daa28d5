#include "grainlaw/dem/step/measure.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grainlaw/dem/numbers/dyad.hpp"

namespace grainlaw::dem {

namespace {

using Contacts = std::span<const Contact>;

double solid_volume(const Grains& grains) {
  double sum = 0;
  for (std::size_t i = 0; i < grains.count(); ++i) sum += sphere_volume(grains.place[i].w);
  return sum;
}

/// sum m v (x) v.
Sym6 flow_of_momentum(const Grains& grains, const Quads& velocity) {
  Sym6 sum{};
  for (std::size_t i = 0; i < grains.count(); ++i)
    add_dyad(sum, 1 / grains.acceleration[i].w, {velocity[i].x, velocity[i].y, velocity[i].z});
  return sum;
}

void count_contacts(const std::vector<std::uint32_t>& contacts_of, Measurement& m) {
  const double grains = static_cast<double>(contacts_of.size());
  std::uint64_t all = 0, bearing = 0, held = 0;  // M, N4, M4
  for (const std::uint32_t c : contacts_of) {
    all += c;
    if (c < 4) continue;
    ++bearing;
    held += c;
  }
  m.contacts = static_cast<double>(all / 2);
  m.C = static_cast<double>(held) / grains;
  if (bearing > 0) m.C_star = static_cast<double>(held) / static_cast<double>(bearing);
  m.f_NR = static_cast<double>(bearing) / grains;
}

/// Calls f for all contacts, some hundred at a time and in their order: a loop over one quantity keeps its
/// sum in registers, and what is not wanted is asked once a block.
template <class F>
void for_blocks_of_contacts(const Pairs& pairs, const Grains& grains, const Cell& cell, F&& f) {
  std::array<Contact, 256> block;
  std::size_t filled = 0;
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    block[filled++] = c;
    if (filled < block.size()) return;
    f(Contacts(block));
    filled = 0;
  });
  f(Contacts(block.data(), filled));
}

void add_stress(const ContactLaw& law, const Quads& velocity, const Cell& cell, Contacts contacts,
                Sym6& stress) {
  Sym6 sum = stress;
  for (const Contact& c : contacts)
    add_dyad(sum, law.force(c.overlap, closing_speed(c, velocity, cell)) / c.distance, c.branch);
  stress = sum;
}

void add_fabric(const Grains& grains, Contacts contacts, Sym6& fabric) {
  Sym6 sum = fabric;
  for (const Contact& c : contacts) {
    const double volumes = sphere_volume(grains.place[c.i].w) + sphere_volume(grains.place[c.j].w);
    add_dyad(sum, volumes / (c.distance * c.distance), c.branch);
  }
  fabric = sum;
}

/// What is wanted of the contacts, in one walk through them.
void measure_contacts(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                      const Pairs& pairs, const Wanted& wanted, Measurement& m) {
  std::vector<std::uint32_t> contacts_of(wanted.coordination ? grains.count() : 0, 0);
  Sym6 stress{}, fabric{};
  double elastic = 0;
  for_blocks_of_contacts(pairs, grains, cell, [&](Contacts contacts) {
    if (wanted.stress) add_stress(law, velocity, cell, contacts, stress);
    if (wanted.fabric) add_fabric(grains, contacts, fabric);
    if (wanted.coordination)
      for (const Contact& c : contacts) ++contacts_of[c.i], ++contacts_of[c.j];
    if (wanted.energies)
      for (const Contact& c : contacts) elastic += law.energy(c.overlap);
  });
  const double per_volume = 1 / cell.volume();
  if (wanted.stress) m.stress = times(per_volume, stress);
  if (wanted.fabric) m.fabric = times(per_volume, fabric);
  if (wanted.coordination) count_contacts(contacts_of, m);
  if (wanted.energies) m.elastic = elastic;
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
  e.kinetic = kinetic_energy(grains, velocity);
  for_each_contact(pairs, grains, cell, [&](const Contact& c) { e.elastic += law.energy(c.overlap); });
  return e;
}

double kinetic_energy(const Grains& grains, const Quads& velocity) {
  double sum = 0;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Vec3 v{velocity[i].x, velocity[i].y, velocity[i].z};
    sum += 0.5 / grains.acceleration[i].w * dot(v, v);
  }
  return sum;
}

Measurement measure(const ContactLaw& law, const Grains& grains, const Quads& velocity, const Cell& cell,
                    const Pairs& pairs, const Wanted& wanted) {
  Measurement m;
  const double per_volume = 1 / cell.volume();
  m.nu = solid_volume(grains) * per_volume;
  if (wanted.kinetic_stress) m.kinetic_stress = times(per_volume, flow_of_momentum(grains, velocity));
  if (wanted.energies) m.kinetic = kinetic_energy(grains, velocity);
  if (wanted.of_contacts()) measure_contacts(law, grains, velocity, cell, pairs, wanted, m);
  return m;
}

}  // namespace grainlaw::dem
