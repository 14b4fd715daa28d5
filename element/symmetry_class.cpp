#include "grainlaw/element/symmetry_class.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {

constexpr Rotation box{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

Stiffness symmetric(Stiffness c) {
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < a; ++b) c[a][b] = c[b][a] = 0.5 * (c[a][b] + c[b][a]);
  return c;
}

Rotation transposed(const Rotation& r) {
  Rotation t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[i][j] = r[j][i];
  return t;
}

/// b after a.
Rotation product(const Rotation& b, const Rotation& a) {
  Rotation p{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) p[i][j] += b[i][k] * a[k][j];
  return p;
}

/// By `angle` about axis k.
Rotation about(std::size_t k, double angle) {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  Rotation r = box;
  r[i][i] = r[j][j] = std::cos(angle);
  r[i][j] = std::sin(angle);
  r[j][i] = -r[i][j];
  return r;
}

/// A frame whose z axis is this direction.
Rotation frame_of(const Direction& axis) {
  const double size = std::hypot(axis[0], axis[1], axis[2]);
  if (!(size > 0)) throw Error("a symmetry needs an axis, got a direction of length 0");
  const double polar = std::acos(axis[2] / size), azimuth = std::atan2(axis[1], axis[0]);
  return product(about(1, polar), about(2, azimuth));
}

/// About z.
Stiffness transversely_isotropic(const Stiffness& c) {
  Stiffness t{};
  t[0][0] = t[1][1] = 3.0 / 8 * (c[0][0] + c[1][1]) + 0.25 * c[0][1] + 0.5 * c[5][5];
  t[0][1] = t[1][0] = 1.0 / 8 * (c[0][0] + c[1][1]) + 0.75 * c[0][1] - 0.5 * c[5][5];
  t[0][2] = t[2][0] = t[1][2] = t[2][1] = 0.5 * (c[0][2] + c[1][2]);
  t[2][2] = c[2][2];
  t[3][3] = t[4][4] = 0.5 * (c[3][3] + c[4][4]);
  t[5][5] = 0.5 * (t[0][0] - t[0][1]);
  return t;
}

Stiffness orthotropic(const Stiffness& c) {
  Stiffness o{};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) o[a][b] = a == b || (a < 3 && b < 3) ? c[a][b] : 0;
  return o;
}

/// Turns the frame about its own axes by steps that halve, as long as `value` rises: a local maximum.
template <class F>
Rotation climb(Rotation frame, const F& value) {
  constexpr double finest = 1e-6;
  double best = value(frame);
  for (double step = 0.2; step > finest;) {
    bool rose = false;
    for (std::size_t k = 0; k < 3; ++k)
      for (const double angle : {step, -step}) {
        const Rotation next = product(about(k, angle), frame);
        const double here = value(next);
        if (!(here > best)) continue;
        best = here;
        frame = next;
        rose = true;
      }
    if (!rose) step *= 0.5;
  }
  return frame;
}

/// Of several starts the best, the box's own frame first.
template <class F>
Rotation highest(const F& value) {
  constexpr double eighth = std::numbers::pi / 4;
  Rotation best = box;
  double most = -1;
  for (const Rotation& start :
       {box, about(0, 2 * eighth), about(1, 2 * eighth), about(0, eighth), about(1, eighth), about(2, eighth),
        product(about(0, eighth), about(1, eighth)), product(about(2, eighth), about(0, eighth))}) {
    const Rotation frame = climb(start, value);
    const double here = value(frame);
    if (!(here > most)) continue;
    most = here;
    best = frame;
  }
  return best;
}

Direction pointing_up(Direction axis) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(axis[k]) > std::abs(axis[largest])) largest = k;
  if (axis[largest] < 0)
    for (double& a : axis) a = -a;
  return axis;
}

}  // namespace

Stiffness isotropic_part(const Stiffness& c) {
  double of_volume = 0, of_all = 0;  // 9 K and 3 K + 10 mu
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) of_volume += c[a][b];
  for (std::size_t a = 0; a < 6; ++a) of_all += (a < 3 ? 1 : 2) * c[a][a];
  const double bulk = of_volume / 9, shear = (of_all - 3 * bulk) / 10;
  Stiffness part{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) part[a][b] = bulk - 2.0 / 3 * shear;
    part[a][a] += 2 * shear;
    part[a + 3][a + 3] = shear;
  }
  return part;
}

Stiffness transversely_isotropic_part(const Stiffness& c, const Direction& axis) {
  const Rotation frame = frame_of(axis);
  return rotated(transversely_isotropic(rotated(symmetric(c), frame)), transposed(frame));
}

Stiffness orthotropic_part(const Stiffness& c, const Rotation& frame) {
  return rotated(orthotropic(rotated(symmetric(c), frame)), transposed(frame));
}

double share(const Stiffness& part, const Stiffness& c) {
  const double ratio = norm(part) / norm(c);
  return ratio * ratio;
}

SymmetryClass symmetry_class(const Stiffness& stiffness) {
  const Stiffness c = symmetric(stiffness);
  SymmetryClass result;
  result.isotropic = share(isotropic_part(c), c);
  for (std::size_t k = 0; k < 3; ++k)
    result.transversely_isotropic[k] = share(transversely_isotropic_part(c, box[k]), c);
  result.orthotropic = share(orthotropic(c), c);
  const auto of_axis = [&](const Rotation& f) { return share(transversely_isotropic(rotated(c, f)), c); };
  const auto of_frame = [&](const Rotation& f) { return share(orthotropic(rotated(c, f)), c); };
  const Rotation along = highest(of_axis);
  result.best_axis = pointing_up(along[2]);
  result.best_transversely_isotropic = of_axis(along);
  result.best_frame = highest(of_frame);
  result.best_orthotropic = of_frame(result.best_frame);
  return result;
}

}  // namespace grainlaw
