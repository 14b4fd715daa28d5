#include "grainlaw/dem/numbers/matrix.hpp"

#include <cmath>

namespace grainlaw::dem {

namespace {

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A rotation in the plane of axes p and q that makes a(p, q) vanish; `axes` holds the axes in its columns.
void rotate(Mat3& a, Mat3& axes, std::size_t p, std::size_t q) {
  if (a(p, q) == 0) return;
  const double ratio = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1 / (std::abs(ratio) + std::sqrt(1 + ratio * ratio)), ratio);
  const double c = 1 / std::sqrt(1 + t * t), s = t * c;
  Mat3 turn = Mat3::identity();
  turn(p, p) = turn(q, q) = c;
  turn(p, q) = s;
  turn(q, p) = -s;
  a = transposed(turn) * a * turn;
  a(p, q) = a(q, p) = 0;
  axes = axes * turn;
}

}  // namespace

Mat3 inverse(const Mat3& a) {
  const Vec3 x = a.column(0), y = a.column(1), z = a.column(2);
  return 1 / determinant(a) * Mat3(cross(y, z), cross(z, x), cross(x, y));
}

Mat3 square_root(const Mat3& a) {
  // Denman and Beavers; every round doubles the digits that are right, also those of |a - 1| near 1.
  Mat3 root = a, inverse_root = Mat3::identity();
  for (int round = 0; round < 6; ++round) {
    const Mat3 next = 0.5 * (root + inverse(inverse_root));
    inverse_root = 0.5 * (inverse_root + inverse(root));
    root = next;
  }
  return root;
}

Spectrum spectrum(const Mat3& symmetric) {
  constexpr int sweeps = 10;  // Jacobi's method needs four to six for all digits
  Mat3 a = symmetric, axes = Mat3::identity();
  for (int sweep = 0; sweep < sweeps && !a.is_diagonal(); ++sweep) {
    rotate(a, axes, 0, 1);
    rotate(a, axes, 0, 2);
    rotate(a, axes, 1, 2);
  }
  return {a.diagonal(), {axes.column(0), axes.column(1), axes.column(2)}};
}

Mat3 exponential(const Mat3& a) {
  const auto exp = [](double x) { return std::exp(x); };
  if (!a.is_diagonal()) return apply(spectrum(a), exp);
  return Mat3::diagonal({exp(a(0, 0)), exp(a(1, 1)), exp(a(2, 2))});
}

}  // namespace grainlaw::dem
