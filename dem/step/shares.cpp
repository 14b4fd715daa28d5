#include "grainlaw/dem/step/shares.hpp"

#include <algorithm>
#include <array>
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

/// The pairs of the groups from `first_group` to this share's whose partners lie in it, in the order in which
/// the loop over the groups adds their forces: that through all groups, as many lanes at a time. Each lies in
/// the lane in which its force is added when its turn comes.
void deal_halo(const GroupedPairs& all, std::size_t first_group, std::size_t lanes, Share& share) {
  constexpr auto width = static_cast<std::uint32_t>(GroupedPairs::width);
  share.halo.pairs.clear();
  if (first_group == share.first_group) return;
  const std::array<std::size_t, 8> order = order_of_lanes(lanes);
  std::vector<HaloPairs::Pair> found(all.groups[share.first_group - 1].last - all.groups[first_group].first);
  std::size_t n = 0;
  for (std::size_t g = first_group; g < share.first_group; ++g) {
    const GroupedPairs::Group& group = all.groups[g];
    for (std::size_t begin = 0; begin < width; begin += lanes)
      for (std::uint32_t row = group.first; row < group.last; row += width)
        for (std::size_t lane = begin; lane < begin + lanes; ++lane) {
          const std::uint32_t j = all.partner[row + order[lane]];
          found[n] = {group.grain[order[lane]], j};  // kept or overwritten by the next one
          n += share.owns(j) ? 1u : 0u;
        }
  }
  share.halo.pairs.resize((n + width - 1) / width * width);
  for (std::size_t k = 0; k < n; ++k) share.halo.pairs[k / width * width + order[k % width]] = found[k];
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
  // Its own are marked, too, and pairs that fill up a row mark the one behind the last.
  std::vector<unsigned char> marked(grains + 1);
  for (const HaloPairs::Pair& pair : share.halo.pairs) marked[pair.i == pair.j ? grains : pair.i] = 1;
  for (const CrossingPairs::Pair& pair : share.crossing.pairs) {
    const bool fills_up = pair.i == pair.j;
    marked[fills_up ? grains : pair.i] = marked[fills_up ? grains : pair.j] = 1;
  }
  for (std::size_t g = first_group; g < share.last_group; ++g)
    for (std::uint32_t p = all.groups[g].first; p < all.groups[g].last; ++p) marked[all.partner[p]] = 1;
  share.foreign.clear();
  const auto add = [&](std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t i = first; i < last; ++i)
      if (marked[i] != 0) share.foreign.push_back(i);
  };
  add(0, share.first);
  add(share.last, static_cast<std::uint32_t>(grains));
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
  each([&](std::size_t t) {
    find_listed(t);
    send(t, box_);
  });
}

void Team::find_listed(std::size_t from) {
  Share& own = shares_[from];
  own.listed.clear();
  for (std::size_t t = 0; t < shares_.size(); ++t) {
    const std::vector<std::uint32_t>& foreign = shares_[t].foreign;
    const auto at = [&](std::uint32_t grain) {
      return static_cast<std::size_t>(std::lower_bound(foreign.begin(), foreign.end(), grain) -
                                      foreign.begin());
    };
    if (const Share::Listed some{t, at(own.first), at(own.last)}; some.first != some.last)
      own.listed.push_back(some);
  }
}

/// The memory that send() writes to.
std::span<const std::span<std::byte>> Team::outbox(std::size_t from, std::size_t box) {
  Share& own = shares_[from];
  own.outbox.clear();
  for (const auto& [share, first, last] : own.listed)
    own.outbox.push_back(
        std::as_writable_bytes(std::span(shares_[share].inbox[box]).subspan(first, last - first)));
  return own.outbox;
}

/// Leaves what others need of its grains in their inboxes.
void Team::send(std::size_t from, std::size_t box) {
  const Share& own = shares_[from];
  for (const auto& [share, first, last] : own.listed) {
    Share& other = shares_[share];
    for (std::size_t k = first; k < last; ++k) {
      const Quad &x = own.grains.place[other.foreign[k]], &v = own.grains.motion[other.foreign[k]];
      other.inbox[box][k] = {x.x, x.y, x.z, v.x, v.y, v.z};
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
  each([=, this, &pairs, of_each = excess.data()](std::size_t t) {
    Share& share = shares_[t];
    if (due_) {
      take(share);
      dem::add_contact_forces(law, pairs, cell, share, outbox(t, 1 - box_));
    }
    of_each[t] = dem::advance(stride, list, share.first, share.last, share.grains);
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
  gather({&Grains::place, &Grains::motion, &Grains::half, &Grains::force, &Grains::acceleration}, grains);
}

void Team::gather_motion(Grains& grains) const { gather({&Grains::place, &Grains::motion}, grains); }

void Team::gather(std::initializer_list<Quads Grains::*> fields, Grains& grains) const {
  each([&](std::size_t t) {
    const Share& share = shares_[t];
    for (const auto field : fields) {
      const Quads& from = share.grains.*field;
      std::copy(from.begin() + share.first, from.begin() + share.last, (grains.*field).begin() + share.first);
    }
  });
}

}  // namespace grainlaw::dem
