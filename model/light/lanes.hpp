// Eight points at once: the scalar with which the forms of the law run over a batch. The vectors of the
// machine come from the function that everything is inlined into (see light_batch.cpp), so the laws stay what
// they are: templates.
#pragma once

#include <cmath>
#include <cstddef>
#include <initializer_list>

namespace grainlaw::model {

struct Lanes {
  static constexpr std::size_t count = 8;
  using Vector = double __attribute__((vector_size(count * sizeof(double))));
  Vector v;

  Lanes() = default;
  Lanes(double x) : v(x - Vector{}) {}  // NOLINT(google-explicit-constructor): the same in every lane
  explicit Lanes(const Vector& x) : v(x) {}

  static Lanes load(const double* x) {
    Lanes result;
    __builtin_memcpy(&result.v, x, sizeof result.v);
    return result;
  }
  void store(double* x) const { __builtin_memcpy(x, &v, sizeof v); }
  double operator[](std::size_t i) const { return v[i]; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(a.v + b.v); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(a.v - b.v); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(a.v * b.v); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(a.v / b.v); }
  friend Lanes operator-(const Lanes& a) { return Lanes(-a.v); }

  /// Comparisons hold where they hold in every lane.
  friend bool operator<(const Lanes& a, const Lanes& b) { return every(a.v < b.v); }
  friend bool operator<=(const Lanes& a, const Lanes& b) { return every(a.v <= b.v); }
  friend bool operator>(const Lanes& a, const Lanes& b) { return every(a.v > b.v); }
  friend bool operator>=(const Lanes& a, const Lanes& b) { return every(a.v >= b.v); }
  friend bool operator==(const Lanes& a, const Lanes& b) { return every(a.v == b.v); }

  friend Lanes abs(const Lanes& a) { return Lanes(a.v < 0 ? -a.v : a.v); }
  friend Lanes larger(const Lanes& a, const Lanes& b) { return Lanes(a.v > b.v ? a.v : b.v); }
  friend Lanes sign(const Lanes& a) {
    return Lanes((a.v > 0 ? Vector{} + 1 : Vector{}) - (a.v < 0 ? Vector{} + 1 : Vector{}));
  }
  friend bool vanishes(const Lanes& a) { return a == 0.0; }
  /// e^x to 2 units in the last place.
  friend Lanes exp(const Lanes& a) {
    if (!every(a.v > -700 && a.v < 700)) return each(a, [](double x) { return std::exp(x); });
    const Vector n = (a.v * 1.4426950408889634 + shift) - shift;  // nearest whole number
    const Vector r = (a.v - n * ln2_high) - n * ln2_low;
    Vector p = Vector{} + 1. / 6227020800;  // Taylor to r^13/13!, |r| <= ln 2/2
    for (const double c : {1. / 479001600, 1. / 39916800, 1. / 3628800, 1. / 362880, 1. / 40320, 1. / 5040,
                           1. / 720, 1. / 120, 1. / 24, 1. / 6, 1. / 2, 1., 1.})
      p = p * r + c;
    const Bits exponent = (bits(n + shift) << 52) + bits(Vector{} + 1);
    return Lanes(p * number(exponent));
  }
  friend Lanes expm1(const Lanes& a) { return exp(a) - 1.0; }  ///< absolute accuracy only
  /// ln x to 2 units in the last place.
  friend Lanes log(const Lanes& a) {
    if (!every(a.v > 1e-300 && a.v < 1e300)) return each(a, [](double x) { return std::log(x); });
    // x = m 2^n with m from sqrt(1/2) to sqrt(2).
    const Bits moved = bits(a.v) - 0x3fe6a09e667f3bcdLL;
    const Vector n = number(((moved >> 52) & 0x7ff) + ((moved >> 63) << 11) + bits(Vector{} + shift)) - shift;
    const Vector m = number((moved & 0x000fffffffffffffLL) + 0x3fe6a09e667f3bcdLL);
    const Vector s = (m - 1) / (m + 1), z = s * s;
    Vector p = Vector{} + 1. / 23;
    for (const double c :
         {1. / 21, 1. / 19, 1. / 17, 1. / 15, 1. / 13, 1. / 11, 1. / 9, 1. / 7, 1. / 5, 1. / 3})
      p = p * z + c;
    return Lanes(n * ln2_high + (2 * s + (2 * s * z * p + n * ln2_low)));
  }
  friend Lanes pow(const Lanes& a, double b) {
    if (!every(a.v > 1e-300 && a.v < 1e300)) return each(a, [b](double x) { return std::pow(x, b); });
    return exp(b * log(a));
  }

 private:
  using Bits = long long __attribute__((vector_size(count * sizeof(long long))));
  static constexpr double shift =
      6755399441055744;  // 1.5 * 2^52: adding it leaves a whole number in the low bits
  static constexpr double ln2_high = 0.693147180369123816490, ln2_low = 1.90821492927058770002e-10;

  static Bits bits(const Vector& x) {
    Bits result;
    __builtin_memcpy(&result, &x, sizeof x);
    return result;
  }
  static Vector number(const Bits& x) {
    Vector result;
    __builtin_memcpy(&result, &x, sizeof x);
    return result;
  }
  template <class Mask>
  static bool every(const Mask& mask) {
    bool all = true;
    for (std::size_t i = 0; i < count; ++i) all &= mask[i] != 0;
    return all;
  }
  template <class F>
  static Lanes each(const Lanes& a, F f) {
    Lanes result;
    for (std::size_t i = 0; i < count; ++i) result.v[i] = f(a.v[i]);
    return result;
  }
};

}  // namespace grainlaw::model
