#include "grainlaw/dem/forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace grainlaw::dem {

namespace {

/// Force on a from b, divided by the branch vector (a - b); the branch is returned in d.
template <class Law>
inline double force_over_branch(const Law& law, const Vec3& rate, const Quad& a, const Quad& b,
                                const Quad& va, const Quad& vb, const Quad& shift, Quad& d) {
  d = {a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z, 0};
  const double squared = d.x * d.x + d.y * d.y + d.z * d.z, reach = a.w + b.w;
  if (squared > reach * reach) return 0;
  const double distance = std::sqrt(squared), inverse = 1 / distance;
  const double parting = d.x * (va.x - vb.x + rate[0] * d.x) + d.y * (va.y - vb.y + rate[1] * d.y) +
                         d.z * (va.z - vb.z + rate[2] * d.z);
  return law.force(reach - distance, -parting * inverse) * inverse;
}

}  // namespace

void contact_forces(const LinearContact& law, const Pairs& pairs, const Box& box, Grains& grains) {
  const Vec3 rate = box.rate();
  const Quad* const place = grains.place.data();
  const Quad* const motion = grains.motion.data();
  Quad* const force = grains.force.data();
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  Quad d;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Quad a = place[i], va = motion[i];
    Quad sum{};
    for (std::uint32_t p = pairs.begin[i]; p < pairs.begin[i + 1]; ++p) {
      const std::uint32_t j = pairs.partner[p];
      const double f = force_over_branch(law, rate, a, place[j], va, motion[j], Quad{}, d);
      if (f == 0) continue;
      sum.x += f * d.x, sum.y += f * d.y, sum.z += f * d.z;
      force[j].x -= f * d.x, force[j].y -= f * d.y, force[j].z -= f * d.z;
    }
    force[i].x += sum.x, force[i].y += sum.y, force[i].z += sum.z;
  }
  const std::array<Quad, 27> shifts = box.shifts();
  for (const auto& [i, j, image] : pairs.crossing) {
    const double f = force_over_branch(law, rate, place[i], place[j], motion[i], motion[j], shifts[image], d);
    force[i].x += f * d.x, force[i].y += f * d.y, force[i].z += f * d.z;
    force[j].x -= f * d.x, force[j].y -= f * d.y, force[j].z -= f * d.z;
  }
}

}  // namespace grainlaw::dem
