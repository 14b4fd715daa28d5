#include "grainlaw/dem/step/neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grainlaw/dem/packing/least_width.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double rest_budget = 0.01;  // s_i of a grain at rest, in units of the mean radius
constexpr double box_budget = 1e-3;   // 1 - e_min: the compression of the box that an inner list survives
constexpr double outer_skin = 0.7;    // in units of the mean radius; less where the box is narrow
constexpr std::uint32_t most_told_apart = 31;  // numbers of partners
constexpr double flight_share = 0.125;         // s_i at most this share of the outer skin, but of a flyer
constexpr std::size_t most_flyers = 16;
constexpr std::size_t run_length =
    64;  // of grains that are enclosed together, where a flyer looks for partners
constexpr double longest_flight = 1;  // s_i of a flyer, in units of the mean radius

/// |x - E X|^2
double strayed(const Quad& x, const Quad& reference, const Mat3& deformation) {
  const Vec3 carried = deformation * Vec3{reference.x, reference.y, reference.z};
  const double a = x.x - carried[0], b = x.y - carried[1], c = x.z - carried[2];
  return a * a + b * b + c * c;
}

/// Whether the spheres of radius w about a and the image of b meet.
bool near(const Quad& a, const Quad& b, const Quad& shift) {
  const double x = a.x - b.x - shift.x, y = a.y - b.y - shift.y, z = a.z - b.z - shift.z, reach = a.w + b.w;
  return x * x + y * y + z * z < reach * reach;
}

/// The partners of some grains, one grain after the other.
struct ByGrain {
  std::uint32_t first;  ///< grain
  const std::vector<std::uint32_t>&begin, &partner;

  std::uint32_t count(std::uint32_t i) const { return begin[i - first + 1] - begin[i - first]; }
  const std::uint32_t* of(std::uint32_t i) const { return partner.data() + begin[i - first]; }
};

void add_group(const ByGrain& pairs, const std::uint32_t* grain, std::uint32_t grains, GroupedPairs& to) {
  GroupedPairs::Group group{};
  std::uint32_t most = 0;
  for (std::uint32_t k = 0; k < GroupedPairs::width; ++k) {
    group.grain[k] = grain[k < grains ? k : 0];
    if (k < grains) most = std::max(most, pairs.count(grain[k]));
  }
  group.first = static_cast<std::uint32_t>(to.partner.size());
  group.last = group.first + most * static_cast<std::uint32_t>(GroupedPairs::width);
  to.partner.resize(group.last);
  for (std::uint32_t k = 0; k < GroupedPairs::width; ++k) {
    const std::uint32_t i = group.grain[k], own = k < grains ? pairs.count(i) : 0;
    const std::uint32_t* const from = pairs.of(i);
    std::uint32_t* at = &to.partner[group.first + k];
    for (std::uint32_t n = 0; n < most; ++n, at += GroupedPairs::width) *at = n < own ? from[n] : i;
  }
  to.groups.push_back(group);
}

/// Groups grains up to `end` that lie side by side and have about as many partners.
void group(const ByGrain& pairs, std::uint32_t end, GroupedPairs& to) {
  to.groups.clear();
  to.partner.clear();
  to.count = pairs.begin.back();
  constexpr std::uint32_t block = GroupedPairs::block;
  std::array<std::uint32_t, block> sorted{};
  for (std::uint32_t first = pairs.first; first < end; first += block) {
    const std::uint32_t last = std::min(first + block, end);
    // By the number of partners, most first; those without any are left out.
    std::array<std::uint32_t, most_told_apart + 2> begin{};
    const auto rank = [&](std::uint32_t i) {
      return most_told_apart - std::min(pairs.count(i), most_told_apart);
    };
    for (std::uint32_t i = first; i < last; ++i) ++begin[rank(i) + 1];
    for (std::uint32_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
    const std::uint32_t with_any = begin[most_told_apart];
    for (std::uint32_t i = first; i < last; ++i) sorted[begin[rank(i)]++] = i;
    for (std::uint32_t k = 0; k < with_any; k += GroupedPairs::width)
      add_group(pairs, &sorted[k], std::min<std::uint32_t>(GroupedPairs::width, with_any - k), to);
  }
}

}  // namespace

void Neighbours::Enclosure::enclose(const Quad& b) {  // a comparison drops what is not a number
  reach = std::max(reach, b.w);
  low = {std::min(low[0], b.x), std::min(low[1], b.y), std::min(low[2], b.z)};
  high = {std::max(high[0], b.x), std::max(high[1], b.y), std::max(high[2], b.z)};
}

void Neighbours::Enclosure::enclose(const Enclosure& other) {
  reach = std::max(reach, other.reach);
  for (std::size_t c = 0; c < 3; ++c) {
    low[c] = std::min(low[c], other.low[c]);
    high[c] = std::max(high[c], other.high[c]);
  }
}

bool Neighbours::Enclosure::may_be_near(const Quad& a) const {
  const Vec3 at{a.x, a.y, a.z};
  bool inside = true;
  for (std::size_t c = 0; c < 3; ++c)
    inside = inside && at[c] > low[c] - reach - a.w && at[c] < high[c] + reach + a.w;
  return inside;
}

bool Neighbours::outdated(const Grains& grains, const Cell& cell) const {
  if (inner_reference_.size() != grains.count()) return true;
  const Mat3 deformation = cell.deformation_from(inner_cell_.edges());
  double excess = -1;
  for (std::size_t i = 0; i < grains.count(); ++i)
    excess =
        std::max(excess, strayed(grains.place[i], inner_reference_[i], deformation) - inner_reference_[i].w);
  return outdated(cell, excess);
}

bool Neighbours::outdated(const Cell& cell, double excess) const {
  return excess > 0 || least_stretch(cell.deformation_from(inner_cell_.edges())) < 1 - box_budget;
}

void Neighbours::cut(std::size_t grains, ThreadPool* team) {
  parts_.resize(team == nullptr ? 1 : static_cast<std::size_t>(team->threads()));
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    parts_[k].first = GroupedPairs::begin_of(grains, k, parts_.size());
    parts_[k].last = GroupedPairs::begin_of(grains, k + 1, parts_.size());
  }
}

template <class F>
void Neighbours::each(ThreadPool* team, F&& f) {
  if (team == nullptr) return f(parts_[0]);
  team->run([this, f](int t) { f(parts_[static_cast<std::size_t>(t)]); });
}

void Neighbours::update(Grains& grains, Cell& cell, double lookahead, ThreadPool* team) {
  if (!update_inner(grains, cell, lookahead, team)) renew(grains, cell, lookahead, team);
}

void Neighbours::renew(Grains& grains, Cell& cell, double lookahead, ThreadPool* team) {
  sort_and_list(grains, cell);
  if (update_inner(grains, cell, lookahead, team)) return;
  // Too narrow a box for flyers.
  for (const std::uint32_t i : flyers_) budget_[i] = flight_share * outer_skin_;
  flyers_.clear();
  filter(grains, cell, team);
  ++updates_;
}

bool Neighbours::update_inner(const Grains& grains, const Cell& cell, double lookahead, ThreadPool* team) {
  cut(grains.count(), team);
  make_budgets(grains, lookahead, team);
  if (!outer_covers(grains, cell, team)) return false;
  filter(grains, cell, team);
  ++updates_;
  return true;
}

void Neighbours::make_budgets(const Grains& grains, double lookahead, ThreadPool* team) {
  const double least = std::min(rest_budget * unit_, 0.25 * flight_share * outer_skin_);
  const double most = flight_share * outer_skin_;
  const auto flight_of = [&grains, lookahead](std::uint32_t i) {
    const Quad& v = grains.motion[i];
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z) * lookahead;
  };
  budget_.resize(grains.count());
  each(team, [=, this](Part& part) {
    part.flyers.clear();
    for (std::uint32_t i = part.first; i < part.last; ++i) {
      const double flight = flight_of(i);
      budget_[i] = std::min(least + flight, most);
      if (!(flight <= most) && part.flyers.size() <= most_flyers) part.flyers.push_back(i);
    }
  });
  flyers_.clear();
  for (const Part& part : parts_) flyers_.insert(flyers_.end(), part.flyers.begin(), part.flyers.end());
  if (flyers_.size() > most_flyers) flyers_.clear();
  for (const std::uint32_t i : flyers_) budget_[i] = least + std::min(flight_of(i), longest_flight * unit_);
}

/// Whether every pair that the inner list must hold is in the outer one: for all i, with e the shrink since
/// the outer list was made, |w_i| + s_i/e_min + r_i (1/e_min - e) <= e skin/2. A few grains for which that
/// fails join the flyers, whose pairs are not looked for there.
bool Neighbours::outer_covers(const Grains& grains, const Cell& cell, ThreadPool* team) {
  if (outer_reference_.size() != grains.count()) return false;
  const Mat3 deformation = cell.deformation_from(outer_cell_.edges());
  const double e = least_stretch(deformation), inflate = 1 / (1 - box_budget);
  // Flyers and their partners must meet through one of the 27 images.
  const double widest = 2 * largest_radius_ + 2 * outer_skin_,
               allowed = 0.5 * (e * cell.narrowest() - widest);
  each(team, [=, this, &grains](Part& part) {
    auto flyer = std::lower_bound(flyers_.begin(), flyers_.end(), part.first);
    part.flyers.clear();
    part.covered = true;
    for (std::uint32_t i = part.first; i < part.last && part.covered; ++i) {
      const bool flies = flyer != flyers_.end() && *flyer == i;
      if (flies) ++flyer;
      const double room = 0.5 * e * outer_skin_ - budget_[i] * inflate - grains.place[i].w * (inflate - e);
      const double squared = strayed(grains.place[i], outer_reference_[i], deformation);
      if (!flies && room >= 0 && squared <= room * room) continue;
      part.covered = part.flyers.size() < most_flyers && std::sqrt(squared) + 2 * budget_[i] <= allowed;
      part.flyers.push_back(i);
    }
  });
  std::vector<std::uint32_t> flyers;
  for (const Part& part : parts_) {
    if (!part.covered) return false;
    flyers.insert(flyers.end(), part.flyers.begin(), part.flyers.end());
  }
  if (flyers.size() > most_flyers) return false;
  flyers_.swap(flyers);
  return true;
}

void Neighbours::sort_and_list(Grains& grains, Cell& cell) {
  cell.reduce();
  const double narrowest = cell.narrowest(), widest_grain = 2 * largest_radius_;
  const double least = least_width(largest_radius_, unit_);
  outer_skin_ = std::min(narrowest - widest_grain, outer_skin * unit_);
  if (!(narrowest >= least))
    throw Error("the box is " + to_text(narrowest) +
                " mm wide, too narrow for its largest grain of diameter " + to_text(widest_grain) +
                " mm: it must be wider than " + to_text(least) +
                " mm, or a grain would touch its own image; take more grains or less strain");
  for (Quad& p : grains.place) {
    const Vec3 x = cell.wrap({p.x, p.y, p.z});
    p = {x[0], x[1], x[2], p.w};
  }
  const LinkedCells cells(grains.place, cell, outer_range());
  grains.reorder(cells.order());
  cells.list_pairs(grains.place, cell, outer_skin_, outer_);
  outer_reference_ = grains.place;
  outer_cell_ = cell;
  ++sorts_;
}

/// Both lists follow from where the grains were when they were made: LinkedCells leaves sorted grains where
/// they are, and the filter knows of the grains only their places and budgets.
void Neighbours::rebuild(const Grains& grains) {
  Grains then;
  then.place = outer_reference_;
  LinkedCells(then.place, outer_cell_, outer_range())
      .list_pairs(then.place, outer_cell_, outer_skin_, outer_);
  then.place = inner_reference_;
  for (std::size_t i = 0; i < then.count(); ++i) then.place[i].w = grains.place[i].w;
  cut(then.count(), nullptr);
  filter(then, inner_cell_, nullptr);
}

void Neighbours::filter(const Grains& grains, const Cell& cell, ThreadPool* team) {
  inner_reference_.resize(grains.count());
  const double inflate = 1 / (1 - box_budget);
  // Positions with the grain's reach (r_i + s_i)/e_min, so that one line tells all about a grain.
  each(team, [=, this, &grains](const Part& part) {
    for (std::uint32_t i = part.first; i < part.last; ++i) {
      const Quad& p = grains.place[i];
      inner_reference_[i] = {p.x, p.y, p.z, (p.w + budget_[i]) * inflate};
    }
  });
  inner_cell_ = cell;
  Quads flying;
  for (const std::uint32_t i : flyers_) {
    flying.push_back(inner_reference_[i]);
    inner_reference_[i].x = std::numeric_limits<double>::quiet_NaN();  // near to none
  }
  const std::array<Quad, 27> shifts = cell.shifts();
  runs_.resize(flying.empty() ? 0 : (grains.count() + run_length - 1) / run_length);
  each(team, [this, shifts, anyone_flies = !flying.empty()](Part& part) {
    filter_within(part);
    group({part.first, part.begin, part.near}, part.last, parts_.size() == 1 ? inner_.within : part.within);
    filter_crossing(part, shifts);
    if (anyone_flies) enclose_runs(part);
  });
  const std::vector<CrossingPairs::Pair> of_flyers = pairs_of_flyers(flying, shifts);
  make_room(of_flyers.size());
  each(team, [this](const Part& part) {
    if (parts_.size() > 1) join(part);  // else it has written into the list
    for (std::uint32_t i = part.first; i < part.last; ++i) inner_reference_[i].w = budget_[i] * budget_[i];
  });
  std::copy(of_flyers.begin(), of_flyers.end(),
            inner_.crossing.pairs.end() - static_cast<std::ptrdiff_t>(of_flyers.size()));
  inner_.crossing.fill_up();
}

void Neighbours::filter_within(Part& part) const {
  part.begin.resize(part.last - part.first + 1);
  part.near.resize(outer_.begin[part.last] - outer_.begin[part.first] + 1);
  std::uint32_t n = 0;
  for (std::uint32_t i = part.first; i < part.last; ++i) {
    const Quad a = inner_reference_[i];
    part.begin[i - part.first] = n;
    for (std::uint32_t p = outer_.begin[i]; p < outer_.begin[i + 1]; ++p) {
      const std::uint32_t j = outer_.partner[p];
      part.near[n] = j;  // kept or overwritten by the next one: no branch to mispredict
      n += near(a, inner_reference_[j], {}) ? 1u : 0u;
    }
  }
  part.begin.back() = n;
}

void Neighbours::filter_crossing(Part& part, const std::array<Quad, 27>& shifts) {
  const std::size_t k = static_cast<std::size_t>(&part - parts_.data()), all = outer_.crossing.size();
  std::vector<CrossingPairs::Pair>& to = parts_.size() == 1 ? inner_.crossing.pairs : part.crossing;
  to.clear();
  for (std::size_t p = all * k / parts_.size(); p < all * (k + 1) / parts_.size(); ++p) {
    const auto& [i, j, image] = outer_.crossing[p];
    if (near(inner_reference_[i], inner_reference_[j], shifts[image])) to.push_back({i, j, image});
  }
}

/// Makes room in the list for what all parts have found, in their order, and then the pairs of flyers.
void Neighbours::make_room(std::size_t of_flyers) {
  GroupedPairs& within = inner_.within;
  within.reach = outer_.reach;
  if (parts_.size() == 1) {
    inner_.crossing.pairs.resize(inner_.crossing.pairs.size() + of_flyers);
    return;
  }
  std::size_t groups = 0, partners = 0, crossing = 0;
  within.count = 0;
  for (Part& part : parts_) {
    part.groups_before = groups, part.partners_before = partners, part.crossing_before = crossing;
    groups += part.within.groups.size(), partners += part.within.partner.size();
    crossing += part.crossing.size();
    within.count += part.within.count;
  }
  within.groups.resize(groups);
  within.partner.resize(partners);
  inner_.crossing.pairs.resize(crossing + of_flyers);
}

void Neighbours::join(const Part& part) {
  const auto put = [](const auto& from, std::size_t before, auto& into) {
    std::copy(from.begin(), from.end(), into.begin() + static_cast<std::ptrdiff_t>(before));
  };
  put(part.crossing, part.crossing_before, inner_.crossing.pairs);
  put(part.within.partner, part.partners_before, inner_.within.partner);
  const auto before = static_cast<std::uint32_t>(part.partners_before);
  auto* to = inner_.within.groups.data() + part.groups_before;
  for (GroupedPairs::Group group : part.within.groups) {
    group.first += before, group.last += before;
    *to++ = group;
  }
}

void Neighbours::enclose_runs(const Part& part) {
  static_assert(GroupedPairs::block % run_length == 0);  // no run lies in two parts
  for (std::uint32_t i = part.first; i < part.last; ++i) {
    if (i % run_length == 0) runs_[i / run_length] = {};
    runs_[i / run_length].enclose(inner_reference_[i]);  // of flyers, which have no x yet, y, z and reach
  }
}

/// The pairs of the grains that fly, looked for among all grains and through all images in which one of them
/// may lie near: in those runs of grains, as they are sorted in space, whose box is near enough.
std::vector<CrossingPairs::Pair> Neighbours::pairs_of_flyers(const Quads& flying,
                                                             const std::array<Quad, 27>& shifts) {
  std::vector<CrossingPairs::Pair> found;
  if (flying.empty()) return found;
  Enclosure all;
  for (const Enclosure& run : runs_) all.enclose(run);
  for (std::size_t k = 0; k < flying.size(); ++k) {
    const Quad& a = flying[k];
    for (std::uint32_t image = 0; image < shifts.size(); ++image) {
      const Quad& shift = shifts[image];
      const Quad at{a.x - shift.x, a.y - shift.y, a.z - shift.z, a.w};
      if (!all.may_be_near(at)) continue;
      for (std::size_t run = 0; run < runs_.size(); ++run) {
        if (!runs_[run].may_be_near(at)) continue;
        const std::size_t last = std::min((run + 1) * run_length, inner_reference_.size());
        for (std::size_t j = run * run_length; j < last; ++j)
          if (near(a, inner_reference_[j], shift))
            found.push_back({flyers_[k], static_cast<std::uint32_t>(j), image});
      }
    }
    inner_reference_[flyers_[k]] = a;  // so that the next flyers meet it
    runs_[flyers_[k] / run_length].enclose(a);
    all.enclose(a);
  }
  return found;
}

}  // namespace grainlaw::dem
