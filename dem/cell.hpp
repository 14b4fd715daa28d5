// The periodic box: edges, images, strain and the affine velocity of its deformation.
// It spans [0, L) along each axis and deforms about the origin: x -> x L'/L.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "grainlaw/dem/vec.hpp"

namespace grainlaw::dem {

/// Volume of a sphere, mm^3.
inline double sphere_volume(double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; }

class Cell {
 public:
  Cell() = default;
  /// Edges, mm; d(ln L)/dt per axis, 1/us, positive in extension.
  explicit Cell(const Vec3& length, const Vec3& rate = {}) : length_(length), rate_(rate) {}

  const Vec3& length() const { return length_; }  ///< mm
  /// d(ln L)/dt per axis, 1/us, positive in extension: the velocity gradient.
  const Vec3& rate() const { return rate_; }

  double volume() const { return length_[0] * length_[1] * length_[2]; }
  double shortest() const { return std::min({length_[0], length_[1], length_[2]}); }

  /// The image in [0, L).
  Vec3 wrap(Vec3 x) const {
    for (std::size_t c = 0; c < 3; ++c) {
      x[c] -= length_[c] * std::floor(x[c] / length_[c]);
      if (x[c] >= length_[c]) x[c] = 0;  // a tiny negative number rounds up to L
    }
    return x;
  }
  /// The shortest image of a difference of positions. Unique only within half a box; the engine itself uses
  /// `shifts`, which also hold where a grain touches several images of another.
  Vec3 nearest_image(Vec3 d) const {
    for (std::size_t c = 0; c < 3; ++c) d[c] -= length_[c] * std::round(d[c] / length_[c]);
    return d;
  }

  /// Edges over those of `before`: the stretch of the deformation in between.
  Vec3 stretch_from(const Vec3& before) const {
    return {length_[0] / before[0], length_[1] / before[1], length_[2] / before[2]};
  }
  /// Logarithmic strain since `before`, compression positive.
  Vec3 strain_from(const Vec3& before) const {
    const Vec3 e = stretch_from(before);
    return {-std::log(e[0]), -std::log(e[1]), -std::log(e[2])};
  }
  /// Velocity of the affine motion at x (or of a separation x), mm/us.
  Vec3 affine_velocity(const Vec3& x) const { return {rate_[0] * x[0], rate_[1] * x[1], rate_[2] * x[2]}; }

  /// Images are numbered 0 ... 26; `image_number(a, b, c)` with a, b, c in -1 ... 1 lies a Lx, b Ly, c Lz
  /// away.
  static constexpr unsigned home_image = 13;
  static constexpr unsigned image_number(int a, int b, int c) {
    return static_cast<unsigned>((a + 1) + 3 * (b + 1) + 9 * (c + 1));
  }
  /// The translations of the 27 images, mm.
  std::array<Quad, 27> shifts() const {
    std::array<Quad, 27> table;
    for (int c = -1; c <= 1; ++c)
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a)
          table[image_number(a, b, c)] = {a * length_[0], b * length_[1], c * length_[2], 0};
    return table;
  }

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.length_, self.rate_);
  }

 private:
  Vec3 length_{1, 1, 1};
  Vec3 rate_{};
};

}  // namespace grainlaw::dem
