#include "grainlaw/element/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/jacobi.hpp"

namespace grainlaw {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> indices{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
const double root = std::sqrt(2.0);

}  // namespace

Stiffness mandel(const Stiffness& c) {
  Stiffness m = c;
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) m[a][b] *= (a < 3 ? 1 : root) * (b < 3 ? 1 : root);
  return m;
}

Stiffness rotated(const Stiffness& c, const Rotation& rotation) {
  // How a symmetric tensor's components turn, in Mandel's notation: an orthogonal matrix.
  Stiffness q;
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      const auto [i, j] = indices[a];
      const auto [k, l] = indices[b];
      q[a][b] = 0.5 * (rotation[i][k] * rotation[j][l] + rotation[i][l] * rotation[j][k]) *
                (a < 3 ? 1 : root) * (b < 3 ? 1 : root);
    }
  const Stiffness m = mandel(c);
  Stiffness half{}, turned{};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      for (std::size_t k = 0; k < 6; ++k) half[a][b] += q[a][k] * m[k][b];
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      for (std::size_t k = 0; k < 6; ++k) turned[a][b] += half[a][k] * q[b][k];
      turned[a][b] /= (a < 3 ? 1 : root) * (b < 3 ? 1 : root);
    }
  return turned;
}

double norm(const Stiffness& c) {
  double sum = 0;
  for (const Sym6& row : mandel(c))
    for (const double component : row) sum += component * component;
  return std::sqrt(sum);
}

Sym6 eigenvalues(const Stiffness& c) {
  constexpr int sweeps = 20;  // Jacobi's method needs about six for all digits
  Stiffness m = mandel(c);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < a; ++b) m[a][b] = m[b][a] = 0.5 * (m[a][b] + m[b][a]);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t p = 0; p < 5; ++p)
      for (std::size_t q = p + 1; q < 6; ++q) jacobi_rotation(m, p, q);
  Sym6 values;
  for (std::size_t a = 0; a < 6; ++a) values[a] = m[a][a];
  std::sort(values.begin(), values.end());
  return values;
}

Stiffness inverse(const Stiffness& c) {
  constexpr double nothing = 1e-14;
  Stiffness a = c, s{};
  for (std::size_t k = 0; k < 6; ++k) s[k][k] = 1;
  const double size = norm(c);
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < 6; ++r)
      if (std::abs(a[r][k]) > std::abs(a[pivot][k])) pivot = r;
    if (!(std::abs(a[pivot][k]) > nothing * size))
      throw Error("the stiffness is singular: some strain meets no resistance, so it has no inverse");
    std::swap(a[k], a[pivot]);
    std::swap(s[k], s[pivot]);
    for (std::size_t r = 0; r < 6; ++r) {
      if (r == k) continue;
      const double factor = a[r][k] / a[k][k];
      for (std::size_t b = 0; b < 6; ++b) {
        a[r][b] -= factor * a[k][b];
        s[r][b] -= factor * s[k][b];
      }
    }
  }
  for (std::size_t r = 0; r < 6; ++r)
    for (double& component : s[r]) component /= a[r][r];
  return s;
}

}  // namespace grainlaw
