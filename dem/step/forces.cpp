#include "grainlaw/dem/step/forces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>
#include <vector>

#include "grainlaw/dem/numbers/simd_targets.hpp"
#include "grainlaw/dem/step/shares.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/step/forces.cpp"
#include "hwy/cache_control.h"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/numbers/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

namespace of_vectors {
using grainlaw::dem::root;  // of numbers; that of vectors is found by its argument
#include "grainlaw/element/contact_law-inl.hpp"
}  // namespace of_vectors

static_assert(GroupedPairs::width % lanes == 0 && CrossingPairs::width % lanes == 0 &&
              HaloPairs::width % lanes == 0);
constexpr std::size_t second = lanes - 4;  // from a grain to the one in the other half of its vector

/// What of the motion the force depends on: nothing where the law is not damped; else the grains' velocities,
/// and the box's gradient, which has a diagonal only or is full.
enum class Motion { none, straight, tilted };

/// Beyond so many grains they are in memory, not in a cache, and partners are fetched ahead: forces in less
/// than half the time there.
constexpr std::size_t most_cached = 100'000;

/// What the loops need beside the grains.
struct Constants {
  of_vectors::ContactLaw law;
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
  Wide closing = wide(0);
  if constexpr (of != Motion::none) {
    Wide u, v, w, unused;
    transpose(velocity, u, v, w, unused);
    if constexpr (of == Motion::tilted) {
      u = mul_add(c.gxy, y, mul_add(c.gxz, z, u));
      v = mul_add(c.gyz, z, v);
    }
    const Wide parting =
        mul_add(x, mul_add(c.gx, x, u), mul_add(y, mul_add(c.gy, y, v), z * mul_add(c.gz, z, w)));
    closing = wide(0) - parting * inverse;
  }
  return where_not_negative(overlap, c.law.force(overlap, closing) * inverse);
}

HWY_INLINE void add(Four part, Quad& to) { store(load(to) + part, to); }
HWY_INLINE void subtract(Four part, Quad& from) { store(load(from) - part, from); }

/// A row of pairs, as many as there are lanes.
struct Row {
  Wide branch[4];
  Wide strength;
};

template <int k>
HWY_INLINE void act_of(const Row& row, Wide (&total)[4], const std::uint32_t* partner, Quad* force) {
  const Wide f = spread<k>(row.strength) * row.branch[k];
  total[k] = total[k] + f;
  subtract(lower(f), force[partner[k]]);
  if constexpr (lanes == 8) subtract(upper(f), force[partner[k + second]]);
}

/// Takes the forces of a row from its partners and adds them to the total on the grains that it belongs to.
HWY_INLINE void act(const Row& row, Wide (&total)[4], const std::uint32_t* partner, Quad* force) {
  act_of<0>(row, total, partner, force);
  act_of<1>(row, total, partner, force);
  act_of<2>(row, total, partner, force);
  act_of<3>(row, total, partner, force);
}

/// Hands the totals over to their grains.
HWY_INLINE void add_and_clear(Wide (&total)[4], const std::uint32_t* grain, Quad* force) {
  for (std::size_t k = 0; k < 4; ++k) {
    add(lower(total[k]), force[grain[k]]);
    if constexpr (lanes == 8) add(upper(total[k]), force[grain[k + second]]);
    total[k] = wide(0);
  }
}

/// The partners of a run of grains lie at most so far on in the order of the grains: what lies before has
/// been used, and what lies at this edge is fetched some runs ahead, in step with the groups.
class Frontier {
 public:
  template <Motion of>
  HWY_INLINE void fetch(const GroupedPairs::Group& group, const Groups& list, const Quad* place,
                        const Quad* motion, const Quad* force) {
    const std::size_t run = group.grain[0] / GroupedPairs::block;
    const std::size_t edge = (run + 1) * GroupedPairs::block + list.reach,
                      goal = std::min(list.grains, edge + ahead);
    fetched_ = std::max(fetched_, std::min(edge, goal));
    for (std::size_t n = 0; n < at_once && fetched_ < goal;
         ++n, fetched_ += 2) {  // two lie in a line of the cache
      hwy::Prefetch(place + fetched_);
      if constexpr (of != Motion::none) hwy::Prefetch(motion + fetched_);
      hwy::Prefetch(force + fetched_);
    }
  }

 private:
  static constexpr std::size_t ahead = 4 * GroupedPairs::block, at_once = 6;
  std::size_t fetched_ = 0;
};

/// Takes a line of the cache from all other cores, to write into it. What compilers make of a prefetch for
/// writing only reads, on most targets; where a processor does not know this one, it does nothing.
HWY_INLINE void fetch_to_write(std::uintptr_t line) {
  const auto* const byte = reinterpret_cast<const std::byte*>(line);
#if HWY_ARCH_X86
  asm volatile("prefetchw %0" : : "m"(*byte));
#else
  __builtin_prefetch(byte, 1);
#endif
}

/// Memory to write into later on, some lines of it with each group: all at once would hold up the loop.
class WrittenSoon {
 public:
  WrittenSoon(std::span<const std::span<std::byte>> parts, std::size_t groups) : parts_(parts) {
    std::size_t lines = 0;
    for (const std::span<std::byte> part : parts) lines += part.size() / line + 2;
    at_once_ = lines / groups + 1;
    begin_part();
  }
  template <Motion>
  HWY_INLINE void fetch(const GroupedPairs::Group&, const Groups&, const Quad*, const Quad*, const Quad*) {
    for (std::size_t n = 0; n < at_once_ && !parts_.empty(); ++n) {
      fetch_to_write(at_);
      at_ += line;
      if (at_ < end_) continue;
      parts_ = parts_.subspan(1);
      begin_part();
    }
  }

 private:
  static constexpr std::size_t line = 64;
  void begin_part() {
    if (parts_.empty()) return;
    const auto begin = reinterpret_cast<std::uintptr_t>(parts_.front().data());
    at_ = begin / line * line, end_ = begin + parts_.front().size();
  }

  std::span<const std::span<std::byte>> parts_;
  std::uintptr_t at_ = 0, end_ = 0;  ///< of the first part
  std::size_t at_once_;
};

struct NothingAhead {
  template <Motion>
  HWY_INLINE void fetch(const GroupedPairs::Group&, const Groups&, const Quad*, const Quad*, const Quad*) {}
};

/// Each group of grains stays in registers, places, velocities and forces, while it meets its partners. A row
/// of pairs acts only after the next one is computed: what waits for a root then has something to do beside
/// it.
template <Motion of, class Ahead>
void add_forces_within(const Constants& constants, const Quad* place, const Quad* motion, const Groups& list,
                       Ahead ahead, Quad* force) {
  if (list.groups.empty()) return;
  Row row{{wide(0), wide(0), wide(0), wide(0)}, wide(0)};  // nothing acts on the first grains yet
  Wide total[4] = {wide(0), wide(0), wide(0), wide(0)};
  const std::uint32_t *grain = list.groups[0].grain.data(), *partner = grain;
  for (std::size_t g = 0; g < list.groups.size(); ++g) {
    const GroupedPairs::Group& group = list.groups[g];
    ahead.template fetch<of>(group, list, place, motion, force);
    for (std::size_t half = 0; half < GroupedPairs::width; half += lanes) {
      const std::uint32_t* const own = &group.grain[half];
      Wide place_i[4], motion_i[4];
      for (std::size_t k = 0; k < 4; ++k) {
        place_i[k] = rows(place[own[k]], place[own[k + second]]);
        if constexpr (of != Motion::none) motion_i[k] = rows(motion[own[k]], motion[own[k + second]]);
      }
      const auto compute = [&](const std::uint32_t* j) HWY_ATTR {
        Row next;
        Wide velocity[4];
        for (std::size_t k = 0; k < 4; ++k) {
          next.branch[k] = mul_sub_from(constants.apart, rows(place[j[k]], place[j[k + second]]), place_i[k]);
          if constexpr (of != Motion::none)
            velocity[k] = motion_i[k] - rows(motion[j[k]], motion[j[k + second]]);
        }
        next.strength = strength_of<of>(constants, next.branch, velocity);
        return next;
      };
      const std::uint32_t *j = list.partner + group.first + half, *const end = list.partner + group.last;
      Row next = compute(j);
      act(row, total, partner, force);
      add_and_clear(total, grain, force);
      grain = own;
      for (;;) {
        row = next;
        partner = j;
        j += GroupedPairs::width;
        if (j >= end) break;
        next = compute(j);
        act(row, total, partner, force);
      }
    }
  }
  act(row, total, partner, force);
  add_and_clear(total, grain, force);
}

/// Pairs through faces meet by an image and act on both grains; of those of a halo the second one is wanted.
template <class Pair>
constexpr bool crosses = std::is_same_v<Pair, CrossingPairs::Pair>;

template <int k, class Pair>
HWY_INLINE void act_on_pairs_of(const Row& row, const Pair* pair, Quad* force) {
  const Wide f = spread<k>(row.strength) * row.branch[k];
  if constexpr (crosses<Pair>) add(lower(f), force[pair[k].i]);
  subtract(lower(f), force[pair[k].j]);
  if constexpr (lanes == 8) {
    if constexpr (crosses<Pair>) add(upper(f), force[pair[k + second].i]);
    subtract(upper(f), force[pair[k + second].j]);
  }
}

template <class Pair>
HWY_INLINE void act_on_pairs(const Row& row, const Pair* pair, Quad* force) {
  act_on_pairs_of<0>(row, pair, force);
  act_on_pairs_of<1>(row, pair, force);
  act_on_pairs_of<2>(row, pair, force);
  act_on_pairs_of<3>(row, pair, force);
}

/// The forces of pairs that stand one by one, as many to a row as there are lanes.
template <Motion of, class Pair>
void add_forces_of_pairs(const Constants& constants, const Quad* place, const Quad* motion,
                         const std::vector<Pair>& pairs, const Quad* shifts, Quad* force) {
  if (pairs.empty()) return;
  const auto compute = [&](const Pair* pair) HWY_ATTR {
    Row row;
    Wide velocity[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const Pair &a = pair[k], &b = pair[k + second];
      row.branch[k] =
          mul_sub_from(constants.apart, rows(place[a.j], place[b.j]), rows(place[a.i], place[b.i]));
      if constexpr (crosses<Pair>) row.branch[k] = row.branch[k] - rows(shifts[a.image], shifts[b.image]);
      if constexpr (of != Motion::none)
        velocity[k] = rows(motion[a.i], motion[b.i]) - rows(motion[a.j], motion[b.j]);
    }
    row.strength = strength_of<of>(constants, row.branch, velocity);
    return row;
  };
  const Pair *pair = pairs.data(), *const end = pair + pairs.size();
  for (Row row = compute(pair);;) {
    const Pair* const next = pair + lanes;
    if (next == end) return act_on_pairs(row, pair, force);
    const Row computed = compute(next);
    act_on_pairs(row, pair, force);
    row = computed;
    pair = next;
  }
}

template <Motion of>
void add_to_each(const ContactLaw& law, const Grains& grains, const Mat3& gradient, const HaloPairs& halo,
                 const Groups& within, const CrossingPairs& crossing, const Quad* shifts,
                 std::span<const std::span<std::byte>> written_soon, Quad* force) {
  const auto both = [&](std::size_t a, std::size_t b) { return wide(gradient(a, b) + gradient(b, a)); };
  const Constants constants{std::bit_cast<of_vectors::ContactLaw>(law),
                            wide(gradient(0, 0)),
                            wide(gradient(1, 1)),
                            wide(gradient(2, 2)),
                            both(1, 2),
                            both(0, 2),
                            both(0, 1)};
  const Quad* const place = grains.place.data();
  const Quad* const motion = grains.motion.data();
  add_forces_of_pairs<of>(constants, place, motion, halo.pairs, shifts, force);
  if (grains.count() > most_cached)
    add_forces_within<of>(constants, place, motion, within, Frontier{}, force);
  else if (written_soon.empty() || within.groups.empty())
    add_forces_within<of>(constants, place, motion, within, NothingAhead{}, force);
  else
    add_forces_within<of>(constants, place, motion, within, WrittenSoon(written_soon, within.groups.size()),
                          force);
  add_forces_of_pairs<of>(constants, place, motion, crossing.pairs, shifts, force);
}

void add_forces(const ContactLaw& law, const Grains& grains, const Cell& cell, const HaloPairs& halo,
                const Groups& within, const CrossingPairs& crossing, const Quad* shifts,
                std::span<const std::span<std::byte>> written_soon, Quad* force) {
  const auto add = cell.tilted() ? add_to_each<Motion::tilted> : add_to_each<Motion::straight>;
  (law.damped() ? add : add_to_each<Motion::none>)(law, grains, cell.gradient(), halo, within, crossing,
                                                   shifts, written_soon, force);
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
  std::fill(grains.force.begin(), grains.force.end(), Quad{});
  add_contact_forces(law, pairs, cell, grains);
}

void add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Grains& grains) {
  const std::array<Quad, 27> shifts = cell.shifts();
  HWY_DYNAMIC_DISPATCH(add_forces)
  (law, grains, cell, {},
   {pairs.within.groups, pairs.within.partner.data(), grains.count(), pairs.within.reach}, pairs.crossing,
   shifts.data(), {}, grains.force.data());
}

void add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell, Share& share,
                        std::span<const std::span<std::byte>> written_soon) {
  const std::array<Quad, 27> shifts = cell.shifts();
  const std::span<const GroupedPairs::Group> groups = pairs.within.groups;
  HWY_DYNAMIC_DISPATCH(add_forces)
  (law, share.grains, cell, share.halo,
   {groups.subspan(share.first_group, share.last_group - share.first_group), pairs.within.partner.data(),
    share.grains.count(), pairs.within.reach},
   share.crossing, shifts.data(), written_soon, share.grains.force.data());
}

}  // namespace grainlaw::dem
#endif
