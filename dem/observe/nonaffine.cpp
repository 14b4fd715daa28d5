#include "grainlaw/dem/observe/nonaffine.hpp"

#include <algorithm>
#include <optional>

#include "grainlaw/dem/packing/linked_cells.hpp"

namespace grainlaw::dem::observe {

namespace {

constexpr std::uint32_t fewest_neighbours = 4;
constexpr double flat = 1e-6;  ///< det Y over (tr Y/3)^3 below which neighbours lie in a plane

Nonaffine::Row row_of(const View& view) {
  const Grains& grains = view.grains();
  Nonaffine::Row row{view.cell(), Quads(grains.count())};
  row.cell.reduce();
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Quad& p = grains.place[i];
    const Vec3 x = row.cell.wrap({p.x, p.y, p.z});
    row.place[grains.id[i]] = {x[0], x[1], x[2], p.w};
  }
  return row;
}

/// Sums over the neighbours of a grain, with c = b - E b0 what a branch moved beyond the affine motion of the
/// box: the least of sum |c - K b0|^2 is the same as with b, and does not lose its digits.
struct Sums {
  Sym6 Y{};                 ///< sum b0 (x) b0
  std::array<Vec3, 3> X{};  ///< sum c (x) b0
  double squares = 0;       ///< sum |c|^2
  std::uint32_t count = 0;

  void add(const Vec3& b0, const Vec3& c) {
    add_dyad(Y, 1, b0);
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l) X[k][l] += c[k] * b0[l];
    squares += dot(c, c);
    ++count;
  }
  /// (1/n) (sum |c|^2 - tr X Y^-1 X^T); nothing where Y cannot be inverted.
  std::optional<double> least() const;
};

std::optional<double> Sums::least() const {
  if (count < fewest_neighbours) return std::nullopt;
  const auto [xx, yy, zz, yz, xz, xy] = Y;
  const Sym6 adjoint{yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy,
                     xz * xy - xx * yz, xy * yz - yy * xz, xz * yz - zz * xy};
  const double determinant = xx * adjoint[0] + xy * adjoint[5] + xz * adjoint[4];
  const double scale = trace(Y) / 3;
  if (!(determinant > flat * scale * scale * scale)) return std::nullopt;
  double explained = 0;
  for (const Vec3& x : X)
    explained += adjoint[0] * x[0] * x[0] + adjoint[1] * x[1] * x[1] + adjoint[2] * x[2] * x[2] +
                 2 * (adjoint[3] * x[1] * x[2] + adjoint[4] * x[0] * x[2] + adjoint[5] * x[0] * x[1]);
  return std::max(squares - explained / determinant, 0.0) / static_cast<double>(count);
}

/// The neighbours at `before`, each pair once: f(i, j, branch from j's image to i).
template <class F>
void for_each_neighbour(const Nonaffine::Row& before, double wanted_gap, F&& f) {
  const Cell& cell = before.cell;
  double widest = 0;
  for (const Quad& p : before.place) widest = std::max(widest, 2 * p.w);
  const double range = std::min(widest + wanted_gap, cell.narrowest());
  const LinkedCells cells(before.place, cell, range);
  const std::vector<std::uint32_t>& order = cells.order();
  Quads place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place[i] = before.place[order[i]];
  NearPairs pairs;
  cells.list_pairs(place, cell, range - widest, pairs);
  const auto visit = [&](std::uint32_t i, std::uint32_t j, const Quad& shift) {
    const Quad &a = place[i], &b = place[j];
    f(order[i], order[j], Vec3{a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z});
  };
  for (std::uint32_t i = 0; i < order.size(); ++i)
    for (std::uint32_t p = pairs.begin[i]; p < pairs.begin[i + 1]; ++p) visit(i, pairs.partner[p], {});
  const std::array<Quad, 27> shifts = cell.shifts();
  for (const auto& [i, j, image] : pairs.crossing) visit(i, j, shifts[image]);
}

/// Mean over grains, mm^2.
double mean_rearrangement(const Nonaffine::Row& before, const Nonaffine::Row& now, double gap) {
  const Mat3 deformation = now.cell.deformation_from(before.cell.edges());
  std::vector<Sums> sums(now.place.size());
  for_each_neighbour(before, gap, [&](std::uint32_t i, std::uint32_t j, const Vec3& b0) {
    const Quad &a = now.place[i], &b = now.place[j];
    const Vec3 carried = deformation * b0;
    // Branches change by less than half a box from row to row, so the nearest image is the one they had.
    const Vec3 c =
        now.cell.nearest_image({a.x - b.x - carried[0], a.y - b.y - carried[1], a.z - b.z - carried[2]});
    sums[i].add(b0, c);
    sums[j].add(b0, c);
  });
  double sum = 0;
  std::uint64_t count = 0;
  for (const Sums& s : sums)
    if (const auto least = s.least()) {
      sum += *least;
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : undefined;
}

}  // namespace

std::array<double, 1> Nonaffine::values(const View& view) {
  Row now = row_of(view);
  const double r = view.material.r_mean;
  const double result = last_.place.empty() ? undefined : mean_rearrangement(last_, now, gap * r) / (r * r);
  last_ = std::move(now);
  return {result};
}

}  // namespace grainlaw::dem::observe
