// Numbers that carry their derivatives with respect to N variables (forward mode): a law written as a
// template over its scalar gives its own Jacobian, tangent and sensitivities, exact to rounding. Comparisons
// look at the value.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace grainlaw::model {

template <std::size_t N>
struct Dual {
  double value = 0;
  std::array<double, N> slope{};

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT(google-explicit-constructor): a constant is a number of slope 0
  /// Variable i of the N.
  Dual(double v, std::size_t i) : value(v) { slope[i] = 1; }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  /// f(a) with f' there.
  static Dual chain(double f, double df, const Dual& a) {
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = df * a.slope[i];
    return result;
  }
  /// f(a, b) with both partial derivatives there.
  static Dual chain(double f, double da, const Dual& a, double db, const Dual& b) {
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i) result.slope[i] = da * a.slope[i] + db * b.slope[i];
    return result;
  }

  friend Dual operator+(const Dual& a, const Dual& b) { return chain(a.value + b.value, 1, a, 1, b); }
  friend Dual operator-(const Dual& a, const Dual& b) { return chain(a.value - b.value, 1, a, -1, b); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return chain(a.value * b.value, b.value, a, a.value, b);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double f = a.value / b.value, inverse = 1 / b.value;
    return chain(f, inverse, a, -f * inverse, b);
  }
  friend Dual operator+(const Dual& a, double b) { return chain(a.value + b, 1, a); }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(const Dual& a, double b) { return chain(a.value - b, 1, a); }
  friend Dual operator-(double a, const Dual& b) { return chain(a - b.value, -1, b); }
  friend Dual operator*(const Dual& a, double b) { return chain(a.value * b, b, a); }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) { return chain(a.value / b, 1 / b, a); }
  friend Dual operator/(double a, const Dual& b) {
    const double f = a / b.value;
    return chain(f, -f / b.value, b);
  }
  friend Dual operator-(const Dual& a) { return chain(-a.value, -1, a); }

  friend auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend auto operator<=>(const Dual& a, double b) { return a.value <=> b; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
  friend bool operator==(const Dual& a, double b) { return a.value == b; }

  friend Dual exp(const Dual& a) {
    const double f = std::exp(a.value);
    return chain(f, f, a);
  }
  friend Dual expm1(const Dual& a) {
    const double f = std::expm1(a.value);
    return chain(f, f + 1, a);
  }
  friend Dual log(const Dual& a) { return chain(std::log(a.value), 1 / a.value, a); }
  friend Dual abs(const Dual& a) { return chain(std::abs(a.value), a.value < 0 ? -1 : 1, a); }
  /// a^b. Where a = 0, the derivative with respect to b is 0 and the one with respect to a is infinite for b
  /// < 1: only a slope that is not 0 meets it.
  friend Dual pow(const Dual& a, const Dual& b) {
    const double f = std::pow(a.value, b.value), df = b.value * std::pow(a.value, b.value - 1);
    const double logarithm = a.value > 0 ? f * std::log(a.value) : 0;
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i)
      result.slope[i] = (a.slope[i] == 0 ? 0 : df * a.slope[i]) + logarithm * b.slope[i];
    return result;
  }
  friend Dual pow(const Dual& a, double b) { return pow(a, Dual(b)); }
};

/// Numbers with the derivatives that sensitivities carry.
inline constexpr std::size_t most_slopes = 64;
using Slopes = Dual<most_slopes>;

/// The number without its derivatives.
inline double value(double x) { return x; }
template <std::size_t N>
double value(const Dual<N>& x) {
  return x.value;
}

/// The type in which numbers of the types A and B meet.
template <class A, class B>
using Meet = std::decay_t<decltype(std::declval<A>() * std::declval<B>())>;

}  // namespace grainlaw::model
