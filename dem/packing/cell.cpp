#include "grainlaw/dem/packing/cell.hpp"

#include <algorithm>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

/// A change of edges that shortens one by less than this is none: edges of equal length stay as they are.
constexpr double shorter = 1 - 1e-9;  // of squared length

double squared_length(const Mat3& edges, const Vec3& multiples) {
  const Vec3 x = edges * multiples;
  return dot(x, x);
}

/// Adds multiples of the other two edges to edge i of `basis` where that shortens it.
bool shorten(const Mat3& edges, Mat3& basis, std::size_t i, const Vec3& multiples) {
  Vec3 sum = basis * multiples;
  for (std::size_t r = 0; r < 3; ++r) sum[r] += basis(r, i);
  if (!(squared_length(edges, sum) < shorter * squared_length(edges, basis.column(i)))) return false;
  for (std::size_t r = 0; r < 3; ++r) basis(r, i) = sum[r];
  return true;
}

/// How much of edge j must be taken off edge i to make it shortest.
double whole_part(const Mat3& edges, const Mat3& basis, std::size_t i, std::size_t j) {
  const Vec3 a = edges * basis.column(i), b = edges * basis.column(j);
  return std::round(dot(a, b) / dot(b, b));
}

/// The shortest edges of the lattice (Minkowski-reduced): no edge can be made shorter by adding the others to
/// it or taking them off, which in three dimensions is all there is to test (Semaev 2001). Each height is
/// then at least 1/sqrt(2) of its edge.
Mat3 reduced_basis(const Mat3& edges) {
  Mat3 basis = Mat3::identity();
  bool changed = true;
  while (changed) {
    changed = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      for (const std::size_t other : {j, k}) {
        Vec3 multiples{};
        multiples[other] = -whole_part(edges, basis, i, other);
        changed = shorten(edges, basis, i, multiples) || changed;
      }
      for (const double p : {-1.0, 1.0})
        for (const double q : {-1.0, 1.0}) {
          Vec3 multiples{};
          multiples[j] = p;
          multiples[k] = q;
          changed = shorten(edges, basis, i, multiples) || changed;
        }
    }
  }
  return basis;
}

}  // namespace

Cell::Cell(const Mat3& edges, const Mat3& gradient) : edges_(edges), gradient_(gradient) {
  tilted_ = !edges.is_diagonal() || !gradient.is_diagonal();
  if (!tilted_) return;
  if (!(determinant(edges) > 0) || !std::isfinite(determinant(edges)))
    throw Error("the edges of the box must span a right-handed parallelepiped, got a volume of " +
                to_text(determinant(edges)) + " mm^3");
  reduce();
}

Cell Cell::moved(const Mat3& edges, const Mat3& gradient) const {
  Cell next;
  next.edges_ = edges;
  next.gradient_ = gradient;
  next.basis_ = basis_;
  next.tilted_ = !edges.is_diagonal() || !gradient.is_diagonal() || !basis_.is_diagonal();
  if (next.tilted_) next.to_fractions_ = inverse(edges * basis_);
  return next;
}

void Cell::reduce() {
  if (!tilted_) return;
  basis_ = reduced_basis(edges_);
  *this = moved(edges_, gradient_);
}

Vec3 Cell::heights() const {
  if (!tilted_) return length();
  return {1 / norm(to_fractions_.row(0)), 1 / norm(to_fractions_.row(1)), 1 / norm(to_fractions_.row(2))};
}

double Cell::narrowest() const {
  const Vec3 h = heights();
  return std::min({h[0], h[1], h[2]});
}

Vec3 Cell::wrap_tilted(const Vec3& x) const {
  const Vec3 s = to_fractions_ * x;
  const Vec3 away = translation({std::floor(s[0]), std::floor(s[1]), std::floor(s[2])});
  return {x[0] - away[0], x[1] - away[1], x[2] - away[2]};
}

Vec3 Cell::nearest_tilted(const Vec3& d) const {
  const Vec3 s = to_fractions_ * d;
  Vec3 nearest = d;
  double least = -1;
  // The nearest image lies at most one reduced edge beside the one that rounding finds.
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      for (int c = -1; c <= 1; ++c) {
        const Vec3 away = translation({std::round(s[0]) + a, std::round(s[1]) + b, std::round(s[2]) + c});
        const Vec3 image{d[0] - away[0], d[1] - away[1], d[2] - away[2]};
        if (least >= 0 && dot(image, image) >= least) continue;
        nearest = image;
        least = dot(image, image);
      }
  return nearest;
}

Mat3 Cell::deformation_from(const Mat3& before) const {
  if (!tilted_ && before.is_diagonal())
    return Mat3::diagonal(
        {edges_(0, 0) / before(0, 0), edges_(1, 1) / before(1, 1), edges_(2, 2) / before(2, 2)});
  return edges_ * inverse(before);
}

Sym6 Cell::strain_from(const Mat3& before) const {
  const Mat3 f = deformation_from(before);
  if (f.is_diagonal()) return {-std::log(f(0, 0)), -std::log(f(1, 1)), -std::log(f(2, 2)), 0, 0, 0};
  const Mat3 h = apply(spectrum(f * transposed(f)), [](double square) { return -0.5 * std::log(square); });
  return {h(0, 0), h(1, 1), h(2, 2), h(1, 2), h(0, 2), h(0, 1)};
}

std::array<Quad, 27> Cell::shifts() const {
  std::array<Quad, 27> table;
  for (int c = -1; c <= 1; ++c)
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a) {
        Quad& shift = table[image_number(a, b, c)];
        if (tilted_) {
          const Vec3 x =
              translation({static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)});
          shift = {x[0], x[1], x[2], 0};
        } else {
          shift = {a * edges_(0, 0), b * edges_(1, 1), c * edges_(2, 2), 0};
        }
      }
  return table;
}

double least_stretch(const Mat3& f) {
  if (f.is_diagonal()) return std::min({1.0, f(0, 0), f(1, 1), f(2, 2)});
  // Gershgorin's circles around the eigenvalues of F^T F.
  const Mat3 c = transposed(f) * f;
  double least = 1;
  for (std::size_t r = 0; r < 3; ++r)
    least = std::min(least, c(r, r) - std::abs(c(r, (r + 1) % 3)) - std::abs(c(r, (r + 2) % 3)));
  return least > 0 ? std::sqrt(least) : 0;
}

}  // namespace grainlaw::dem
