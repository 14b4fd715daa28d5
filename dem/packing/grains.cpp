#include "grainlaw/dem/packing/grains.hpp"

#include <algorithm>
#include <numeric>

#include "grainlaw/dem/packing/cell.hpp"

namespace grainlaw::dem {

Grains::Grains(const State& state, double rho)
    : place(state.count()),
      motion(state.count()),
      half(state.count()),
      force(state.count()),
      acceleration(state.count()),
      id(state.count()) {
  std::iota(id.begin(), id.end(), 0u);
  for (std::size_t i = 0; i < state.count(); ++i) {
    const auto& x = state.position[i];
    const auto& v = state.velocity[i];
    place[i] = {x[0], x[1], x[2], state.radius[i]};
    motion[i] = {v[0], v[1], v[2], 0};
    acceleration[i].w = 1 / (rho * sphere_volume(state.radius[i]));
  }
}

double Grains::largest_radius() const {
  double r = 0;
  for (const Quad& p : place) r = std::max(r, p.w);
  return r;
}

double Grains::smallest_radius() const {
  double r = place.empty() ? 0 : place[0].w;
  for (const Quad& p : place) r = std::min(r, p.w);
  return r;
}

namespace {
template <class List>
void permute(List& list, const std::vector<std::uint32_t>& order) {
  List sorted(list.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = list[order[i]];
  list.swap(sorted);
}
}  // namespace

State Grains::state(const Cell& cell, const Quads& velocity) const {
  State state;
  state.box = cell.edges();
  state.position.resize(count());
  state.velocity.resize(count());
  state.radius.resize(count());
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad &x = place[i], &v = velocity[i];
    state.position[id[i]] = cell.wrap({x.x, x.y, x.z});
    state.velocity[id[i]] = {v.x, v.y, v.z};
    state.radius[id[i]] = x.w;
  }
  return state;
}

void Grains::reorder(const std::vector<std::uint32_t>& order) {
  permute(place, order);
  permute(motion, order);
  permute(half, order);
  permute(force, order);
  permute(acceleration, order);
  permute(id, order);
}

}  // namespace grainlaw::dem
