#include "grainlaw/dem/forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// This file is compiled once per target (AVX-512, AVX2, baseline), and the best one is taken when the program starts.
#include "grainlaw/dem/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/forces.cpp"
#include "hwy/foreach_target.h"  // NOLINT: includes this file again
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace grainlaw::dem::HWY_NAMESPACE {

#if HWY_MAX_BYTES >= 32 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

namespace hn = hwy::HWY_NAMESPACE;
using Four = hn::FixedTag<double, 4>;
using V = hn::Vec<Four>;
static_assert(PairList::group == 4);

HWY_INLINE V load(const Quad& q) { return hn::Load(Four(), &q.x); }
HWY_INLINE void store(V v, Quad& q) { hn::Store(v, Four(), &q.x); }

/// The first three columns of four rows.
struct Columns {
  V x, y, z;
};
HWY_INLINE Columns transpose(const V (&row)[4]) {
  const Four d;
  const V low01 = hn::InterleaveLower(d, row[0], row[1]), low23 = hn::InterleaveLower(d, row[2], row[3]);
  const V high01 = hn::InterleaveUpper(d, row[0], row[1]), high23 = hn::InterleaveUpper(d, row[2], row[3]);
  return {hn::ConcatLowerLower(d, low23, low01), hn::ConcatLowerLower(d, high23, high01),
          hn::ConcatUpperUpper(d, low23, low01)};
}

/// Four pairs at a time: their places and velocities are loaded grain by grain, transposed, and the forces added grain
/// by grain.
template <bool crossing>
void add_forces(const LinearContact& law, const PairList& list, const Grains& grains, const Vec3& rate,
                const Quad* shifts, Quad* force) {
  const Four d4;
  const Quad* const place = grains.place.data();
  const Quad* const motion = grains.motion.data();
  const V gx = hn::Set(d4, rate[0]), gy = hn::Set(d4, rate[1]), gz = hn::Set(d4, rate[2]);
  const LinearContact contact = law;
  for (std::size_t p = 0; p < list.pairs.size(); p += PairList::group) {
    const PairList::Pair* const pair = &list.pairs[p];
    V branch[4], velocity[4];
    for (std::size_t k = 0; k < 4; ++k) {
      branch[k] = hn::Sub(load(place[pair[k].i]), load(place[pair[k].j]));
      if constexpr (crossing) branch[k] = hn::Sub(branch[k], load(shifts[list.image[p + k]]));
      velocity[k] = hn::Sub(load(motion[pair[k].i]), load(motion[pair[k].j]));
    }
    const Columns l = transpose(branch), v = transpose(velocity);
    const V squared = hn::MulAdd(l.x, l.x, hn::MulAdd(l.y, l.y, hn::Mul(l.z, l.z)));
    const V distance = hn::Sqrt(squared), inverse = hn::Div(hn::Set(d4, 1.0), distance);
    const V parting = hn::MulAdd(l.x, hn::MulAdd(gx, l.x, v.x),
                                 hn::MulAdd(l.y, hn::MulAdd(gy, l.y, v.y), hn::Mul(l.z, hn::MulAdd(gz, l.z, v.z))));
    const V overlap = hn::Sub(hn::LoadU(d4, &list.reach[p]), distance);
    HWY_ALIGN double overlaps[4], closing[4], per_branch[4];
    hn::Store(overlap, d4, overlaps);
    hn::Store(hn::Neg(hn::Mul(parting, inverse)), d4, closing);
    for (std::size_t k = 0; k < 4; ++k) per_branch[k] = contact.force(overlaps[k], closing[k]);  // one vector
    // Zero where the grains do not touch, also where a pair that fills up the list gave 0/0.
    const V f = hn::IfThenElseZero(hn::Ge(overlap, hn::Zero(d4)), hn::Mul(hn::Load(d4, per_branch), inverse));
    hn::Store(f, d4, per_branch);
    for (std::size_t k = 0; k < 4; ++k) {
      const V on_i = hn::Mul(hn::Set(d4, per_branch[k]), branch[k]);
      store(hn::Add(load(force[pair[k].i]), on_i), force[pair[k].i]);
      store(hn::Sub(load(force[pair[k].j]), on_i), force[pair[k].j]);
    }
  }
}

#else

template <bool crossing>
void add_forces(const LinearContact& law, const PairList& list, const Grains& grains, const Vec3& rate,
                const Quad* shifts, Quad* force) {
  for (std::size_t p = 0; p < list.count; ++p) {
    const auto [i, j] = list.pairs[p];
    const Quad &a = grains.place[i], &b = grains.place[j], &va = grains.motion[i], &vb = grains.motion[j];
    Vec3 l{a.x - b.x, a.y - b.y, a.z - b.z};
    if constexpr (crossing) {
      const Quad& shift = shifts[list.image[p]];
      l = {l[0] - shift.x, l[1] - shift.y, l[2] - shift.z};
    }
    const double distance = norm(l), overlap = list.reach[p] - distance;
    if (!(overlap >= 0)) continue;
    const double inverse = 1 / distance;
    const double parting = l[0] * (va.x - vb.x + rate[0] * l[0]) + l[1] * (va.y - vb.y + rate[1] * l[1]) +
                           l[2] * (va.z - vb.z + rate[2] * l[2]);
    const double f = law.force(overlap, -parting * inverse) * inverse;
    force[i].x += f * l[0], force[i].y += f * l[1], force[i].z += f * l[2];
    force[j].x -= f * l[0], force[j].y -= f * l[1], force[j].z -= f * l[2];
  }
}

#endif

void add_all(const LinearContact& law, const Pairs& pairs, const Grains& grains, const Vec3& rate,
             const Quad* shifts, Quad* force) {
  add_forces<false>(law, pairs.within, grains, rate, shifts, force);
  add_forces<true>(law, pairs.crossing, grains, rate, shifts, force);
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(add_all);

void contact_forces(const LinearContact& law, const Pairs& pairs, const Box& box, Grains& grains) {
  const std::array<Quad, 27> shifts = box.shifts();
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  HWY_DYNAMIC_DISPATCH(add_all)(law, pairs, grains, box.rate(), shifts.data(), grains.force.data());
}

}  // namespace grainlaw::dem
#endif
