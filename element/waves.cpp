#include "grainlaw/element/waves.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/jacobi.hpp"

namespace grainlaw {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// A rotation of m in the plane of axes p and q that makes m(p, q) vanish; `axes` holds them in its columns.
void rotate(Matrix& m, Matrix& axes, std::size_t p, std::size_t q) {
  jacobi_rotation(m, p, q, [&](const auto& turn) {
    for (auto& row : axes) turn(row[p], row[q]);
  });
}

Direction unit(const Direction& n) {
  const double size = std::hypot(n[0], n[1], n[2]);
  if (!(size > 0)) throw Error("a wave needs a direction, got one of length 0");
  return {n[0] / size, n[1] / size, n[2] / size};
}

double of(const Sym6& q, std::size_t i, std::size_t j) { return q[component(i, j)]; }

}  // namespace

Sym6 acoustic_tensor(const Stiffness& energy, const Sym6& s, const Direction& direction) {
  const Direction n = unit(direction);
  Direction traction{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) traction[i] += of(s, i, j) * n[j];
  const double along = n[0] * traction[0] + n[1] * traction[1] + n[2] * traction[2];
  Sym6 q{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = i; k < 3; ++k) {
      double& sum = q[component(i, k)];
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t l = 0; l < 3; ++l) sum += energy[component(i, j)][component(k, l)] * n[j] * n[l];
      sum += 0.25 * (of(s, i, k) + traction[i] * n[k] + n[i] * traction[k]);
      if (i == k) sum += (0.25 - 1) * along;
    }
  return q;
}

std::array<Wave, 3> waves(const Stiffness& energy, const Sym6& prestress, double density,
                          const Direction& n) {
  constexpr int sweeps = 10;  // Jacobi's method needs four to six for all digits
  const Sym6 q = acoustic_tensor(energy, prestress, n);
  Matrix m{}, axes{};
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i][i] = 1;
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = of(q, i, j);
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    rotate(m, axes, 0, 1);
    rotate(m, axes, 0, 2);
    rotate(m, axes, 1, 2);
  }
  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return m[a][a] < m[b][b]; });
  std::array<Wave, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = order[k];
    result[k] = {std::sqrt(m[a][a] / density), {axes[0][a], axes[1][a], axes[2][a]}};
  }
  return result;
}

}  // namespace grainlaw
