#include "grainlaw/dem/shares.hpp"

#include <algorithm>

namespace grainlaw::dem {

namespace {

/// The groups before this share's, without the partners that lie elsewhere. What is left keeps its lane and
/// its order, and with them the order in which forces are added.
void deal_halo(const GroupedPairs& all, Share& share) {
  constexpr auto width = static_cast<std::uint32_t>(GroupedPairs::width);
  GroupedPairs& halo = share.halo;
  halo.groups.clear();
  halo.partner.clear();
  for (std::size_t g = 0; g < share.first_group; ++g) {
    GroupedPairs::Group group = all.groups[g];
    const auto begin = static_cast<std::uint32_t>(halo.partner.size());
    for (std::uint32_t row = group.first; row < group.last; row += width) {
      const auto mine = [&](std::uint32_t j) { return j >= share.first && j < share.last; };
      const auto* partner = &all.partner[row];
      if (std::none_of(partner, partner + width, mine)) continue;
      for (std::uint32_t k = 0; k < width; ++k)
        halo.partner.push_back(mine(partner[k]) ? partner[k] : group.grain[k]);
    }
    group.first = begin;
    group.last = static_cast<std::uint32_t>(halo.partner.size());
    if (group.first < group.last) halo.groups.push_back(group);
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

void deal(const Pairs& pairs, std::size_t grains, std::size_t index, std::size_t shares, Share& share) {
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
  deal_halo(pairs.within, share);
  deal_crossing(pairs.crossing, share);
}

}  // namespace grainlaw::dem
