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

/// A matrix that takes the fourth number to zero; without `tilted`, the diagonal of one.
template <bool tilted>
class Matrix;

template <>
class Matrix<false> {
 public:
  explicit Matrix(const Mat3& a) : diagonal_(first_three(a.diagonal(), 0)) {}
  HWY_INLINE Four times_plus(Four x, Four y) const { return mul_add(diagonal_, x, y); }           ///< A x + y
  HWY_INLINE Four times_sub_from(Four x, Four y) const { return mul_sub_from(diagonal_, x, y); }  ///< y - A x

 private:
  Four diagonal_;
};

template <>
class Matrix<true> {
 public:
  explicit Matrix(const Mat3& a)
      : x_(first_three(a.column(0), 0)), y_(first_three(a.column(1), 0)), z_(first_three(a.column(2), 0)) {}
  HWY_INLINE Four times_plus(Four x, Four y) const {
    return mul_add(z_, spread<2>(x), mul_add(y_, spread<1>(x), mul_add(x_, spread<0>(x), y)));
  }
  HWY_INLINE Four times_sub_from(Four x, Four y) const {
    return mul_sub_from(z_, spread<2>(x), mul_sub_from(y_, spread<1>(x), mul_sub_from(x_, spread<0>(x), y)));
  }

 private:
  Four x_, y_, z_;  // columns
};

/// The same root where nothing is tilted, without iterations.
Mat3 root_of(const Mat3& f, bool tilted) {
  if (tilted) return square_root(f);
  return Mat3::diagonal({std::sqrt(f(0, 0)), std::sqrt(f(1, 1)), std::sqrt(f(2, 2))});
}

template <bool tilted>
double advance_each(const Stride& stride, const ListReach& list, std::size_t first, std::size_t last,
                    Grains& grains) {
  const double dt = stride.dt;
  // The last of the four: radius in place, 1/mass in acceleration, 0 in the velocities, unused in force.
  const Four step = first_three({dt, dt, dt}, 0), half_step = first_three({0.5 * dt, 0.5 * dt, 0.5 * dt}, 0);
  const Four stretch = first_three(stride.deformation.diagonal(), 1), damping = all(stride.gamma_b);
  const Four rate = first_three(stride.gradient.diagonal(), 0), zero = all(0);
  const Matrix<tilted> deformation(stride.deformation), gradient(stride.gradient);
  // The fluctuation of a step is carried along by half of its deformation.
  const Matrix<tilted> carry(dt * root_of(stride.deformation, tilted)), since_list(list.deformation);
  Four excess = all(-1), places = all(0);
  for (std::size_t i = first; i < last; ++i) {
    const Four before = load(grains.acceleration[i]), inverse_mass = spread<3>(before);
    const Four seen = load(grains.motion[i]);
    const Four from_force = load(grains.force[i]) * inverse_mass, place = load(grains.place[i]);
    Four now, carried;
    if constexpr (tilted) {
      now = gradient.times_sub_from(seen, mul_sub_from(damping * inverse_mass, seen, from_force));
      carried = with_last(deformation.times_plus(place, zero), place);
    } else {
      now = mul_sub_from(mul_add(damping, inverse_mass, rate), seen, from_force);
      carried = stretch * place;
    }
    const Four v = mul_add(step, now, load(grains.half[i]));
    const Four x = carry.times_plus(v, carried);
    places = places + x;
    store(v, grains.half[i]);
    store(x, grains.place[i]);
    store(mul_sub_from(half_step, before, mul_add(step, now, v)), grains.motion[i]);
    store(with_last(now, before), grains.acceleration[i]);
    const Four reference = load(list.reference[i]), strayed = since_list.times_sub_from(reference, x);
    excess = larger(excess, sum(with_last(strayed * strayed, zero - reference)));
  }
  // Max drops what is not a number; a sum keeps it.
  alignas(32) double result[4];
  store(mul_add(zero, sum(places), excess), result);
  return result[0];
}

double advance_grains(const Stride& stride, const ListReach& list, std::size_t first, std::size_t last,
                      Grains& grains) {
  return stride.tilted ? advance_each<true>(stride, list, first, last, grains)
                       : advance_each<false>(stride, list, first, last, grains);
}

}  // namespace grainlaw::dem::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace grainlaw::dem {

HWY_EXPORT(advance_grains);

double advance(const Stride& stride, const ListReach& list, Grains& grains) {
  return advance(stride, list, 0, grains.count(), grains);
}

double advance(const Stride& stride, const ListReach& list, std::size_t first, std::size_t last,
               Grains& grains) {
  return HWY_DYNAMIC_DISPATCH(advance_grains)(stride, list, first, last, grains);
}

}  // namespace grainlaw::dem
#endif
