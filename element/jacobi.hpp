// One rotation of the Jacobi method: what eigenvalues of small symmetric matrices are made of.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace grainlaw {

/// Rotates the symmetric m in the plane of axes p and q so that m(p, q) vanishes. `also(turn)` may turn more
/// columns p and q along: turn(a, b) takes a number of each.
template <std::size_t n, class Also>
void jacobi_rotation(std::array<std::array<double, n>, n>& m, std::size_t p, std::size_t q, Also&& also) {
  if (m[p][q] == 0) return;
  const double ratio = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = std::copysign(1 / (std::abs(ratio) + std::sqrt(1 + ratio * ratio)), ratio);
  const double c = 1 / std::sqrt(1 + t * t), s = t * c;
  const auto turn = [&](double& a, double& b) {
    const double first = c * a - s * b;
    b = s * a + c * b;
    a = first;
  };
  for (std::size_t k = 0; k < n; ++k) turn(m[k][p], m[k][q]);
  for (std::size_t k = 0; k < n; ++k) turn(m[p][k], m[q][k]);
  also(turn);
}

template <std::size_t n>
void jacobi_rotation(std::array<std::array<double, n>, n>& m, std::size_t p, std::size_t q) {
  jacobi_rotation(m, p, q, [](const auto&) {});
}

}  // namespace grainlaw
