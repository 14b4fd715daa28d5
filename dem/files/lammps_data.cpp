#include "grainlaw/dem/files/lammps_data.hpp"

#include <array>
#include <cmath>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

Vec3 scaled(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Along a, of length 1: to the last bit where a is along an axis.
Vec3 direction(const Vec3& a) {
  const double length = norm(a);
  return {a[0] / length + 0.0, a[1] / length + 0.0, a[2] / length + 0.0};  // 0 rather than -0
}

Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Takes whole multiples of column k off column c, so that entry (k, c) is at most half of (k, k).
void shorten_tilt(Mat3& edges, std::size_t k, std::size_t c) {
  const double n = std::round(edges(k, c) / edges(k, k));
  for (std::size_t r = 0; r <= k; ++r) edges(r, c) -= n * edges(r, k);
}

std::string numbers(const Vec3& x) {
  std::string text;
  for (const double component : x) text += " " + to_text(component);
  return text;
}

std::string box_text(const LammpsBox& box, bool tilted) {
  const std::array<const char*, 3> bounds{" xlo xhi\n", " ylo yhi\n", " zlo zhi\n"};
  std::string text;
  for (std::size_t c = 0; c < 3; ++c) text += "0 " + to_text(box.edges(c, c)) + bounds[c];
  if (!tilted) return text;
  text += to_text(box.edges(0, 1)) + " " + to_text(box.edges(0, 2)) + " " + to_text(box.edges(1, 2)) +
          " xy xz yz\n";
  const std::array<const char*, 3> axes{"x", "y", "z"};
  for (std::size_t r = 0; r < 3; ++r)
    text += std::string("# ") + axes[r] + " in the frame of the snapshot:" + numbers(box.turn.row(r)) + "\n";
  return text;
}

}  // namespace

LammpsBox::LammpsBox(const Mat3& box) {
  const Cell cell(box);
  const Mat3 shortest = box * cell.basis();
  const Vec3 a = shortest.column(0), b = shortest.column(1), c = shortest.column(2);
  const Vec3 x = direction(a);
  const Vec3 across = difference(b, scaled(dot(b, x), x));
  const Vec3 y = direction(across), z = direction(inverse(shortest).row(2));  // z across a and b
  turn = {x, y, z};
  edges = {{norm(a), dot(b, x), dot(c, x)}, {0, norm(across), dot(c, y)}, {0, 0, dot(c, z)}};
  shorten_tilt(edges, 1, 2);
  shorten_tilt(edges, 0, 2);
  shorten_tilt(edges, 0, 1);
  to_parts = inverse(edges);
}

Vec3 LammpsBox::place(const Vec3& x) const {
  const Vec3 at = turn * x, parts = to_parts * at;
  return difference(at, edges * Vec3{std::floor(parts[0]), std::floor(parts[1]), std::floor(parts[2])});
}

std::string lammps_data(const State& state, const Material& material) {
  const Cell cell(state.box);
  const LammpsBox box(state.box);
  const bool tilted = cell.tilted();
  std::string text =
      "Packing of grainlaw in mm, us, ug\n\n" + std::to_string(state.count()) + " atoms\n1 atom types\n\n";
  text += box_text(box, tilted) + "\nAtoms # sphere\n\n";
  const std::string rho = to_text(material.rho);
  for (std::size_t i = 0; i < state.count(); ++i) {
    text += std::to_string(i + 1) + " 1 " + to_text(2 * state.radius[i]) + " " + rho;
    text += numbers(tilted ? box.place(state.position[i]) : cell.wrap(state.position[i])) + "\n";
  }
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < state.count(); ++i)
    text += std::to_string(i + 1) + numbers(tilted ? box.turn * state.velocity[i] : state.velocity[i]) +
            " 0 0 0\n";
  return text;
}

}  // namespace grainlaw::dem
