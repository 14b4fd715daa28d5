#include "grainlaw/dem/linked_cells.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

/// The half of the 26 neighbours of a cell that comes after it, so that each pair of cells is met once.
std::vector<std::array<int, 3>> forward_neighbours() {
  std::vector<std::array<int, 3>> list;
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      for (int c = -1; c <= 1; ++c)
        if (9 * a + 3 * b + c > 0) list.push_back({a, b, c});
  return list;
}

/// A cell beside another, and the image of the box in which it lies.
struct Beside {
  std::uint32_t first, last, image;
};

}  // namespace

LinkedCells::LinkedCells(const std::vector<Quad>& place, const Cell& cell, double range) {
  // Not many more cells than grains: a dilute box would spend its time on empty ones.
  const double widest =
      std::cbrt(cell.volume() / static_cast<double>(std::max<std::size_t>(place.size(), 1)));
  const Vec3 height = cell.heights();
  for (std::size_t c = 0; c < 3; ++c)
    count_[c] = std::max(1, static_cast<int>(height[c] / std::max(range, widest)));
  const auto along = [&](const Vec3& part, std::size_t c) {
    return std::clamp(static_cast<int>(part[c] * count_[c]), 0, count_[c] - 1);
  };
  std::vector<std::uint32_t> home(place.size());
  begin_.assign(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                        static_cast<std::size_t>(count_[2]) +
                    1,
                0);
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Vec3 part = cell.fractions({place[i].x, place[i].y, place[i].z});
    home[i] = static_cast<std::uint32_t>((along(part, 0) * count_[1] + along(part, 1)) * count_[2] +
                                         along(part, 2));
    ++begin_[home[i] + 1];
  }
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  order_.resize(place.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) order_[next[home[i]]++] = i;
}

void LinkedCells::list_pairs(const std::vector<Quad>& place, const Cell& cell, double skin,
                             NearPairs& pairs) const {
  static const std::vector<std::array<int, 3>> forward = forward_neighbours();
  const std::array<Quad, 27> shifts = cell.shifts();
  pairs.begin.assign(1, 0);
  pairs.partner.clear();
  pairs.crossing.clear();
  const auto consider = [&](std::uint32_t i, std::uint32_t j, std::uint32_t image) {
    if (i == j) return;  // its own image, out of reach in a box at least `range` wide
    const Quad &a = place[i], &b = place[j], &shift = shifts[image];
    const double x = a.x - b.x - shift.x, y = a.y - b.y - shift.y, z = a.z - b.z - shift.z;
    const double squared = x * x + y * y + z * z, reach = a.w + b.w + skin;
    if (squared >= reach * reach) return;
    if (squared == 0)
      throw Error("two grains lie at the same point (" + to_text(a.x) + ", " + to_text(a.y) + ", " +
                  to_text(a.z) + ") mm: the direction of their contact is undefined");
    if (image == Cell::home_image)
      pairs.partner.push_back(j);
    else
      pairs.crossing.push_back({i, j, image});
  };
  std::vector<Beside> beside;
  std::array<int, 3> at{};
  for (at[0] = 0; at[0] < count_[0]; ++at[0])
    for (at[1] = 0; at[1] < count_[1]; ++at[1])
      for (at[2] = 0; at[2] < count_[2]; ++at[2]) {
        beside.clear();
        for (const auto& offset : forward) {
          std::array<int, 3> other{}, image{};
          for (std::size_t c = 0; c < 3; ++c) {
            other[c] = at[c] + offset[c];
            image[c] = other[c] < 0 ? -1 : other[c] >= count_[c] ? 1 : 0;
            other[c] -= image[c] * count_[c];
          }
          const auto k = static_cast<std::size_t>((other[0] * count_[1] + other[1]) * count_[2] + other[2]);
          if (begin_[k] < begin_[k + 1])
            beside.push_back({begin_[k], begin_[k + 1], Cell::image_number(image[0], image[1], image[2])});
        }
        const auto k = static_cast<std::size_t>((at[0] * count_[1] + at[1]) * count_[2] + at[2]);
        for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
          for (std::uint32_t j = i + 1; j < begin_[k + 1]; ++j) consider(i, j, Cell::home_image);
          for (const Beside& b : beside)
            for (std::uint32_t j = b.first; j < b.last; ++j) consider(i, j, b.image);
          pairs.begin.push_back(static_cast<std::uint32_t>(pairs.partner.size()));
        }
      }
}

}  // namespace grainlaw::dem
