// The stiffly accurate Rosenbrock method RODAS 4(3) of Hairer and Wanner (Solving Ordinary Differential
// Equations II, section IV.7), L-stable: one step, with the Jacobian by dual numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "grainlaw/model/light/explicit_pair.hpp"
#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

struct Rodas {
  static constexpr std::size_t stages = 6;
  static constexpr int order = 4;
  static constexpr double gamma = 0.25;
  static constexpr double c[] = {0, 0.386, 0.21, 0.63, 1, 1};
  static constexpr double d[] = {0.25,    -0.1043, 0.1035,
                                 -0.0362, 0,       0};  // weights of the rate's derivative by t
  static constexpr double a[][5] = {
      {},
      {1.544},
      {0.9466785280815826, 0.2557011698983284},
      {3.314825187068521, 2.896124015972201, 0.9986419139977817},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1}};
  static constexpr double C[][5] = {
      {},
      {-5.6688},
      {-2.430093356833875, -0.2063599157091915},
      {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
      {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
      {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}};
};

/// A dense matrix, factored once with row pivoting and solved for several right-hand sides.
template <class T, std::size_t n>
class SmallFactor {
 public:
  /// False where it is singular.
  bool factor(const std::array<std::array<T, n>, n>& matrix) {
    m_ = matrix;
    for (std::size_t i = 0; i < n; ++i) order_[i] = i;
    for (std::size_t col = 0; col < n; ++col) {
      std::size_t pivot = col;
      for (std::size_t row = col + 1; row < n; ++row)
        if (std::abs(value(m_[row][col])) > std::abs(value(m_[pivot][col]))) pivot = row;
      if (!(std::abs(value(m_[pivot][col])) > 0)) return false;
      std::swap(m_[col], m_[pivot]);
      std::swap(order_[col], order_[pivot]);
      for (std::size_t row = col + 1; row < n; ++row) {
        m_[row][col] = m_[row][col] / m_[col][col];
        for (std::size_t j = col + 1; j < n; ++j) m_[row][j] = m_[row][j] - m_[row][col] * m_[col][j];
      }
    }
    return true;
  }
  std::array<T, n> solve(const std::array<T, n>& b) const {
    std::array<T, n> x;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = b[order_[i]];
      for (std::size_t j = 0; j < i; ++j) x[i] = x[i] - m_[i][j] * x[j];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t j = i + 1; j < n; ++j) x[i] = x[i] - m_[i][j] * x[j];
      x[i] = x[i] / m_[i][i];
    }
    return x;
  }

 private:
  std::array<std::array<T, n>, n> m_;
  std::array<std::size_t, n> order_;
};

/// One step of y' = rate(t, y, dydt), a generic function of two scalars (that of t, that of y and dydt), from
/// (t, y) over h. False where a stage is not defined.
template <class T, std::size_t n, class Rate>
bool rosenbrock_step(Rate&& rate, const std::array<T, n>& y, double t, double h, Trial<T, n>& trial) {
  // The last variable of the dual numbers is t.
  using D = Dual<n + 1, T>;
  std::array<D, n> y_dual, rate_dual;
  for (std::size_t i = 0; i < n; ++i) y_dual[i] = D(y[i], i);
  if (!rate(D(T(t), n), y_dual.data(), rate_dual.data())) return false;
  std::array<std::array<T, n>, n> matrix;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      matrix[i][j] = (i == j ? 1 / (h * Rodas::gamma) : 0.0) - rate_dual[i].slope[j];
  SmallFactor<T, n> factor;
  if (!factor.factor(matrix)) return false;
  std::array<std::array<T, n>, Rodas::stages> k;
  for (std::size_t s = 0; s < Rodas::stages; ++s) {
    std::array<T, n> right, f;
    trial.y = y;
    for (std::size_t j = 0; j < s; ++j)
      for (std::size_t i = 0; i < n; ++i) trial.y[i] = trial.y[i] + Rodas::a[s][j] * k[j][i];
    if (s == 0)
      for (std::size_t i = 0; i < n; ++i) f[i] = rate_dual[i].value;
    else if (!rate(T(t + Rodas::c[s] * h), trial.y.data(), f.data()))
      return false;
    for (std::size_t i = 0; i < n; ++i) {
      right[i] = f[i] + Rodas::d[s] * h * rate_dual[i].slope[n];
      for (std::size_t j = 0; j < s; ++j) right[i] = right[i] + Rodas::C[s][j] / h * k[j][i];
    }
    k[s] = factor.solve(right);
  }
  for (std::size_t i = 0; i < n; ++i) trial.y[i] = trial.y[i] + k[5][i];
  trial.error = k[5];
  return true;
}

}  // namespace grainlaw::model
