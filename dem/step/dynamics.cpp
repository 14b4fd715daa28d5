#include "grainlaw/dem/step/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grainlaw/dem/step/advance.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {
/// How many steps the list plans a flight of a grain for. Longer makes the list longer, shorter makes it more
/// often.
constexpr double planned_steps = 50;

/// As many as have grains to move.
int busy_threads(int wanted, std::size_t grains) {
  const std::size_t runs = (grains + GroupedPairs::block - 1) / GroupedPairs::block;
  return std::clamp(wanted, 1, static_cast<int>(std::clamp<std::size_t>(runs, 1, 1024)));
}
}  // namespace

double time_step(const Material& material, double smallest_radius, double fraction) {
  const double duration = material.contact_duration(smallest_radius);
  if (!std::isfinite(duration))
    throw Error("the contact of two grains of radius " + to_text(smallest_radius) +
                " mm is overdamped and has no finite duration; gamma must be smaller");
  return fraction * duration;
}

double step_of_contact_error(double error) {
  if (error < 1e-6) return std::sqrt(24 * error) / std::numbers::pi * (1 - 0.85 * error);  // to error^2
  double y = std::sqrt(6 * error);  // sin(y)/y = 1 - error, to leading order; then by Newton's steps
  for (int i = 0; i < 8; ++i) {
    const double slope = (y * std::cos(y) - std::sin(y)) / (y * y);
    y -= (std::sin(y) / y - 1 + error) / slope;
  }
  return 2 / std::numbers::pi * std::sin(y);
}

Dynamics::Dynamics(const Material& material, const State& state, int threads)
    : material_(material),
      law_(ContactLaw::of(material)),
      cell_(state.box),
      grains_(state, material.rho),
      neighbours_(material.r_mean, grains_.largest_radius()),
      time_(state.time_us),
      steps_(state.step),
      threads_(busy_threads(threads, state.count())) {
  update_list(0);
}

Dynamics::Dynamics(const Material& material, ArchiveReader& archive, int threads)
    : material_(material), law_(ContactLaw::of(material)), neighbours_(material.r_mean, 0) {
  keep(*this, archive);
  threads_ = busy_threads(threads, count());
  neighbours_.rebuild(grains_);
  if (dt_ > 0) deal_out();
}

void Dynamics::deal_out() {
  if (threads_ == 1) return;
  if (!team_) team_.emplace(threads_);
  team_->deal(neighbours_.pairs(), grains_, true);
}

void Dynamics::start_flow(double dt, const Mat3& gradient) {
  grains_.motion = velocities();
  dt_ = dt;
  cell_ = cell_.moved(cell_.edges(), gradient);
  std::fill(grains_.force.begin(), grains_.force.end(), Quad{});
  if (neighbours_.outdated(grains_, cell_)) update_list(planned_steps * dt_);
  add_contact_forces(law_, neighbours_.pairs(), cell_, grains_);
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad now = acceleration(i), &v = grains_.motion[i];
    grains_.half[i] = {v.x - 0.5 * dt * now.x, v.y - 0.5 * dt * now.y, v.z - 0.5 * dt * now.z, 0};
    grains_.acceleration[i] = now;
  }
  deal_out();
}

void Dynamics::step(const Mat3& edges, const Mat3& gradient) {
  const Cell next = cell_.moved(edges, gradient);
  const double excess = advance_grains(next);
  if (!std::isfinite(excess))
    throw Error("the motion of the grains became unstable " + to_text(time_) +
                " us after its start; measure.time_step (or time_step_gas) must be smaller");
  cell_ = next;
  if (neighbours_.outdated(cell_, excess)) update_list(planned_steps * dt_);
  if (!team_) add_contact_forces(law_, neighbours_.pairs(), cell_, grains_);
  time_ += dt_;
  ++steps_;
}

double Dynamics::advance_grains(const Cell& next) {
  const ListReach list = neighbours_.reach(next);
  const Stride stride{dt_, next.deformation_from(cell_.edges()), cell_.gradient(), material_.gamma_b,
                      next.tilted() || cell_.tilted() || !list.deformation.is_diagonal()};
  if (!team_) return advance(stride, list, grains_);
  behind_ = true;
  return team_->advance(law_, neighbours_.pairs(), cell_, stride, list);
}

void Dynamics::update_list(double lookahead) {
  if (!team_) return neighbours_.update(grains_, cell_, lookahead);
  if (behind_) team_->gather_motion(grains_);
  const bool sorted = !neighbours_.update_inner(grains_, cell_, lookahead, &team_->pool());
  if (sorted) {
    if (behind_) team_->gather(grains_);
    neighbours_.renew(grains_, cell_, lookahead, &team_->pool());
  }
  team_->deal(neighbours_.pairs(), grains_, sorted);
}

void Dynamics::catch_up() const {
  if (!behind_) return;
  team_->add_contact_forces(law_, neighbours_.pairs(), cell_);
  team_->gather(grains_);
  behind_ = false;
}

Quad Dynamics::acceleration(std::size_t i) const {
  return dem::acceleration(grains_.force[i], grains_.motion[i], grains_.acceleration[i], material_.gamma_b,
                           cell_.gradient());
}

Quads Dynamics::velocities() const {
  catch_up();
  if (dt_ == 0) return grains_.motion;  // not started
  Quads v = grains_.half;
  for (std::size_t i = 0; i < count(); ++i) {
    const Quad now = acceleration(i);
    v[i].x += 0.5 * dt_ * now.x;
    v[i].y += 0.5 * dt_ * now.y;
    v[i].z += 0.5 * dt_ * now.z;
  }
  return v;
}

Measurement Dynamics::measure(const Wanted& wanted) const {
  return dem::measure(law_, grains(), velocities(), cell_, neighbours_.pairs(), wanted);
}

Sym6 Dynamics::static_stress() const {
  return dem::static_stress(law_, grains(), grains().motion, cell_, neighbours_.pairs());
}

Energies Dynamics::energies() const {
  return dem::energies(law_, grains(), velocities(), cell_, neighbours_.pairs());
}

State Dynamics::state() const {
  State state = grains().state(cell_, velocities());
  state.time_us = time_;
  state.step = steps_;
  return state;
}

void Dynamics::begin_anew(const State& state) {
  team_.reset();
  grains_ = {};
  neighbours_ = Neighbours(material_.r_mean, 0);
  dt_ = 0;
  behind_ = false;
  try {
    *this = Dynamics(material_, state, threads_);
  } catch (...) {
    grains_ = Grains(state, material_.rho);
    cell_ = Cell(state.box);
    throw;
  }
}

}  // namespace grainlaw::dem
