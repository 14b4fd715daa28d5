#include "grainlaw/dem/run/trial_packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/dem/step/dynamics.hpp"

namespace grainlaw::dem {

namespace {

constexpr double trial_step = 0.1;  // over t_c, while trial packings are made
constexpr double settled = 1e-3;    // largest net force over the mean contact force
constexpr std::uint64_t most_passes = 5000;
// Packings of up to so many grains are tried as they are; larger ones are made of copies of one of at most
// base_grains. In copies of few grains lists live too long, the fastest of few being slower than of many; in
// whole packings of many not long enough, since a trial is less at rest than what it stands for.
constexpr std::size_t whole_trial = 20'000, base_grains = 10'000;

}  // namespace

bool is_laid_out(std::size_t count) { return count > whole_trial; }

State laid_out(const State& one, std::size_t times) { return laid_out(one, {times, times, times}); }

State laid_out(const State& one, const std::array<std::size_t, 3>& times) {
  State state = one;
  state.position.clear();
  state.velocity.clear();
  state.radius.clear();
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t edge = 0; edge < 3; ++edge)
      state.box(row, edge) = static_cast<double>(times[edge]) * one.box(row, edge);
  for (std::size_t a = 0; a < times[0]; ++a)
    for (std::size_t b = 0; b < times[1]; ++b)
      for (std::size_t c = 0; c < times[2]; ++c)
        for (std::size_t i = 0; i < one.count(); ++i) {
          const Vec3& x = one.position[i];
          const Vec3 edges{static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)},
              beside = one.box * edges;
          state.position.push_back({x[0] + beside[0], x[1] + beside[1], x[2] + beside[2]});
          state.velocity.push_back(one.velocity[i]);
          state.radius.push_back(one.radius[i]);
        }
  return state;
}

TrialPacking::TrialPacking(const Material& material, std::size_t count, const NewPacking& like)
    : material_(material) {
  const std::size_t wanted = std::min(count, largest_trial);
  while (wanted > whole_trial && wanted / (times_ * times_ * times_) > base_grains) ++times_;
  NewPacking packing = like;
  packing.count = static_cast<std::int64_t>(std::max<std::size_t>(8, wanted / (times_ * times_ * times_)));
  state_ = random_gas(material, packing);
  step_ = time_step(material, *std::min_element(state_.radius.begin(), state_.radius.end()), trial_step);
}

TrialPacking::TrialPacking(const Material& material, const State& own)
    : material_(material),
      own_(true),
      state_(own),
      step_(time_step(material, *std::min_element(own.radius.begin(), own.radius.end()), trial_step)) {}

void TrialPacking::compress_to(double nu) {
  const double strain = std::log(nu / state_.volume_fraction()) / 3;
  if (std::abs(strain) < 1e-4) return;
  go(Mode::iso, {strain, strain, strain}, 4e-5);
  go(Mode::relax, {}, 0);
}

void TrialPacking::shear() { go(Mode::d2, {-0.01, 0.01, 0}, 6e-6); }

void TrialPacking::settle() {
  own_ = false;
  StaticPacking packing(material_, state_);
  MinimiseOptions options;
  options.residual = settled;
  options.most_passes = most_passes;
  minimise(packing, options);
  state_ = packing.state();
}

std::optional<LegCost> TrialPacking::run(const Stage& stage, double budget) {
  Dynamics dynamics(material_, state_);
  const std::optional<LegCost> cost = try_leg(dynamics, stage, budget);
  own_ = false;
  state_ = dynamics.state();
  return cost;
}

State TrialPacking::state() const { return times_ > 1 ? laid_out(state_, times_) : state_; }

void TrialPacking::go(Mode mode, const StrainTensor& strain, double strain_per_step) {
  Leg leg{};
  leg.mode = mode;
  leg.strain = strain;
  const double largest = std::max({std::abs(strain[0]), std::abs(strain[1]), std::abs(strain[2])});
  leg.duration = step_ * (mode == Mode::relax ? 1000 : std::ceil(largest / strain_per_step));
  leg.profile = Profile::constant;
  leg.tolerance = 1e-6;
  Dynamics dynamics(material_, state_);
  drive(dynamics, leg, plan_steps(leg, step_, 1));
  own_ = false;
  state_ = dynamics.state();
}

}  // namespace grainlaw::dem
