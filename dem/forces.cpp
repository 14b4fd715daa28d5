#include "grainlaw/dem/forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "grainlaw/dem/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/forces.cpp"
#include "hwy/cache_control.h"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

static_assert(GroupedPairs::width % lanes == 0 && CrossingPairs::width % lanes == 0);
constexpr std::size_t second = lanes - 4;  // from a grain to the one in the other half of its vector

/// What of the motion the force depends on: nothing where the law is not damped; else the grains' velocities,
/// and the box's gradient, which has a diagonal only or is full.
enum class Motion { none, straight, tilted };

/// Beyond so many grains they are in memory, not in a cache, and partners are fetched some groups ahead: a
/// third faster there, and a sixth slower where they are cached.
constexpr std::size_t most_cached = 100'000;
constexpr std::size_t fetched_ahead = 3;

/// What the loops need beside the grains.
struct Constants {
  ContactLaw law;
  Wide gx, gy, gz;     // the velocity gradient's diagonal
  Wide gyz, gxz, gxy;  // yz and zy together, ...: along the branch only the symmetric part acts
  Wide apart = wide_quad({1, 1, 1, -1});  // turns a difference of places into branch | r_i + r_j
};

/// Force over distance of as many pairs as there are lanes; zero where grains do not touch. Of a grain with
/// itself, which fills up a list, it is finite and the branch zero.
template <Motion of>
HWY_INLINE Wide strength_of(const Constants& c, const Wide (&branch)[4], const Wide (&velocity)[4]) {
  Wide x, y, z, reach;
  transpose(branch, x, y, z, reach);
  // Root and quotient do not wait for each other.
  const Wide squared = larger(wide(1e-60), mul_add(x, x, mul_add(y, y, z * z)));
  const Wide distance = root(squared), inverse = distance * (wide(1) / squared), overlap = reach - distance;
  alignas(64) double overlaps[lanes], closing[lanes]{}, forces[lanes];
  store(overlap, overlaps);
  if constexpr (of != Motion::none) {
    Wide u, v, w, unused;
    transpose(velocity, u, v, w, unused);
    if constexpr (of == Motion::tilted) {
      u = mul_add(c.gxy, y, mul_add(c.gxz, z, u));
      v = mul_add(c.gyz, z, v);
    }
    const Wide parting =
        mul_add(x, mul_add(c.gx, x, u), mul_add(y, mul_add(c.gy, y, v), z * mul_add(c.gz, z, w)));
    store(wide(0) - parting * inverse, closing);
  }
  for (std::size_t k = 0; k < lanes; ++k) forces[k] = c.law.force(overlaps[k], closing[k]);
  return where_not_negative(overlap, load_wide(forces) * inverse);
}

HWY_INLINE void add(Four part, Quad& to) { store(load(to) + part, to); }
HWY_INLINE void subtract(Four part, Quad& from) { store(load(from) - part, from); }

template <int k>
HWY_INLINE void act(Wide strength, const Wide (&branch)[4], Wide (&total)[4], const std::uint32_t* partner,
                    Quad* force) {
  const Wide f = spread_row<k>(strength) * branch[k];
  total[k] = total[k] + f;
  subtract(lower(f), force[partner[k]]);
  if constexpr (lanes == 8) subtract(upper(f), force[partner[k + second]]);
}

/// Fetches what the partners of a group need.
template <Motion of>
HWY_INLINE void fetch(const GroupedPairs::Group& group, const Groups& list, const Quad* place,
                      const Quad* motion, Quad* force) {
  for (std::uint32_t p = group.first; p < group.last; ++p) {
    const std::uint32_t j = list.partner[p];
    hwy::Prefetch(place + j);
    if constexpr (of != Motion::none) hwy::Prefetch(motion + j);
    hwy::Prefetch(force + j);
  }
}

/// Each group of grains stays in registers, places, velocities and forces, while it meets its partners.
template <Motion of, bool far>
void add_forces_within(const Constants& constants, const Quad* place, const Quad* motion, const Groups& list,
                       Quad* force) {
  for (std::size_t g = 0; g < list.groups.size(); ++g) {
    const GroupedPairs::Group& group = list.groups[g];
    if constexpr (far)
      fetch<of>(list.groups[std::min(g + fetched_ahead, list.groups.size() - 1)], list, place, motion, force);
    for (std::size_t half = 0; half < GroupedPairs::width; half += lanes) {
      const std::uint32_t* const grain = &group.grain[half];
      Wide place_i[4], motion_i[4], total[4];
      for (std::size_t k = 0; k < 4; ++k) {
        place_i[k] = rows(place[grain[k]], place[grain[k + second]]);
        if constexpr (of != Motion::none) motion_i[k] = rows(motion[grain[k]], motion[grain[k + second]]);
        total[k] = wide(0);
      }
      const std::uint32_t* const end = list.partner + group.last;
      for (const std::uint32_t* j = list.partner + group.first + half; j < end; j += GroupedPairs::width) {
        Wide branch[4], velocity[4];
        for (std::size_t k = 0; k < 4; ++k) {
          branch[k] = mul_sub_from(constants.apart, rows(place[j[k]], place[j[k + second]]), place_i[k]);
          if constexpr (of != Motion::none)
            velocity[k] = motion_i[k] - rows(motion[j[k]], motion[j[k + second]]);
        }
        const Wide strength = strength_of<of>(constants, branch, velocity);
        act<0>(strength, branch, total, j, force);
        act<1>(strength, branch, total, j, force);
        act<2>(strength, branch, total, j, force);
        act<3>(strength, branch, total, j, force);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        add(lower(total[k]), force[grain[k]]);
        if constexpr (lanes == 8) add(upper(total[k]), force[grain[k + second]]);
      }
    }
  }
}

template <int k>
HWY_INLINE void act_on_both(Wide strength, const Wide (&branch)[4], const CrossingPairs::Pair* pair,
                            Quad* force) {
  const Wide f = spread_row<k>(strength) * branch[k];
  add(lower(f), force[pair[k].i]);
  subtract(lower(f), force[pair[k].j]);
  if constexpr (lanes == 8) {
    add(upper(f), force[pair[k + second].i]);
    subtract(upper(f), force[pair[k + second].j]);
  }
}

template <Motion of>
void add_forces_across(const Constants& constants, const Quad* place, const Quad* motion,
                       const CrossingPairs& list, const Quad* shifts, Quad* force) {
  for (std::size_t p = 0; p < list.pairs.size(); p += lanes) {
    const CrossingPairs::Pair* const pair = &list.pairs[p];
    Wide branch[4], velocity[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const CrossingPairs::Pair &a = pair[k], &b = pair[k + second];
      branch[k] = mul_sub_from(constants.apart, rows(place[a.j], place[b.j]), rows(place[a.i], place[b.i])) -
                  rows(shifts[a.image], shifts[b.image]);
      if constexpr (of != Motion::none)
        velocity[k] = rows(motion[a.i], motion[b.i]) - rows(motion[a.j], motion[b.j]);
    }
    const Wide strength = strength_of<of>(constants, branch, velocity);
    act_on_both<0>(strength, branch, pair, force);
    act_on_both<1>(strength, branch, pair, force);
    act_on_both<2>(strength, branch, pair, force);
    act_on_both<3>(strength, branch, pair, force);
  }
}

template <Motion of>
void add_to_each(const ContactLaw& law, const Grains& grains, const Mat3& gradient, const Groups& within,
                 const CrossingPairs& crossing, const Quad* shifts, Quad* force) {
  const auto both = [&](std::size_t a, std::size_t b) { return wide(gradient(a, b) + gradient(b, a)); };
  const Constants constants{
      law,       wide(gradient(0, 0)), wide(gradient(1, 1)), wide(gradient(2, 2)), both(1, 2), both(0, 2),
      both(0, 1)};
  const Quad* const place = grains.place.data();
  const Quad* const motion = grains.motion.data();
  if (grains.count() > most_cached)
    add_forces_within<of, true>(constants, place, motion, within, force);
  else
    add_forces_within<of, false>(constants, place, motion, within, force);
  add_forces_across<of>(constants, place, motion, crossing, shifts, force);
}

void add_forces(const ContactLaw& law, const Grains& grains, const Cell& cell, const Groups& within,
                const CrossingPairs& crossing, const Quad* shifts, Quad* force) {
  const auto add = cell.tilted() ? add_to_each<Motion::tilted> : add_to_each<Motion::straight>;
  (law.damped() ? add : add_to_each<Motion::none>)(law, grains, cell.gradient(), within, crossing, shifts,
                                                   force);
}

std::size_t lanes_here() { return lanes; }

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(add_forces);
HWY_EXPORT(lanes_here);

std::size_t force_lanes() { return HWY_DYNAMIC_DISPATCH(lanes_here)(); }

void contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Grains& grains) {
  const std::array<Quad, 27> shifts = cell.shifts();
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  HWY_DYNAMIC_DISPATCH(add_forces)
  (law, grains, cell, {pairs.within.groups, pairs.within.partner.data()}, pairs.crossing, shifts.data(),
   grains.force.data());
}

void contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Share& share,
                    Grains& grains) {
  const std::array<Quad, 27> shifts = cell.shifts();
  const auto begin = share.force.begin() + share.first, end = share.force.begin() + share.last;
  std::fill(begin, end, Quad{});
  const auto add = [&](const Groups& within, const CrossingPairs& crossing) {
    HWY_DYNAMIC_DISPATCH(add_forces)
    (law, grains, cell, within, crossing, shifts.data(), share.force.data());
  };
  add({}, share.halo);
  const std::span<const GroupedPairs::Group> groups = pairs.within.groups;
  add({groups.subspan(share.first_group, share.last_group - share.first_group), pairs.within.partner.data()},
      share.crossing);
  std::copy(begin, end, grains.force.begin() + share.first);
}

}  // namespace grainlaw::dem
#endif
