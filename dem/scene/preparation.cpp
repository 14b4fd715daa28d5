#include "grainlaw/dem/scene/preparation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/size_distribution.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/dem/step/neighbours.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

// Grains are pushed apart as if so much larger, or they would only ever nearly part.
constexpr double swelling = 1.02;
constexpr double push_share = 0.4;  // of each overlap, by which either grain gives way
constexpr int most_pushes = 20000;

bool any_overlap(const Grains& grains, const Cell& cell, const Pairs& pairs) {
  bool found = false;
  for_each_contact(pairs, grains, cell, [&](const Contact& c) {
    const double reach = (grains.place[c.i].w + grains.place[c.j].w) / swelling;
    found = found || c.distance <= reach;
  });
  return found;
}

void draw_velocities(State& state, const Material& material, double speed, Random& random) {
  Vec3 momentum{};
  double mass = 0;
  for (std::size_t i = 0; i < state.count(); ++i) {
    const double m = material.rho * sphere_volume(state.radius[i]);
    mass += m;
    for (std::size_t c = 0; c < 3; ++c) momentum[c] += m * (state.velocity[i][c] = random.normal());
  }
  double squares = 0;
  for (auto& v : state.velocity)
    for (std::size_t c = 0; c < 3; ++c) {
      v[c] -= momentum[c] / mass;
      squares += v[c] * v[c];
    }
  const double scale = speed / std::sqrt(squares / static_cast<double>(state.count()));
  for (auto& v : state.velocity)
    for (double& component : v) component *= scale;
}

}  // namespace

void push_apart(State& state) {
  State swollen = state;
  for (double& r : swollen.radius) r *= swelling;
  Cell cell(state.box);
  Grains grains(swollen, 1);
  std::fill(grains.motion.begin(), grains.motion.end(), Quad{});
  Neighbours neighbours(grains.largest_radius(), grains.largest_radius());
  neighbours.update(grains, cell, 0);
  Material soft;
  soft.k = 1;
  const ContactLaw push = ContactLaw::of(soft).elastic();  // with k = 1, of the size of the overlap in mm
  for (int step = 0; any_overlap(grains, cell, neighbours.pairs()); ++step) {
    if (step == most_pushes)
      throw Error("the gas is too dense to place " + std::to_string(state.count()) +
                  " grains at random without overlap; nu_gas must be smaller");
    contact_forces(push, neighbours.pairs(), cell, grains);
    for (std::size_t i = 0; i < grains.count(); ++i) {
      grains.place[i].x += push_share * grains.force[i].x;
      grains.place[i].y += push_share * grains.force[i].y;
      grains.place[i].z += push_share * grains.force[i].z;
    }
    if (neighbours.outdated(grains, cell)) neighbours.update(grains, cell, 0);
  }
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const Quad& p = grains.place[i];
    state.position[grains.id[i]] = cell.wrap({p.x, p.y, p.z});
  }
}

State without_places(std::vector<double> radii, double nu) {
  State state;
  state.radius = std::move(radii);
  double solid = 0;
  for (const double r : state.radius) solid += sphere_volume(r);
  const double edge = std::cbrt(solid / nu);
  state.box = Mat3::diagonal({edge, edge, edge});
  return state;
}

State random_gas(const Material& material, const NewPacking& packing) {
  Random random(packing.seed);
  State state =
      without_places(draw_radii(material, static_cast<std::size_t>(packing.count), random), packing.nu_gas);
  const double edge = state.box(0, 0);
  state.position.resize(state.count());
  state.velocity.resize(state.count());
  for (auto& x : state.position)
    for (double& component : x) component = edge * random.uniform();
  draw_velocities(state, material, packing.speed, random);
  push_apart(state);
  return state;
}

Leg compression_leg(const NewPacking& packing) {
  const double strain = std::log(packing.nu / packing.nu_gas);
  Leg leg{};
  leg.mode = Mode::iso;
  leg.strain = {strain / 3, strain / 3, strain / 3};
  leg.eps_vol[1] = strain;
  leg.duration = strain / 3 / packing.rate;
  leg.profile = Profile::cosine;
  return leg;
}

Leg relaxation_leg(const Relaxation& relaxation) {
  Leg leg{};
  leg.mode = Mode::relax;
  leg.duration = relaxation.duration;
  leg.profile = Profile::constant;
  leg.tolerance = relaxation.tolerance;
  return leg;
}

}  // namespace grainlaw::dem
