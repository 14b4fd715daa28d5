// The periodic box: edges, images, strain and the affine velocity of its deformation. It may be tilted.
// The columns of its matrix H are its edges, x = H s with s in [0, 1) per edge; it deforms about the origin.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "grainlaw/dem/numbers/matrix.hpp"
#include "grainlaw/dem/numbers/vec.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw::dem {

/// Volume of a sphere, mm^3.
inline double sphere_volume(double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; }

/// H follows any homogeneous deformation, dH/dt = G H with the whole velocity gradient G, and is never
/// flipped: H' H^-1 is the deformation in between, however large. Grains and images use other edges of the
/// same lattice, as short as there are: H M with whole numbers M. M is chosen when a cell is made, kept when
/// it deforms (`moved`), because the images by which pairs meet are numbered with it, and chosen anew by
/// `reduce`, when pairs are listed anew. An orthorhombic box (H and G diagonal, then M = 1) does none of that
/// work.
class Cell {
 public:
  Cell() = default;
  /// Orthorhombic. Edges, mm; d(ln L)/dt per axis, 1/us, positive in extension.
  explicit Cell(const Vec3& length, const Vec3& rate = {})
      : edges_(Mat3::diagonal(length)), gradient_(Mat3::diagonal(rate)) {}
  /// H, mm, its determinant > 0, and G, 1/us.
  explicit Cell(const Mat3& edges, const Mat3& gradient = {});

  /// This box after a deformation, with the images as they are.
  Cell moved(const Mat3& edges, const Mat3& gradient) const;
  /// Chooses the shortest edges anew. Renumbers images; no distance changes.
  void reduce();

  const Mat3& edges() const { return edges_; }        ///< H, mm
  const Mat3& gradient() const { return gradient_; }  ///< G = dH/dt H^-1, 1/us, positive in extension
  /// M: the columns of H M are the edges that images count. Whole numbers, determinant 1.
  const Mat3& basis() const { return basis_; }
  /// Whether H or G have anything beside the diagonal.
  bool tilted() const { return tilted_; }
  Vec3 length() const { return edges_.diagonal(); }   ///< edges of an orthorhombic box, mm
  Vec3 rate() const { return gradient_.diagonal(); }  ///< d(ln L)/dt of an orthorhombic box, 1/us

  double volume() const { return determinant(edges_); }
  /// Distances between opposite faces of the reduced box, mm. No grain is nearer than the smallest of them to
  /// an image of itself. Where they are >= some range, wrapped grains within that range of each other meet
  /// through one of the 27 images of `shifts`.
  Vec3 heights() const;
  double narrowest() const;

  /// Parts of the reduced edges that make up x.
  Vec3 fractions(const Vec3& x) const {
    if (tilted_) return to_fractions_ * x;
    return {x[0] / edges_(0, 0), x[1] / edges_(1, 1), x[2] / edges_(2, 2)};
  }
  /// The image in the reduced box: fractions in [0, 1), in a tilted one to rounding.
  Vec3 wrap(Vec3 x) const {
    if (tilted_) return wrap_tilted(x);
    for (std::size_t c = 0; c < 3; ++c) {
      const double length = edges_(c, c);
      x[c] -= length * std::floor(x[c] / length);
      if (x[c] < 0 || x[c] >= length) x[c] = 0;  // rounding at a face
    }
    return x;
  }
  /// The shortest image of a difference of positions. Unique only within half a box; the engine itself uses
  /// `shifts`, which also hold where a grain touches several images of another.
  Vec3 nearest_image(Vec3 d) const {
    if (tilted_) return nearest_tilted(d);
    for (std::size_t c = 0; c < 3; ++c) d[c] -= edges_(c, c) * std::round(d[c] / edges_(c, c));
    return d;
  }

  /// F of the deformation since the edges were these: H = F H_before.
  Mat3 deformation_from(const Mat3& edges_before) const;
  /// Logarithmic (Hencky) strain since then, compression positive: -ln V of F = V R, along the present
  /// axes. Its trace is ln(V_before/V), with V the volume.
  Sym6 strain_from(const Mat3& edges_before) const;
  /// Velocity of the affine motion at x (or of a separation x), mm/us.
  Vec3 affine_velocity(const Vec3& x) const {
    if (tilted_) return gradient_ * x;
    return {gradient_(0, 0) * x[0], gradient_(1, 1) * x[1], gradient_(2, 2) * x[2]};
  }

  /// Images are numbered 0 ... 26; `image_number(a, b, c)` with a, b, c in -1 ... 1 lies that many of the
  /// reduced edges away (of an orthorhombic box: a Lx, b Ly, c Lz).
  static constexpr unsigned home_image = 13;
  static constexpr unsigned image_number(int a, int b, int c) {
    return static_cast<unsigned>((a + 1) + 3 * (b + 1) + 9 * (c + 1));
  }
  /// The translations of the 27 images, mm.
  std::array<Quad, 27> shifts() const;

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.edges_, self.gradient_, self.tilted_, self.basis_, self.to_fractions_);
  }

 private:
  Vec3 wrap_tilted(const Vec3& x) const;
  Vec3 nearest_tilted(const Vec3& d) const;
  /// The translation by so many edges of H: the same number whichever edges images are counted in.
  Vec3 translation(const Vec3& images) const { return edges_ * (basis_ * images); }

  Mat3 edges_ = Mat3::identity(), gradient_;
  bool tilted_ = false;
  Mat3 basis_ = Mat3::identity();
  Mat3 to_fractions_;  ///< (H M)^-1, only in a tilted box
};

/// A bound of the smallest singular value of F from below, at most 1: no separation shrinks by more.
double least_stretch(const Mat3& deformation);

}  // namespace grainlaw::dem
