#include "grainlaw/dem/advance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "grainlaw/dem/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/advance.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

double advance_grains(const Stride& stride, const ListReach& list, Grains& grains) {
  const double dt = stride.dt;
  // The fluctuation of a step is carried along by half of its deformation.
  const Vec3 path{dt * std::sqrt(stride.stretch[0]), dt * std::sqrt(stride.stretch[1]),
                  dt * std::sqrt(stride.stretch[2])};
  // The last of the four: radius in place, 1/mass in acceleration, 0 in the velocities, unused in force.
  const Four step = first_three({dt, dt, dt}, 0), half_step = first_three({0.5 * dt, 0.5 * dt, 0.5 * dt}, 0);
  const Four stretch = first_three(stride.stretch, 1), carry = first_three(path, 0);
  const Four rate = first_three(stride.rate, 0), damping = all(stride.gamma_b);
  const Four since_list = first_three(list.stretch, 0), zero = all(0);
  Four excess = all(-1), places = all(0);
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Four before = load(grains.acceleration[i]), inverse_mass = spread_last(before);
    const Four seen = load(grains.motion[i]);
    const Four now =
        mul_sub_from(mul_add(damping, inverse_mass, rate), seen, load(grains.force[i]) * inverse_mass);
    const Four v = mul_add(step, now, load(grains.half[i]));
    const Four x = mul_add(carry, v, stretch * load(grains.place[i]));
    places = places + x;
    store(v, grains.half[i]);
    store(x, grains.place[i]);
    store(mul_sub_from(half_step, before, mul_add(step, now, v)), grains.motion[i]);
    store(with_last(now, before), grains.acceleration[i]);
    const Four reference = load(list.reference[i]), strayed = mul_sub_from(since_list, reference, x);
    excess = larger(excess, sum(with_last(strayed * strayed, zero - reference)));
  }
  // Max drops what is not a number; a sum keeps it.
  alignas(32) double result[4];
  store(mul_add(zero, sum(places), excess), result);
  return result[0];
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(advance_grains);

double advance(const Stride& stride, const ListReach& list, Grains& grains) {
  return HWY_DYNAMIC_DISPATCH(advance_grains)(stride, list, grains);
}

}  // namespace grainlaw::dem
#endif
