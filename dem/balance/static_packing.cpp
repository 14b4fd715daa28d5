#include "grainlaw/dem/balance/static_packing.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/numbers/field.hpp"
#include "grainlaw/dem/step/forces.hpp"

namespace grainlaw::dem {

StaticPacking::StaticPacking(const Material& material, const State& state)
    : material_(material),
      law_(ContactLaw::of(material).elastic()),
      cell_(state.box),
      grains_(state, material.rho),
      neighbours_(material.r_mean, grains_.largest_radius()),
      unit_(material.r_mean),
      time_(state.time_us),
      step_(state.step) {
  std::fill(grains_.motion.begin(), grains_.motion.end(), Quad{});
  neighbours_.update(grains_, cell_, 0);
}

void StaticPacking::deform(const Mat3& edges) {
  const Cell next = cell_.moved(edges, {});
  const Mat3 f = next.deformation_from(cell_.edges());
  for (Quad& p : grains_.place) {
    const Vec3 x = f * Vec3{p.x, p.y, p.z};
    p = {x[0], x[1], x[2], p.w};
  }
  cell_ = next;
  if (neighbours_.outdated(grains_, cell_)) neighbours_.update(grains_, cell_, 0);
}

void StaticPacking::move(double step) {
  add(step, grains_.motion, grains_.place);
  if (neighbours_.outdated(grains_, cell_)) neighbours_.update(grains_, cell_, std::abs(step));
}

void StaticPacking::forces() {
  contact_forces(law_, neighbours_.pairs(), cell_, grains_);
  for (Quad& f : grains_.force) f.w = 0;  // the kernel does not care what stands there, fields do
  ++evaluations_;
}

void StaticPacking::find_contacts() {
  network_.build(law_, neighbours_.pairs(), cell_, grains_);
  backbone_.find(network_, count());
  ++evaluations_;
}

Balance StaticPacking::balance() const {
  Balance balance;
  balance.largest_net_force = std::sqrt(largest_square(grains_.force));
  balance.mean_force = backbone_.mean_force();
  balance.jammed = backbone_.grains() > 0 && balance.mean_force > 0;  // contacts may just touch
  balance.residual =
      balance.jammed ? balance.largest_net_force / balance.mean_force : network_.largest_overlap / unit_;
  return balance;
}

Measurement StaticPacking::measure() const {
  return dem::measure(law_, grains_, Quads(count()), cell_, neighbours_.pairs());
}

State StaticPacking::state() const {
  State state = grains_.state(cell_, Quads(count()));
  state.time_us = time_;
  state.step = step_;
  return state;
}

}  // namespace grainlaw::dem
