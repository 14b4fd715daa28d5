// The list of pairs that may touch, each pair once, and the walk over those that do.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/cell.hpp"
#include "grainlaw/dem/grains.hpp"

namespace grainlaw::dem {

/// Pairs in the order in which the force loop takes them, four at a time.
struct PairList {
  struct Pair {
    std::uint32_t i, j;
  };
  std::vector<Pair> pairs;
  std::vector<double> reach;         ///< r_i + r_j, mm
  std::vector<std::uint32_t> image;  ///< of j that i meets; only where pairs cross a face of the box
  std::size_t count = 0;             ///< without the pairs that fill up the last four

  /// Pairs taken at a time; lists are filled up to a multiple of it with pairs that never touch (i = j, reach
  /// < 0).
  static constexpr std::size_t group = 4;
  void fill_up() {
    count = pairs.size();
    const std::size_t whole = (count + group - 1) / group * group;
    pairs.resize(whole, {0, 0});
    reach.resize(whole, -1.0);
    if (!image.empty()) image.resize(whole, Cell::home_image);
  }
};

/// Most pairs lie within the box and need no image; those that meet through a face of it are kept apart, with
/// the image of j that i meets. So the loop over pairs never searches for the nearest image, and a small box
/// may hold the same two grains twice, through different images.
struct Pairs {
  PairList within, crossing;
  std::size_t count() const { return within.count + crossing.count; }
};

/// One contact as observers see it.
struct Contact {
  std::uint32_t i, j;
  Vec3 branch;  ///< from the centre of j (its image) to the centre of i, mm
  double distance;
  double overlap;  ///< >= 0
};

/// Calls f(Contact) for every pair with overlap >= 0.
template <class F>
void for_each_contact(const Pairs& pairs, const Grains& grains, const Cell& cell, F&& f) {
  const auto visit = [&](const PairList& list, std::size_t p, const Quad& shift) {
    const auto [i, j] = list.pairs[p];
    const Quad &a = grains.place[i], &b = grains.place[j];
    const Vec3 d{a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z};
    const double distance = norm(d);
    if (distance <= list.reach[p]) f(Contact{i, j, d, distance, list.reach[p] - distance});
  };
  const std::array<Quad, 27> shifts = cell.shifts();
  for (std::size_t p = 0; p < pairs.within.count; ++p) visit(pairs.within, p, shifts[Cell::home_image]);
  for (std::size_t p = 0; p < pairs.crossing.count; ++p)
    visit(pairs.crossing, p, shifts[pairs.crossing.image[p]]);
}

}  // namespace grainlaw::dem
