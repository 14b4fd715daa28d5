#include "grainlaw/dem/step/shares.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "grainlaw/dem/step/forces.hpp"

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

/// The pairs of the groups from `first_group` to this share's whose partners lie in it, in the order in which
/// the loop over the groups adds their forces: that through all groups, as many lanes at a time.
void deal_halo(const GroupedPairs& all, std::size_t first_group, std::size_t lanes, Share& share) {
  constexpr auto width = static_cast<std::uint32_t>(GroupedPairs::width);
  const std::array<std::size_t, 8> order = order_of_lanes(lanes);
  InOrder halo(share.halo, lanes);
  for (std::size_t g = first_group; g < share.first_group; ++g) {
    const GroupedPairs::Group& group = all.groups[g];
    for (std::size_t begin = 0; begin < width; begin += lanes)
      for (std::uint32_t row = group.first; row < group.last; row += width)
        for (std::size_t n = begin; n < begin + lanes; ++n) {
          const std::uint32_t j = all.partner[row + order[n]];
          if (share.owns(j)) halo.push(group.grain[order[n]], j);
        }
  }
}

void deal_crossing(const CrossingPairs& all, Share& share) {
  CrossingPairs& crossing = share.crossing;
  crossing.pairs.clear();
  for (std::size_t p = 0; p < all.pairs.size(); p += CrossingPairs::width) {
    const auto mine = [&](const CrossingPairs::Pair& pair) {
      return share.owns(pair.i) || share.owns(pair.j);
    };
    const auto* pair = &all.pairs[p];
    if (std::none_of(pair, pair + CrossingPairs::width, mine)) continue;
    for (std::size_t k = 0; k < CrossingPairs::width; ++k)
      crossing.pairs.push_back(mine(pair[k]) ? pair[k]
                                             : CrossingPairs::Pair{pair[k].i, pair[k].i, Cell::home_image});
  }
}

/// Grains of other shares in its pairs; within the box, only groups from `first_group` on have any.
void list_foreign(const GroupedPairs& all, std::size_t first_group, std::size_t grains, Share& share) {
  constexpr std::uint32_t bits = 64;
  std::vector<std::uint64_t> marked((grains + bits - 1) / bits);
  const auto mark = [&](std::uint32_t i) {
    if (!share.owns(i)) marked[i / bits] |= std::uint64_t{1} << i % bits;
  };
  for (const CrossingPairs* list : {&share.halo, &share.crossing})
    for (const CrossingPairs::Pair& pair : list->pairs)
      if (pair.i != pair.j) mark(pair.i), mark(pair.j);  // else it fills up a row
  for (std::size_t g = first_group; g < share.last_group; ++g)
    for (std::uint32_t p = all.groups[g].first; p < all.groups[g].last; ++p) mark(all.partner[p]);
  share.foreign.clear();
  for (std::uint32_t word = 0; word < marked.size(); ++word)
    for (std::uint64_t left = marked[word]; left != 0; left &= left - 1)
      share.foreign.push_back(word * bits + static_cast<std::uint32_t>(std::countr_zero(left)));
}

}  // namespace

void deal(const Pairs& pairs, std::size_t grains, std::size_t index, std::size_t shares, std::size_t lanes,
          Share& share) {
  constexpr std::uint32_t block = GroupedPairs::block;
  share.first = GroupedPairs::begin_of(grains, index, shares);
  share.last = GroupedPairs::begin_of(grains, index + 1, shares);
  const auto& groups = pairs.within.groups;
  const auto group_of = [&](std::uint32_t grain) {
    return static_cast<std::size_t>(
        std::partition_point(groups.begin(), groups.end(),
                             [&](const GroupedPairs::Group& group) { return group.grain[0] < grain; }) -
        groups.begin());
  };
  share.first_group = group_of(share.first);
  share.last_group = group_of(share.last);
  // Whose partners reach so far: whole runs, as groups are not in order within them.
  const auto first_to_reach = [&](std::uint32_t grain) {
    return group_of((grain - std::min(grain, pairs.within.reach)) / block * block);
  };
  deal_halo(pairs.within, first_to_reach(share.first), lanes, share);
  deal_crossing(pairs.crossing, share);
  list_foreign(pairs.within, std::max(share.first_group, first_to_reach(share.last)), grains, share);
}

Team::Team(int threads)
    : pool_(std::make_shared<ThreadPool>(threads)), shares_(static_cast<std::size_t>(threads)) {}

void Team::deal(const Pairs& pairs, const Grains& grains, bool moved) {
  each([&](std::size_t t) {
    Share& share = shares_[t];
    dem::deal(pairs, grains.count(), t, shares_.size(), force_lanes(), share);
    for (auto& inbox : share.inbox) inbox.resize(share.foreign.size());
    if (!moved) return;
    share.grains.place = grains.place;
    share.grains.motion = grains.motion;
    share.grains.half = grains.half;
    share.grains.force = grains.force;
    share.grains.acceleration = grains.acceleration;
  });
  each([&](std::size_t t) { send(t, box_); });
}

/// Leaves what others need of its grains in their inboxes.
void Team::send(std::size_t from, std::size_t box) {
  const Share& own = shares_[from];
  for (Share& other : shares_) {
    const auto begin = other.foreign.begin(), end = std::lower_bound(begin, other.foreign.end(), own.last);
    for (auto i = std::lower_bound(begin, end, own.first); i != end; ++i) {
      const Quad &x = own.grains.place[*i], &v = own.grains.motion[*i];
      other.inbox[box][static_cast<std::size_t>(i - begin)] = {x.x, x.y, x.z, v.x, v.y, v.z};
    }
  }
}

void Team::take(Share& share) const {
  const auto& inbox = share.inbox[box_];
  for (std::size_t k = 0; k < inbox.size(); ++k) {
    Quad &x = share.grains.place[share.foreign[k]], &v = share.grains.motion[share.foreign[k]];
    x = {inbox[k][0], inbox[k][1], inbox[k][2], x.w};
    v = {inbox[k][3], inbox[k][4], inbox[k][5], v.w};
  }
}

double Team::advance(const ContactLaw& law, const Pairs& pairs, const Cell& cell, const Stride& stride,
                     const ListReach& list) {
  std::vector<double> excess(shares_.size());
  each([&](std::size_t t) {
    Share& share = shares_[t];
    if (due_) {
      take(share);
      dem::add_contact_forces(law, pairs, cell, share);
    }
    excess[t] = dem::advance(stride, list, share.first, share.last, share.grains);
    send(t, 1 - box_);
  });
  box_ = 1 - box_;
  due_ = true;
  double worst = -1;
  for (const double share : excess) {
    if (std::isnan(share)) return share;
    worst = std::max(worst, share);
  }
  return worst;
}

void Team::add_contact_forces(const ContactLaw& law, const Pairs& pairs, const Cell& cell) {
  if (!due_) return;
  each([&](std::size_t t) {
    take(shares_[t]);
    dem::add_contact_forces(law, pairs, cell, shares_[t]);
  });
  due_ = false;
}

void Team::gather(Grains& grains) const {
  each([&](std::size_t t) {
    const Share& share = shares_[t];
    const auto take = [&](const Quads& from, Quads& to) {
      std::copy(from.begin() + share.first, from.begin() + share.last, to.begin() + share.first);
    };
    take(share.grains.place, grains.place);
    take(share.grains.motion, grains.motion);
    take(share.grains.half, grains.half);
    take(share.grains.force, grains.force);
    take(share.grains.acceleration, grains.acceleration);
  });
}

}  // namespace grainlaw::dem
