#include "grainlaw/dem/packing/crystal_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "grainlaw/dem/packing/linked_cells.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

constexpr double neighbour_range = 1.3;  // mean diameters: between the first two shells of a packing
constexpr double bond_order = 0.7;
constexpr int bonds_in_order = 7;
constexpr double least_w = 1.2;

struct Near {
  std::uint32_t other;
  Vec3 unit;  ///< direction to it
};

/// Sixth Legendre polynomial. By the addition theorem, sum_m Y_6m(a) Y_6m*(b) = 13/(4 pi) P_6(a . b), so that
/// products of q_6 need no spherical harmonics.
double legendre6(double x) {
  const double y = x * x;
  return (((231 * y - 315) * y + 105) * y - 5) / 16;
}

/// q_6(a) . q_6*(b) but for factors that cancel.
double product(const std::vector<Near>& a, const std::vector<Near>& b) {
  double sum = 0;
  for (const Near& p : a)
    for (const Near& q : b) sum += legendre6(dot(p.unit, q.unit));
  return sum;
}

std::vector<std::vector<Near>> neighbourhoods(const State& state) {
  Cell cell(state.box);
  cell.reduce();
  double mean = 0, largest = 0;
  Quads place;
  for (std::size_t i = 0; i < state.count(); ++i) {
    const Vec3 x = cell.wrap(state.position[i]);
    place.push_back({x[0], x[1], x[2], state.radius[i]});
    mean += 2 * state.radius[i] / static_cast<double>(state.count());
    largest = std::max(largest, 2 * state.radius[i]);
  }
  const double skin = std::min((neighbour_range - 1) * mean, cell.narrowest() - largest);
  const LinkedCells cells(place, cell, largest + skin);
  Quads sorted;
  for (const std::uint32_t i : cells.order()) sorted.push_back(place[i]);
  NearPairs pairs;
  cells.list_pairs(sorted, cell, skin, pairs);
  const std::array<Quad, 27> shifts = cell.shifts();
  std::vector<std::vector<Near>> list(state.count());
  const auto add = [&](std::uint32_t i, std::uint32_t j, const Quad& shift) {
    const Quad &a = sorted[i], &b = sorted[j];
    const Vec3 d{b.x + shift.x - a.x, b.y + shift.y - a.y, b.z + shift.z - a.z};
    const double r = norm(d);
    list[i].push_back({j, {d[0] / r, d[1] / r, d[2] / r}});
    list[j].push_back({i, {-d[0] / r, -d[1] / r, -d[2] / r}});
  };
  for (std::uint32_t i = 0; i < state.count(); ++i)
    for (std::uint32_t p = pairs.begin[i]; p < pairs.begin[i + 1]; ++p) add(i, pairs.partner[p], Quad{});
  for (const auto& [i, j, image] : pairs.crossing) add(i, j, shifts[image]);
  return list;
}

}  // namespace

double crystalline_share(const State& state) {
  const auto near = neighbourhoods(state);
  std::vector<double> square;
  for (const auto& list : near) square.push_back(product(list, list));
  int in_order = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto bonds = std::count_if(near[i].begin(), near[i].end(), [&](const Near& n) {
      return product(near[i], near[n.other]) > bond_order * std::sqrt(square[i] * square[n.other]);
    });
    if (bonds >= bonds_in_order) ++in_order;
  }
  return static_cast<double>(in_order) / static_cast<double>(near.size());
}

bool may_crystallise(const Material& material) { return material.w < least_w; }

std::string crystal_warning(const Material& material, const State& state) {
  std::array<char, 32> share{};
  std::snprintf(share.data(), share.size(), "%.0f %%", 100 * crystalline_share(state));
  return "w = " + to_text(material.w) +
         " is below 1.2: grains of nearly equal size may crystallise, and the laws may not hold; at the "
         "end " +
         share.data() + " of them stand in crystalline order";
}

}  // namespace grainlaw::dem
