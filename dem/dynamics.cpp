#include "grainlaw/dem/dynamics.hpp"

#include <cmath>

#include "grainlaw/dem/forces.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {
/// How many steps the list plans a flight of a grain for. Longer makes the list longer, shorter makes it more
/// often.
constexpr double planned_steps = 50;
}  // namespace

double time_step(const Material& material, double smallest_radius, double fraction) {
  const double duration = material.contact_duration(smallest_radius);
  if (!std::isfinite(duration))
    throw Error("the contact of two grains of radius " + to_text(smallest_radius) +
                " mm is overdamped and has no finite duration; gamma must be smaller");
  return fraction * duration;
}

Dynamics::Dynamics(const Material& material, const State& state)
    : material_(material),
      law_(LinearContact::of(material)),
      box_(state.box),
      grains_(state, material.rho),
      neighbours_(material.r_mean, grains_.largest_radius()),
      time_(state.time_us),
      steps_(state.step) {
  neighbours_.update(grains_, box_, 0);
}

void Dynamics::start(double dt, const Vec3& rate) {
  grains_.motion = velocities();
  dt_ = dt;
  box_.set(box_.length(), rate);
  update_forces();
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad now = acceleration(i), &v = grains_.motion[i];
    grains_.half[i] = {v.x - 0.5 * dt * now.x, v.y - 0.5 * dt * now.y, v.z - 0.5 * dt * now.z, 0};
    grains_.acceleration[i] = now;
  }
}

void Dynamics::step(const Vec3& length, const Vec3& rate) {
  move(length);
  box_.set(length, rate);
  update_forces();
  time_ += dt_;
  ++steps_;
}

Quad Dynamics::acceleration(std::size_t i) const {
  const Quad &f = grains_.force[i], &v = grains_.motion[i];
  const double inverse_mass = grains_.acceleration[i].w, drag = material_.gamma_b * inverse_mass;
  const Vec3& rate = box_.rate();
  return {f.x * inverse_mass - (drag + rate[0]) * v.x, f.y * inverse_mass - (drag + rate[1]) * v.y,
          f.z * inverse_mass - (drag + rate[2]) * v.z, inverse_mass};
}

/// From the forces at time n: takes the velocity from n - 1/2 to n + 1/2, moves the grains with it and with
/// the box, and predicts the velocity at n + 1.
void Dynamics::move(const Vec3& length) {
  const Vec3 stretch = {length[0] / box_.length()[0], length[1] / box_.length()[1],
                        length[2] / box_.length()[2]};
  // The fluctuation of a step is carried along by half of its deformation.
  const Vec3 path = {dt_ * std::sqrt(stretch[0]), dt_ * std::sqrt(stretch[1]), dt_ * std::sqrt(stretch[2])};
  const double half = 0.5 * dt_;
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad now = acceleration(i);
    Quad &x = grains_.place[i], &v = grains_.half[i], &before = grains_.acceleration[i];
    v.x += dt_ * now.x;
    v.y += dt_ * now.y;
    v.z += dt_ * now.z;
    x.x = stretch[0] * x.x + path[0] * v.x;
    x.y = stretch[1] * x.y + path[1] * v.y;
    x.z = stretch[2] * x.z + path[2] * v.z;
    grains_.motion[i] = {v.x + dt_ * now.x - half * before.x, v.y + dt_ * now.y - half * before.y,
                         v.z + dt_ * now.z - half * before.z, 0};
    before = now;
  }
}

void Dynamics::update_forces() {
  if (neighbours_.outdated(grains_, box_)) neighbours_.update(grains_, box_, planned_steps * dt_);
  contact_forces(law_, neighbours_.pairs(), box_, grains_);
}

std::vector<Quad> Dynamics::velocities() const {
  if (dt_ == 0) return grains_.motion;  // not started
  std::vector<Quad> v = grains_.half;
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad now = acceleration(i);
    v[i].x += 0.5 * dt_ * now.x;
    v[i].y += 0.5 * dt_ * now.y;
    v[i].z += 0.5 * dt_ * now.z;
  }
  return v;
}

Measurement Dynamics::measure() const {
  return dem::measure(law_, grains_, velocities(), box_, neighbours_.pairs());
}

State Dynamics::state() const {
  State state;
  state.box = box_.length();
  state.time_us = time_;
  state.step = steps_;
  state.position.resize(count());
  state.velocity.resize(count());
  state.radius.resize(count());
  const std::vector<Quad> velocity = velocities();
  for (std::size_t i = 0; i < count(); ++i) {
    const std::uint32_t original = grains_.id[i];
    const Quad &x = grains_.place[i], &v = velocity[i];
    state.position[original] = box_.wrap({x.x, x.y, x.z});
    state.velocity[original] = {v.x, v.y, v.z};
    state.radius[original] = x.w;
  }
  return state;
}

}  // namespace grainlaw::dem
