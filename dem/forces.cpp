#include "grainlaw/dem/forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "grainlaw/dem/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/forces.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

static_assert(PairList::group == 4);

/// Four pairs at a time: places and velocities are loaded grain by grain and transposed, forces are added
/// grain by grain. Without `tilted` the velocity gradient has a diagonal only.
template <bool crossing, bool tilted>
void add_forces(const LinearContact law, const PairList& list, const Mat3& gradient, const Quad* shifts,
                Grains& grains) {
  const Quad* const place = grains.place.data();
  const Quad* const motion = grains.motion.data();
  Quad* const force = grains.force.data();
  const Four gx = all(gradient(0, 0)), gy = all(gradient(1, 1)), gz = all(gradient(2, 2));
  // Along the branch only the symmetric part acts; gxy is xy and yx together.
  const Four gyz = all(gradient(1, 2) + gradient(2, 1)), gxz = all(gradient(0, 2) + gradient(2, 0)),
             gxy = all(gradient(0, 1) + gradient(1, 0)), zero = all(0), one = all(1);
  for (std::size_t p = 0; p < list.pairs.size(); p += PairList::group) {
    const PairList::Pair* const pair = &list.pairs[p];
    Four branch[4], velocity[4];
    for (std::size_t k = 0; k < 4; ++k) {
      branch[k] = load(place[pair[k].i]) - load(place[pair[k].j]);
      if constexpr (crossing) branch[k] = branch[k] - load(shifts[list.image[p + k]]);
      velocity[k] = load(motion[pair[k].i]) - load(motion[pair[k].j]);
    }
    Four x, y, z, u, v, w;
    transpose(branch, x, y, z);
    transpose(velocity, u, v, w);
    if constexpr (tilted) {
      u = mul_add(gxy, y, mul_add(gxz, z, u));
      v = mul_add(gyz, z, v);
    }
    const Four distance = root(mul_add(x, x, mul_add(y, y, z * z))), inverse = one / distance;
    const Four parting = mul_add(x, mul_add(gx, x, u), mul_add(y, mul_add(gy, y, v), z * mul_add(gz, z, w)));
    const Four overlap = load(&list.reach[p]) - distance;
    alignas(32) double overlaps[4], closing[4], strength[4];
    store(overlap, overlaps);
    store(zero - parting * inverse, closing);
    for (std::size_t k = 0; k < 4; ++k) strength[k] = law.force(overlaps[k], closing[k]);
    // Per branch vector; zero where grains do not touch, also where a pair that fills up the list gave 0/0.
    store(where_not_negative(overlap, load(strength) * inverse), strength);
    for (std::size_t k = 0; k < 4; ++k) {
      const Four f = all(strength[k]);
      store(mul_add(f, branch[k], load(force[pair[k].i])), force[pair[k].i]);
      store(mul_sub_from(f, branch[k], load(force[pair[k].j])), force[pair[k].j]);
    }
  }
}

template <bool tilted>
void add_to_both(const LinearContact& law, const Pairs& pairs, const Mat3& gradient, const Quad* shifts,
                 Grains& grains) {
  add_forces<false, tilted>(law, pairs.within, gradient, shifts, grains);
  add_forces<true, tilted>(law, pairs.crossing, gradient, shifts, grains);
}

void add_all_forces(const LinearContact& law, const Pairs& pairs, const Cell& cell, const Quad* shifts,
                    Grains& grains) {
  if (cell.tilted())
    add_to_both<true>(law, pairs, cell.gradient(), shifts, grains);
  else
    add_to_both<false>(law, pairs, cell.gradient(), shifts, grains);
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(add_all_forces);

void contact_forces(const LinearContact& law, const Pairs& pairs, const Cell& cell, Grains& grains) {
  const std::array<Quad, 27> shifts = cell.shifts();
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  HWY_DYNAMIC_DISPATCH(add_all_forces)(law, pairs, cell, shifts.data(), grains);
}

}  // namespace grainlaw::dem
#endif
