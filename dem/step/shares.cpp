#include "grainlaw/dem/step/shares.hpp"

#include <algorithm>
#include <array>

namespace grainlaw::dem {

namespace {

/// In what order loops of so many lanes add the forces of eight pairs: of lane k and then of lane k + lanes
/// - 4.
std::array<std::size_t, 8> order_of_lanes(std::size_t lanes) {
  return lanes == 8 ? std::array<std::size_t, 8>{0, 4, 1, 5, 2, 6, 3, 7}
                    : std::array<std::size_t, 8>{0, 1, 2, 3, 4, 5, 6, 7};
}

/// Pairs one after the other, each put into the lane in which its force is added when its turn comes.
class InOrder {
 public:
  InOrder(CrossingPairs& list, std::size_t lanes) : list_(list), order_(order_of_lanes(lanes)) {
    list_.pairs.clear();
    list_.count = 0;
  }
  void push(std::uint32_t i, std::uint32_t j) {
    const std::size_t lane = list_.count % CrossingPairs::width;
    if (lane == 0) list_.pairs.resize(list_.count + CrossingPairs::width, {0, 0, Cell::home_image});
    list_.pairs[list_.count - lane + order_[lane]] = {i, j, Cell::home_image};
    ++list_.count;
  }

 private:
  CrossingPairs& list_;
  std::array<std::size_t, 8> order_;
};

/// The pairs of the groups before this share's whose partners lie in it, in the order in which the loop over
/// the groups adds their forces: that through all groups, as many lanes at a time.
void deal_halo(const GroupedPairs& all, std::size_t lanes, Share& share) {
  constexpr auto width = static_cast<std::uint32_t>(GroupedPairs::width);
  const std::array<std::size_t, 8> order = order_of_lanes(lanes);
  InOrder halo(share.halo, lanes);
  for (std::size_t g = 0; g < share.first_group; ++g) {
    const GroupedPairs::Group& group = all.groups[g];
    for (std::size_t begin = 0; begin < width; begin += lanes)
      for (std::uint32_t row = group.first; row < group.last; row += width)
        for (std::size_t n = begin; n < begin + lanes; ++n) {
          const std::uint32_t j = all.partner[row + order[n]];
          if (j >= share.first && j < share.last) halo.push(group.grain[order[n]], j);
        }
  }
}

void deal_crossing(const CrossingPairs& all, Share& share) {
  CrossingPairs& crossing = share.crossing;
  crossing.pairs.clear();
  for (std::size_t p = 0; p < all.pairs.size(); p += CrossingPairs::width) {
    const auto mine = [&](const CrossingPairs::Pair& pair) {
      return (pair.i >= share.first && pair.i < share.last) || (pair.j >= share.first && pair.j < share.last);
    };
    const auto* pair = &all.pairs[p];
    if (std::none_of(pair, pair + CrossingPairs::width, mine)) continue;
    for (std::size_t k = 0; k < CrossingPairs::width; ++k)
      crossing.pairs.push_back(mine(pair[k]) ? pair[k]
                                             : CrossingPairs::Pair{pair[k].i, pair[k].i, Cell::home_image});
  }
}

}  // namespace

void deal(const Pairs& pairs, std::size_t grains, std::size_t index, std::size_t shares, std::size_t lanes,
          Share& share) {
  constexpr std::size_t block = GroupedPairs::block;
  const std::size_t blocks = (grains + block - 1) / block;
  const auto begin_of = [&](std::size_t k) {
    return static_cast<std::uint32_t>(std::min(grains, blocks * k / shares * block));
  };
  share.first = begin_of(index);
  share.last = begin_of(index + 1);
  const auto& groups = pairs.within.groups;
  const auto group_of = [&](std::uint32_t grain) {
    return static_cast<std::size_t>(
        std::partition_point(groups.begin(), groups.end(),
                             [&](const GroupedPairs::Group& group) { return group.grain[0] < grain; }) -
        groups.begin());
  };
  share.first_group = group_of(share.first);
  share.last_group = group_of(share.last);
  share.force.resize(grains);
  deal_halo(pairs.within, lanes, share);
  deal_crossing(pairs.crossing, share);
}

}  // namespace grainlaw::dem
