// The list of pairs that may touch, each pair once, and the walk over those that do.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"

namespace grainlaw::dem {

/// Pairs in groups: eight grains at a time, each with its partners, filled up to as many as the one of them
/// with the most has. So the force loop keeps eight grains in registers while it walks through their
/// partners.
struct GroupedPairs {
  static constexpr std::size_t width = 8;
  /// A group's grains lie in one of the runs of so many that begin at 0; groups stand in the order of these.
  static constexpr std::uint32_t block = 256;
  struct Group {
    std::array<std::uint32_t, width> grain;
    std::uint32_t first, last;  ///< their partners: eight at a time, one for each grain
  };
  std::vector<Group> groups;
  std::vector<std::uint32_t> partner;  ///< a place that is filled up holds the grain itself
  std::size_t count = 0;               ///< without what fills up
  std::uint32_t reach = 0;             ///< partner - grain is at most so much

  /// The first grain of share k of so many, all of which are whole runs.
  static std::uint32_t begin_of(std::size_t grains, std::size_t k, std::size_t shares) {
    const std::size_t runs = (grains + block - 1) / block;
    return static_cast<std::uint32_t>(std::min(grains, runs * k / shares * block));
  }

  /// Calls f(i, j) for every pair.
  template <class F>
  void for_each(F&& f) const {
    for (const Group& group : groups)
      for (std::uint32_t p = group.first; p < group.last; ++p)
        if (const std::uint32_t i = group.grain[p % width]; partner[p] != i) f(i, partner[p]);
  }
};

/// Some groups of a list, and its partners; how many grains there are, and `reach` of the list.
struct Groups {
  std::span<const GroupedPairs::Group> groups;
  const std::uint32_t* partner;
  std::size_t grains;
  std::uint32_t reach;
};

/// Pairs that meet through a face of the box, eight at a time.
struct CrossingPairs {
  static constexpr std::size_t width = 8;
  struct Pair {
    std::uint32_t i, j, image;  ///< `image` of j that i meets
  };
  std::vector<Pair> pairs;
  std::size_t count = 0;  ///< without those that fill up the last eight: pairs of a grain with itself

  void fill_up() {
    count = pairs.size();
    pairs.resize((count + width - 1) / width * width, {0, 0, Cell::home_image});
  }
};

/// Pairs within the box, eight at a time, of which the forces on the second grain alone are wanted.
struct HaloPairs {
  static constexpr std::size_t width = 8;
  struct Pair {
    std::uint32_t i, j;
  };
  std::vector<Pair> pairs;  ///< those that fill up the last eight are of a grain with itself
};

/// Most pairs lie within the box and need no image; those that meet through a face of it are kept apart, with
/// the image of j that i meets. So the loop over pairs never searches for the nearest image, and a small box
/// may hold the same two grains twice, through different images.
struct Pairs {
  GroupedPairs within;
  CrossingPairs crossing;
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
  const auto visit = [&](std::uint32_t i, std::uint32_t j, const Quad& shift) {
    const Quad &a = grains.place[i], &b = grains.place[j];
    const Vec3 d{a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z};
    const double distance = norm(d), reach = a.w + b.w;
    if (distance <= reach) f(Contact{i, j, d, distance, reach - distance});
  };
  const std::array<Quad, 27> shifts = cell.shifts();
  pairs.within.for_each([&](std::uint32_t i, std::uint32_t j) { visit(i, j, shifts[Cell::home_image]); });
  for (std::size_t p = 0; p < pairs.crossing.count; ++p) {
    const auto& [i, j, image] = pairs.crossing.pairs[p];
    visit(i, j, shifts[image]);
  }
}

}  // namespace grainlaw::dem
