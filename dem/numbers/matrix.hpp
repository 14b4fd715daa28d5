// Matrices of three by three numbers: what a deformation, and a box that may be tilted, are made of.
#pragma once

#include <cstddef>

#include "grainlaw/dem/numbers/vec.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

class Mat3 {
 public:
  constexpr Mat3() = default;  ///< all zero
  constexpr Mat3(const Vec3& row_x, const Vec3& row_y, const Vec3& row_z) : rows_{row_x, row_y, row_z} {}
  static constexpr Mat3 diagonal(const Vec3& d) { return {{d[0], 0, 0}, {0, d[1], 0}, {0, 0, d[2]}}; }
  static constexpr Mat3 identity() { return diagonal({1, 1, 1}); }

  constexpr double operator()(std::size_t row, std::size_t column) const { return rows_[row][column]; }
  constexpr double& operator()(std::size_t row, std::size_t column) { return rows_[row][column]; }
  constexpr Vec3 column(std::size_t c) const { return {rows_[0][c], rows_[1][c], rows_[2][c]}; }
  constexpr const Vec3& row(std::size_t r) const { return rows_[r]; }
  constexpr Vec3 diagonal() const { return {rows_[0][0], rows_[1][1], rows_[2][2]}; }
  const double* data() const { return rows_[0].data(); }  ///< nine numbers, row by row
  constexpr bool is_diagonal() const {
    return rows_[0][1] == 0 && rows_[0][2] == 0 && rows_[1][0] == 0 && rows_[1][2] == 0 && rows_[2][0] == 0 &&
           rows_[2][1] == 0;
  }
  constexpr bool operator==(const Mat3&) const = default;

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.rows_);
  }

 private:
  std::array<Vec3, 3> rows_{};
};

constexpr Vec3 operator*(const Mat3& a, const Vec3& x) {
  return {a(0, 0) * x[0] + a(0, 1) * x[1] + a(0, 2) * x[2], a(1, 0) * x[0] + a(1, 1) * x[1] + a(1, 2) * x[2],
          a(2, 0) * x[0] + a(2, 1) * x[1] + a(2, 2) * x[2]};
}

constexpr Mat3 transposed(const Mat3& a) { return {a.column(0), a.column(1), a.column(2)}; }

constexpr Mat3 operator*(const Mat3& a, const Mat3& b) {
  return transposed({a * b.column(0), a * b.column(1), a * b.column(2)});
}

constexpr Mat3 operator+(const Mat3& a, const Mat3& b) {
  Mat3 sum;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) sum(r, c) = a(r, c) + b(r, c);
  return sum;
}

constexpr Mat3 operator*(double s, const Mat3& a) {
  Mat3 product;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) product(r, c) = s * a(r, c);
  return product;
}

/// Of a diagonal matrix this is the product from left to right, to the last bit.
constexpr double determinant(const Mat3& a) {
  return a(0, 0) * a(1, 1) * a(2, 2) - a(0, 0) * a(1, 2) * a(2, 1) + a(0, 1) * a(1, 2) * a(2, 0) -
         a(0, 1) * a(1, 0) * a(2, 2) + a(0, 2) * a(1, 0) * a(2, 1) - a(0, 2) * a(1, 1) * a(2, 0);
}

/// A symmetric tensor as a matrix.
constexpr Mat3 matrix_of(const Sym6& q) {
  return {{q[0], q[5], q[4]}, {q[5], q[1], q[3]}, {q[4], q[3], q[2]}};
}

Mat3 inverse(const Mat3& a);
/// The square root that is near the identity where `a` is.
Mat3 square_root(const Mat3& a);

/// A = sum of value[k] axis[k] (x) axis[k], the axes orthogonal and of length one; A symmetric.
struct Spectrum {
  Vec3 value;
  std::array<Vec3, 3> axis;
};
Spectrum spectrum(const Mat3& symmetric);

/// f(A): the same axes, f of each value.
template <class F>
Mat3 apply(const Spectrum& s, F&& f) {
  Mat3 sum;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) sum(r, c) += f(s.value[k]) * s.axis[k][r] * s.axis[k][c];
  return sum;
}

/// exp(A) of a symmetric A; of a diagonal one component by component.
Mat3 exponential(const Mat3& symmetric);

}  // namespace grainlaw::dem
