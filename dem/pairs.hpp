// The list of pairs that may touch, each pair once, and the walk over those that do.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/box.hpp"
#include "grainlaw/dem/grains.hpp"

namespace grainlaw::dem {

/// Most pairs lie within the box and need no image; those that meet through a face of it are kept apart, with
/// the image of j that i meets. So the loop over pairs never searches for the nearest image, and a small box
/// may hold the same pair twice, through different images.
struct Pairs {
  std::vector<std::uint32_t> begin{0};  ///< pairs of grain i: partner[begin[i]] ... partner[begin[i+1]-1]
  std::vector<std::uint32_t> partner;
  struct Crossing {
    std::uint32_t i, j, image;
  };
  std::vector<Crossing> crossing;

  std::size_t count() const { return partner.size() + crossing.size(); }
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
void for_each_contact(const Pairs& pairs, const Grains& grains, const Box& box, F&& f) {
  const auto visit = [&](std::uint32_t i, std::uint32_t j, const Quad& shift) {
    const Quad &a = grains.place[i], &b = grains.place[j];
    const Vec3 d{a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z};
    const double reach = a.w + b.w, squared = dot(d, d);
    if (squared > reach * reach) return;
    const double distance = std::sqrt(squared);
    f(Contact{i, j, d, distance, reach - distance});
  };
  const std::array<Quad, 27> shifts = box.shifts();
  for (std::uint32_t i = 0; i + 1 < pairs.begin.size(); ++i)
    for (std::uint32_t p = pairs.begin[i]; p < pairs.begin[i + 1]; ++p)
      visit(i, pairs.partner[p], shifts[Box::home_image]);
  for (const auto& [i, j, image] : pairs.crossing) visit(i, j, shifts[image]);
}

}  // namespace grainlaw::dem
