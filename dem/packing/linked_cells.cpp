#include "grainlaw/dem/packing/linked_cells.hpp"

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

[[noreturn]] void throw_same_point(const Quad& a) {
  throw Error("two grains lie at the same point (" + to_text(a.x) + ", " + to_text(a.y) + ", " +
              to_text(a.z) + ") mm: the direction of their contact is undefined");
}

/// A cell beside another, or several in a row, and the image of the box in which they lie.
struct Beside {
  std::uint32_t first, last, image;
};

}  // namespace

LinkedCells::LinkedCells(const Quads& place, const Cell& cell, double range) {
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

void LinkedCells::list_pairs(const Quads& place, const Cell& cell, double skin, NearPairs& pairs) const {
  static const std::vector<std::array<int, 3>> forward = forward_neighbours();
  const std::array<Quad, 27> shifts = cell.shifts();
  pairs.begin.assign(1, 0);
  pairs.crossing.clear();
  pairs.reach = 0;
  std::size_t n = 0;
  const auto apart = [&](std::uint32_t i, std::uint32_t j, std::uint32_t image) {
    const Quad &a = place[i], &b = place[j], &shift = shifts[image];
    const double x = a.x - b.x - shift.x, y = a.y - b.y - shift.y, z = a.z - b.z - shift.z;
    return x * x + y * y + z * z;
  };
  const auto near = [&](std::uint32_t i, std::uint32_t j, double squared) {
    const double reach = place[i].w + place[j].w + skin;
    if (squared == 0) throw_same_point(place[i]);
    return squared < reach * reach;
  };
  const auto list_home = [&](std::uint32_t i, std::uint32_t first, std::uint32_t last) {
    if (first == last) return;
    pairs.partner.resize(std::max<std::size_t>(pairs.partner.size(), n + last - first));
    pairs.reach = std::max(pairs.reach, last - 1 - i);
    for (std::uint32_t j = first; j < last; ++j) {
      pairs.partner[n] = j;  // kept or overwritten by the next one: no branch to mispredict
      n += near(i, j, apart(i, j, Cell::home_image)) ? 1u : 0u;
    }
  };
  const auto list_crossing = [&](std::uint32_t i, const Beside& b) {
    for (std::uint32_t j = b.first; j < b.last; ++j)
      // Its own image is out of reach in a box at least `range` wide.
      if (i != j && near(i, j, apart(i, j, b.image))) pairs.crossing.push_back({i, j, b.image});
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
          const std::uint32_t number = Cell::image_number(image[0], image[1], image[2]);
          // Cells side by side along z make one run of grains.
          if (!beside.empty() && beside.back().image == number && beside.back().last == begin_[k])
            beside.back().last = begin_[k + 1];
          else
            beside.push_back({begin_[k], begin_[k + 1], number});
        }
        const auto k = static_cast<std::size_t>((at[0] * count_[1] + at[1]) * count_[2] + at[2]);
        for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
          list_home(i, i + 1, begin_[k + 1]);
          for (const Beside& b : beside) {
            if (b.image == Cell::home_image)
              list_home(i, b.first, b.last);
            else
              list_crossing(i, b);
          }
          pairs.begin.push_back(static_cast<std::uint32_t>(n));
        }
      }
  pairs.partner.resize(n);
}

}  // namespace grainlaw::dem
