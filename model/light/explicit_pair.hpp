// Embedded explicit Runge-Kutta pairs: one trial step, its error, and the tableaux.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace grainlaw::model {

/// Bogacki and Shampine 3(2), four stages, of which the last is the first of the next step.
struct BogackiShampine {
  static constexpr std::size_t stages = 4;
  static constexpr int order = 3;
  static constexpr double c[] = {0, 1. / 2, 3. / 4, 1};
  static constexpr double a[][4] = {{}, {1. / 2}, {0, 3. / 4}, {2. / 9, 1. / 3, 4. / 9}};
  /// Weights of the third order less those of the second.
  static constexpr double e[] = {2. / 9 - 7. / 24, 1. / 3 - 1. / 4, 4. / 9 - 1. / 3, -1. / 8};
};

/// Dormand and Prince 5(4), seven stages, of which the last is the first of the next step.
struct DormandPrince {
  static constexpr std::size_t stages = 7;
  static constexpr int order = 5;
  static constexpr double c[] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1};
  static constexpr double a[][7] = {{},
                                    {1. / 5},
                                    {3. / 40, 9. / 40},
                                    {44. / 45, -56. / 15, 32. / 9},
                                    {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
                                    {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
                                    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  /// Weights of the fifth order less those of the fourth.
  static constexpr double e[] = {71. / 57600,      0,         -71. / 16695, 71. / 1920,
                                 -17253. / 339200, 22. / 525, -1. / 40};
};

/// What a trial step leaves: the new variables and the estimate of their error.
template <class T, std::size_t n>
struct Trial {
  std::array<T, n> y, error;
};

namespace pair_detail {

/// sum_j w[j] k[j] over the weights that are not 0, unrolled.
template <class Pair, bool of_error, std::size_t row, class T, std::size_t n, std::size_t... j>
T weighted(const std::array<std::array<T, n>, Pair::stages>& k, std::size_t i, std::index_sequence<j...>) {
  constexpr auto weight = [](std::size_t stage) { return of_error ? Pair::e[stage] : Pair::a[row][stage]; };
  T sum = 0.0;
  const auto add = [&]<std::size_t stage>(std::integral_constant<std::size_t, stage>) {
    if constexpr (weight(stage) != 0) sum = sum + weight(stage) * k[stage][i];
  };
  (add(std::integral_constant<std::size_t, j>{}), ...);
  return sum;
}

}  // namespace pair_detail

/// One step of y' = rate(c, y), c in [0, 1] the fraction of the step, from y over h. k[0] is the rate at its
/// start, k[stages - 1] becomes that at its end. False where a stage is not defined.
template <class Pair, class T, std::size_t n, class Rate>
bool trial_step(Rate&& rate, const std::array<T, n>& y, double h,
                std::array<std::array<T, n>, Pair::stages>& k, Trial<T, n>& trial) {
  bool defined = true;
  const auto stage = [&]<std::size_t s>(std::integral_constant<std::size_t, s>) {
    if (!defined) return;
    for (std::size_t i = 0; i < n; ++i)
      trial.y[i] = y[i] + h * pair_detail::weighted<Pair, false, s>(k, i, std::make_index_sequence<s>{});
    defined = rate(Pair::c[s], trial.y.data(), k[s].data());
  };
  [&]<std::size_t... s>(std::index_sequence<s...>) {
    (stage(std::integral_constant<std::size_t, s + 1>{}), ...);
  }
  (std::make_index_sequence<Pair::stages - 1>{});
  if (!defined) return false;
  for (std::size_t i = 0; i < n; ++i)
    trial.error[i] = h * pair_detail::weighted<Pair, true, 0>(k, i, std::make_index_sequence<Pair::stages>{});
  return true;
}

}  // namespace grainlaw::model
