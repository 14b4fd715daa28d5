// Numbers that carry their derivatives with respect to N variables (forward mode): a law written as a
// template over its scalar gives its own Jacobian, tangent and sensitivities, exact to rounding. Comparisons
// look at the value.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace grainlaw::model {

/// T is the scalar of value and slopes: another Dual where a derivative is differentiated again.
template <std::size_t N, class T = double>
struct Dual {
  T value = 0.0;
  std::array<T, N> slope{};

  Dual() = default;
  /// A constant: a number of slope 0.
  template <class C>
  requires std::convertible_to<C, T> Dual(const C& v) : value(v) {}  // NOLINT(google-explicit-constructor)
  /// Variable i of the N.
  Dual(const T& v, std::size_t i) : value(v) { slope[i] = 1.0; }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  /// f(a) with f' there.
  static Dual chain(const T& f, const T& df, const Dual& a) {
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = df * a.slope[i];
    return result;
  }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual result(a.value + b.value);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = a.slope[i] + b.slope[i];
    return result;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual result(a.value - b.value);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = a.slope[i] - b.slope[i];
    return result;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual result(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = b.value * a.slope[i] + a.value * b.slope[i];
    return result;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = 1.0 / b.value;
    Dual result(a.value / b.value);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = (a.slope[i] - result.value * b.slope[i]) * inverse;
    return result;
  }
  friend Dual operator+(const Dual& a, double b) {
    Dual result = a;
    result.value = result.value + b;
    return result;
  }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(const Dual& a, double b) { return a + -b; }
  friend Dual operator-(double a, const Dual& b) { return -b + a; }
  friend Dual operator*(const Dual& a, double b) { return chain(a.value * b, b, a); }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) { return chain(a.value / b, 1 / b, a); }
  friend Dual operator/(double a, const Dual& b) {
    const T f = a / b.value;
    return chain(f, -f / b.value, b);
  }
  friend Dual operator-(const Dual& a) { return chain(-a.value, -1.0, a); }

  friend auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend auto operator<=>(const Dual& a, double b) { return a.value <=> b; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend bool operator==(const Dual& a, double b) { return a.value == b; }

  friend Dual exp(const Dual& a) {
    using std::exp;
    const T f = exp(a.value);
    return chain(f, f, a);
  }
  friend Dual expm1(const Dual& a) {
    using std::expm1;
    const T f = expm1(a.value);
    return chain(f, f + 1.0, a);
  }
  friend Dual log(const Dual& a) {
    using std::log;
    return chain(log(a.value), 1.0 / a.value, a);
  }
  friend Dual sqrt(const Dual& a) {
    using std::sqrt;
    const T f = sqrt(a.value);
    return chain(f, 0.5 / f, a);
  }
  friend Dual abs(const Dual& a) { return a.value < 0 ? -a : a; }
  /// a^b. Where a = 0, the derivative with respect to b is 0 and the one with respect to a is infinite for b
  /// < 1: only a slope that is not 0 meets it.
  friend Dual pow(const Dual& a, const Dual& b) {
    using std::log, std::pow;
    const T f = pow(a.value, b.value), df = b.value * pow(a.value, b.value - 1.0);
    T logarithm = 0.0;
    if (a.value > 0) logarithm = f * log(a.value);
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i) {
      result.slope[i] = logarithm * b.slope[i];
      if (!(a.slope[i] == 0)) result.slope[i] = result.slope[i] + df * a.slope[i];
    }
    return result;
  }
  friend Dual pow(const Dual& a, double b) { return pow(a, Dual(b)); }
};

/// Numbers with the derivatives that sensitivities carry.
inline constexpr std::size_t most_slopes = 64;
using Slopes = Dual<most_slopes>;
/// The same for few: what is computed for slopes that nobody asked for costs as much.
using FewSlopes = Dual<12>;

/// The number without its derivatives.
inline double value(double x) { return x; }
template <std::size_t N, class T>
double value(const Dual<N, T>& x) {
  return value(x.value);
}

/// Whether a number is 0 and stays 0 whatever its variables do.
inline bool vanishes(double x) { return x == 0; }
template <std::size_t N, class T>
bool vanishes(const Dual<N, T>& x) {
  for (const T& slope : x.slope)
    if (!vanishes(slope)) return false;
  return vanishes(x.value);
}

/// The type in which numbers of the types A and B meet.
template <class A, class B>
using Meet = std::decay_t<decltype(std::declval<A>() * std::declval<B>())>;

}  // namespace grainlaw::model
