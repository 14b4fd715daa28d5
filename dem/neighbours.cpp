#include "grainlaw/dem/neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double rest_budget = 0.01;    // s_i of a grain at rest, in units of the mean radius
constexpr double box_budget = 1e-3;     // 1 - e_min: the compression of the box that an inner list survives
constexpr double outer_skin = 0.7;      // in units of the mean radius; less where the box is narrow
constexpr double least_skin = 0.02;     // the narrowest outer skin worth listing
constexpr std::size_t block = 32;       // grains whose pairs are interleaved
constexpr double flight_share = 0.125;  // s_i at most this share of the outer skin

/// |x - E X|^2
double strayed(const Quad& x, const Quad& reference, const Mat3& deformation) {
  const Vec3 carried = deformation * Vec3{reference.x, reference.y, reference.z};
  const double a = x.x - carried[0], b = x.y - carried[1], c = x.z - carried[2];
  return a * a + b * b + c * c;
}

}  // namespace

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

void Neighbours::update(Grains& grains, Cell& cell, double lookahead) {
  make_budgets(grains, lookahead);
  if (!outer_covers(grains, cell)) {
    sort_and_list(grains, cell);
    make_budgets(grains, lookahead);  // in the new order, and within the new skin
  }
  filter(grains, cell);
  ++updates_;
}

void Neighbours::make_budgets(const Grains& grains, double lookahead) {
  const double least = std::min(rest_budget * unit_, 0.25 * flight_share * outer_skin_);
  const double most = flight_share * outer_skin_;
  budget_.resize(grains.count());
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Quad& v = grains.motion[i];
    const double speed = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    budget_[i] = std::min(least + speed * lookahead, most);
  }
}

/// Whether every pair that the inner list must hold is in the outer one: for all i, with e the shrink since
/// the outer list was made, |w_i| + s_i/e_min + r_i (1/e_min - e) <= e skin/2.
bool Neighbours::outer_covers(const Grains& grains, const Cell& cell) const {
  if (outer_reference_.size() != grains.count()) return false;
  const Mat3 deformation = cell.deformation_from(outer_cell_.edges());
  const double e = least_stretch(deformation), inflate = 1 / (1 - box_budget);
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const double room = 0.5 * e * outer_skin_ - budget_[i] * inflate - grains.place[i].w * (inflate - e);
    if (!(room >= 0) || strayed(grains.place[i], outer_reference_[i], deformation) > room * room)
      return false;
  }
  return true;
}

void Neighbours::sort_and_list(Grains& grains, Cell& cell) {
  cell.reduce();
  const double narrowest = cell.narrowest(), widest_grain = 2 * largest_radius_;
  outer_skin_ = std::min(outer_skin * unit_, narrowest - widest_grain);
  if (!(outer_skin_ >= least_skin * unit_))
    throw Error("the box is " + to_text(narrowest) +
                " mm wide, too narrow for its largest grain of diameter " + to_text(widest_grain) +
                " mm: it must be wider than " + to_text(widest_grain + least_skin * unit_) +
                " mm, or a grain would touch its own image; take more grains or less strain");
  for (Quad& p : grains.place) {
    const Vec3 x = cell.wrap({p.x, p.y, p.z});
    p = {x[0], x[1], x[2], p.w};
  }
  const LinkedCells cells(grains.place, cell, widest_grain + outer_skin_);
  grains.reorder(cells.order());
  cells.list_pairs(grains.place, cell, outer_skin_, outer_);
  outer_reference_ = grains.place;
  outer_cell_ = cell;
  ++sorts_;
}

void Neighbours::filter(const Grains& grains, const Cell& cell) {
  const std::size_t count = grains.count();
  inner_reference_.resize(count);
  const double inflate = 1 / (1 - box_budget);
  // Positions with the grain's reach (r_i + s_i)/e_min, so that one line tells all about a grain.
  for (std::size_t i = 0; i < count; ++i) {
    const Quad& p = grains.place[i];
    inner_reference_[i] = {p.x, p.y, p.z, (p.w + budget_[i]) * inflate};
  }
  inner_cell_ = cell;
  const auto near = [this](const Quad& a, const Quad& b, const Quad& shift) {
    const double x = a.x - b.x - shift.x, y = a.y - b.y - shift.y, z = a.z - b.z - shift.z, reach = a.w + b.w;
    return x * x + y * y + z * z < reach * reach;
  };
  const std::array<Quad, 27> shifts = cell.shifts();
  near_begin_.resize(count + 1);
  near_.resize(outer_.partner.size() + 1);
  std::uint32_t n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Quad a = inner_reference_[i];
    near_begin_[i] = n;
    for (std::uint32_t p = outer_.begin[i]; p < outer_.begin[i + 1]; ++p) {
      const std::uint32_t j = outer_.partner[p];
      near_[n] = j;  // kept or overwritten by the next one: no branch to mispredict
      n += near(a, inner_reference_[j], {}) ? 1u : 0u;
    }
  }
  near_begin_[count] = n;
  interleave(grains);
  PairList& crossing = inner_.crossing;
  crossing.pairs.clear();
  crossing.reach.clear();
  crossing.image.clear();
  for (const auto& [i, j, image] : outer_.crossing)
    if (near(inner_reference_[i], inner_reference_[j], shifts[image])) {
      crossing.pairs.push_back({i, j});
      crossing.reach.push_back(grains.place[i].w + grains.place[j].w);
      crossing.image.push_back(image);
    }
  crossing.fill_up();
  for (std::size_t i = 0; i < count; ++i) inner_reference_[i].w = budget_[i] * budget_[i];
}

/// Orders the pairs so that those taken together have different grains i where possible (the first partners
/// of a block of grains, then their second partners, ...): adding to one force four times in a row would wait
/// for memory each time.
void Neighbours::interleave(const Grains& grains) {
  const std::size_t count = grains.count();
  PairList& within = inner_.within;
  within.pairs.resize(near_begin_[count]);
  within.reach.resize(near_begin_[count]);
  std::size_t n = 0;
  std::array<std::uint32_t, block> open{};
  for (std::size_t first = 0; first < count; first += block) {
    std::size_t left = 0;
    for (std::size_t i = first; i < std::min(first + block, count); ++i)
      if (near_begin_[i] < near_begin_[i + 1]) open[left++] = static_cast<std::uint32_t>(i);
    for (std::uint32_t rank = 0; left > 0; ++rank) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < left; ++k) {
        const std::uint32_t i = open[k], j = near_[near_begin_[i] + rank];
        within.pairs[n] = {i, j};
        within.reach[n] = grains.place[i].w + grains.place[j].w;
        ++n;
        open[kept] = i;
        kept += near_begin_[i] + rank + 1 < near_begin_[i + 1] ? 1u : 0u;
      }
      left = kept;
    }
  }
  within.fill_up();
}

}  // namespace grainlaw::dem
