#include "grainlaw/dem/observe/percolation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace grainlaw::dem::observe {

namespace {

/// A displacement in whole edges of H.
using Images = std::array<int, 3>;

Images operator+(const Images& a, const Images& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Images operator-(const Images& a, const Images& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Disjoint sets of grains, each grain with the image by which it hangs together with the others.
class Clusters {
 public:
  explicit Clusters(std::size_t count) : parent_(count), image_(count), size_(count, 1), wraps_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  struct Place {
    std::uint32_t root;
    Images image;  ///< relative to the root's
  };
  Place find(std::uint32_t i) {
    Images sum{};
    std::uint32_t root = i;
    while (parent_[root] != root) {
      sum = sum + image_[root];
      root = parent_[root];
    }
    for (Images left = sum; parent_[i] != i && parent_[i] != root;) {  // hang all on the way onto the root
      const std::uint32_t next = parent_[i];
      const Images step = image_[i];
      parent_[i] = root;
      image_[i] = left;
      left = left - step;
      i = next;
    }
    return {root, sum};
  }

  /// Grain i touches the image of j displaced by `image`.
  void join(std::uint32_t i, std::uint32_t j, const Images& image) {
    const auto [a, of_i] = find(i);
    const auto [b, of_j] = find(j);
    const Images apart = of_i + image - of_j;  // of root b as seen from root a
    if (a == b) {
      for (std::size_t c = 0; c < 3; ++c) wraps_[a][c] = wraps_[a][c] || apart[c] != 0;
      return;
    }
    const bool swap = size_[a] < size_[b];
    const std::uint32_t top = swap ? b : a, below = swap ? a : b;
    parent_[below] = top;
    image_[below] = swap ? Images{} - apart : apart;
    size_[top] += size_[below];
    for (std::size_t c = 0; c < 3; ++c) wraps_[top][c] = wraps_[top][c] || wraps_[below][c];
  }

  std::uint32_t size(std::uint32_t root) const { return size_[root]; }
  const std::array<bool, 3>& wraps(std::uint32_t root) const { return wraps_[root]; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<Images> image_;  ///< relative to the parent's
  std::vector<std::uint32_t> size_;
  std::vector<std::array<bool, 3>> wraps_;
};

/// Parts of the edges H that make up x. The cell's own fractions are of edges H M, which it chooses anew as
/// it tilts: x = H M s, so H has M s of them, whatever M is.
Vec3 along_edges(const Cell& cell, const Vec3& x) { return cell.basis() * cell.fractions(x); }

/// Which image of j a contact of i is with.
Images image_of(const Touch& c, const View& view) {
  const Quad &a = view.grains().place[c.i], &b = view.grains().place[c.j];
  const Vec3 edges =
      along_edges(view.cell(), {a.x - b.x - c.branch[0], a.y - b.y - c.branch[1], a.z - b.z - c.branch[2]});
  Images image{};
  for (std::size_t k = 0; k < 3; ++k) image[k] = static_cast<int>(std::lround(edges[k]));
  return image;
}

/// Extents of all clusters as fractions of the edges H, centre to centre.
std::vector<Vec3> extents(Clusters& clusters, const View& view) {
  const Grains& grains = view.grains();
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<Vec3> low(grains.count(), {far, far, far}), high(grains.count(), {-far, -far, -far});
  for (std::uint32_t i = 0; i < grains.count(); ++i) {
    const auto [root, image] = clusters.find(i);
    const Quad& x = grains.place[i];
    const Vec3 place = along_edges(view.cell(), {x.x, x.y, x.z});
    for (std::size_t c = 0; c < 3; ++c) {
      const double at = place[c] + image[c];
      low[root][c] = std::min(low[root][c], at);
      high[root][c] = std::max(high[root][c], at);
    }
  }
  for (std::size_t i = 0; i < low.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) low[i][c] = high[i][c] - low[i][c];
  return low;
}

/// The largest cluster, none of one grain: which edges it percolates along, and its extents.
struct Largest {
  std::uint32_t grains = 1;
  std::array<bool, 3> wraps{};
  Vec3 extent{};

  int axes() const { return wraps[0] + wraps[1] + wraps[2]; }
  /// Of two as large the one that percolates along more axes, along x rather than y rather than z, or the
  /// more extended: whole numbers first, so that rounding and the order of the grains hardly choose.
  auto rank() const { return std::tuple(grains, axes(), wraps, extent[0] + extent[1] + extent[2]); }
};

Largest largest_of(Clusters& clusters, const View& view) {
  const std::vector<Vec3> extent = extents(clusters, view);
  Largest best;
  for (std::uint32_t i = 0; i < extent.size(); ++i) {
    if (clusters.find(i).root != i || clusters.size(i) < 2) continue;
    Largest other{clusters.size(i), clusters.wraps(i), extent[i]};
    for (double& part : other.extent) part = std::min(part, 1.0);
    if (other.rank() > best.rank()) best = other;
  }
  return best;
}

}  // namespace

std::array<double, 7> Percolation::values(const View& view) const {
  const double threshold = strong * view.network.mean_force;
  if (!(threshold > 0)) return {};  // no contacts, or none that bear
  Clusters clusters(view.grains().count());
  for (const Touch& c : view.network.contacts)
    if (c.force >= threshold) clusters.join(c.i, c.j, image_of(c, view));
  const Largest largest = largest_of(clusters, view);
  std::array<double, 7> result{};
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = largest.wraps[c] ? 1 : largest.extent[c];
    result[4 + c] = largest.wraps[c] ? 1 : 0;
  }
  result[3] = largest.axes();
  return result;
}

}  // namespace grainlaw::dem::observe
