#include "grainlaw/dem/step/advance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "grainlaw/dem/numbers/simd_targets.hpp"
// Compiled once per instruction set; the best one that the machine has is taken at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grainlaw/dem/step/advance.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
#include "grainlaw/dem/numbers/four-inl.hpp"

namespace grainlaw::dem::HWY_NAMESPACE {

/// A matrix that takes the fourth number of each four to zero; without `tilted`, the diagonal of one.
template <class V, bool tilted>
class Matrix;

template <class V>
class Matrix<V, false> {
 public:
  explicit Matrix(const Mat3& a) : diagonal_(first_three<V>(a.diagonal(), 0)) {}
  HWY_INLINE V times_plus(V x, V y) const { return mul_add(diagonal_, x, y); }           ///< A x + y
  HWY_INLINE V times_sub_from(V x, V y) const { return mul_sub_from(diagonal_, x, y); }  ///< y - A x

 private:
  V diagonal_;
};

template <class V>
class Matrix<V, true> {
 public:
  explicit Matrix(const Mat3& a)
      : x_(first_three<V>(a.column(0), 0)),
        y_(first_three<V>(a.column(1), 0)),
        z_(first_three<V>(a.column(2), 0)) {}
  HWY_INLINE V times_plus(V x, V y) const {
    return mul_add(z_, spread<2>(x), mul_add(y_, spread<1>(x), mul_add(x_, spread<0>(x), y)));
  }
  HWY_INLINE V times_sub_from(V x, V y) const {
    return mul_sub_from(z_, spread<2>(x), mul_sub_from(y_, spread<1>(x), mul_sub_from(x_, spread<0>(x), y)));
  }

 private:
  V x_, y_, z_;  // columns
};

/// The same root where nothing is tilted, without iterations.
Mat3 root_of(const Mat3& f, bool tilted) {
  if (tilted) return square_root(f);
  return Mat3::diagonal({std::sqrt(f(0, 0)), std::sqrt(f(1, 1)), std::sqrt(f(2, 2))});
}

/// Moves one grain, or two that lie side by side.
template <class V, bool tilted>
class Mover {
 public:
  Mover(const Stride& stride, const ListReach& list, Grains& grains)
      : grains_(grains),
        list_(list),
        step_(first_three<V>({stride.dt, stride.dt, stride.dt}, 0)),
        half_step_(first_three<V>({0.5 * stride.dt, 0.5 * stride.dt, 0.5 * stride.dt}, 0)),
        stretch_(first_three<V>(stride.deformation.diagonal(), 1)),
        damping_(first_three<V>({stride.gamma_b, stride.gamma_b, stride.gamma_b}, stride.gamma_b)),
        rate_(first_three<V>(stride.gradient.diagonal(), 0)),
        zero_(first_three<V>({}, 0)),
        deformation_(stride.deformation),
        gradient_(stride.gradient),
        carry_(stride.dt * root_of(stride.deformation, tilted)),
        since_list_(list.deformation),
        excess_(first_three<V>({-1, -1, -1}, -1)),
        places_(zero_) {}

  HWY_INLINE void move(std::size_t i) {
    // The last of the four: radius in place, 1/mass in acceleration, 0 in the velocities, unused in force.
    const V before = load_fours<V>(&grains_.acceleration[i]), inverse_mass = spread<3>(before);
    const V seen = load_fours<V>(&grains_.motion[i]);
    const V from_force = load_fours<V>(&grains_.force[i]) * inverse_mass,
            place = load_fours<V>(&grains_.place[i]);
    V now, carried;
    if constexpr (tilted) {
      now = gradient_.times_sub_from(seen, mul_sub_from(damping_ * inverse_mass, seen, from_force));
      carried = with_last(deformation_.times_plus(place, zero_), place);
    } else {
      now = mul_sub_from(mul_add(damping_, inverse_mass, rate_), seen, from_force);
      carried = stretch_ * place;
    }
    const V v = mul_add(step_, now, load_fours<V>(&grains_.half[i]));
    const V x = carry_.times_plus(v, carried);
    places_ = places_ + x;
    store_fours(zero_, &grains_.force[i]);
    store_fours(v, &grains_.half[i]);
    store_fours(x, &grains_.place[i]);
    store_fours(mul_sub_from(half_step_, before, mul_add(step_, now, v)), &grains_.motion[i]);
    store_fours(with_last(now, before), &grains_.acceleration[i]);
    const V reference = load_fours<V>(&list_.reference[i]),
            strayed = since_list_.times_sub_from(reference, x);
    excess_ = larger(excess_, sum(with_last(strayed * strayed, zero_ - reference)));
  }

  /// The largest excess so far; not a number if a place is none.
  double excess() const {
    // Max drops what is not a number; a sum keeps it.
    alignas(64) Quad of_each[2] = {};
    store_fours(mul_add(zero_, sum(places_), excess_), of_each);
    if constexpr (std::is_same_v<V, Four>) return of_each[0].x;
    return std::isnan(of_each[1].x) || of_each[1].x > of_each[0].x ? of_each[1].x : of_each[0].x;
  }

 private:
  Grains& grains_;
  const ListReach& list_;
  V step_, half_step_, stretch_, damping_, rate_, zero_;
  Matrix<V, tilted> deformation_, gradient_;
  Matrix<V, tilted> carry_;  // the fluctuation of a step is carried along by half of its deformation
  Matrix<V, tilted> since_list_;
  V excess_, places_;
};

template <bool tilted>
double advance_each(const Stride& stride, const ListReach& list, std::size_t first, std::size_t last,
                    Grains& grains) {
  Mover<Wide, tilted> mover(stride, list, grains);
  constexpr std::size_t at_once = lanes / 4;
  std::size_t i = first;
  for (; i + at_once <= last; i += at_once) mover.move(i);
  if (i == last) return mover.excess();
  Mover<Four, tilted> odd(stride, list, grains);
  odd.move(i);
  const double a = mover.excess(), b = odd.excess();
  return std::isnan(a) || a > b ? a : b;
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
