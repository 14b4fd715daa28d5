// Particle-steps per second of the engine, in a jammed packing under D2 flow, list updates included: of
// processor time, or with several threads of the clock on the wall. With `pair`, one run on two threads
// against two runs side by side, in turns: `share` is what the first makes of the second. Usage:
// grainlaw_bench_dem_step [COUNT] [REPEATS] [TIME_STEP (over t_c)] [THREADS | pair] [W (3)] [GAMMA (1000)]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>
#include <vector>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/scene/preparation.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/step/forces.hpp"

namespace {

using namespace grainlaw;

/// Of this process: a busy machine slows it less than the clock on the wall.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A packing at nu = 0.75, compressed faster than a real one: only its neighbourhoods matter here.
dem::State jammed(const Material& material, std::int64_t count) {
  dem::NewPacking packing;
  packing.count = count;
  packing.nu_gas = 0.45;
  packing.nu = 0.75;
  packing.rate = 2e-3;
  packing.relax.duration = 100;
  dem::Dynamics dynamics(material, dem::random_gas(material, packing));
  const double dt = dem::time_step(material, dynamics.grains().smallest_radius(), 0.1);
  const Leg compression = dem::compression_leg(packing), rest = dem::relaxation_leg(packing.relax);
  dem::drive(dynamics, compression, dem::plan_steps(compression, dt, 1));
  dem::drive(dynamics, rest, dem::plan_steps(rest, dt, 1));
  return dynamics.state();
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Flow {
  Leg leg{};
  double dt;
  std::uint64_t steps;
  double particle_steps;
};

Flow flow_of(const dem::Dynamics& dynamics, double fraction) {
  Flow flow;
  const auto count = dynamics.count();
  flow.dt = dem::time_step(dynamics.material(), dynamics.grains().smallest_radius(), fraction);
  flow.steps = std::max<std::uint64_t>(200, 20'000'000 / count);
  flow.particle_steps = static_cast<double>(flow.steps) * static_cast<double>(count);
  flow.leg.mode = Mode::d2;
  flow.leg.duration = flow.dt * static_cast<double>(flow.steps);
  flow.leg.strain = {-2.839e-5 * flow.leg.duration, 2.839e-5 * flow.leg.duration, 0};
  flow.leg.profile = Profile::constant;
  return flow;
}

void go(dem::Dynamics& dynamics, const Flow& flow) {
  dem::drive(dynamics, flow.leg, dem::plan_steps(flow.leg, flow.dt * 1.000001, 1));
}

void print_speeds(const dem::Dynamics& dynamics, double fraction, std::vector<double> speeds) {
  std::sort(speeds.begin(), speeds.end());
  const auto m = dynamics.measure();
  std::printf(
      "N = %zu, w = %g, gamma = %g, t_c/%.0f, %d threads: median %.2f M particle-steps/s (%.2f-%.2f), %.1f M "
      "contact-steps/s; C = %.3f, nu = %.3f\n",
      dynamics.count(), dynamics.material().w, dynamics.material().gamma, 1 / fraction, dynamics.threads(),
      speeds[speeds.size() / 2], speeds.front(), speeds.back(), speeds[speeds.size() / 2] * m.C / 2, m.C,
      m.nu);
}

void time_one(dem::Dynamics dynamics, double fraction, int repeats) {
  const Flow flow = flow_of(dynamics, fraction);
  std::vector<double> speeds;
  for (int k = 0; k < repeats + 1; ++k) {
    const auto updates = dynamics.neighbours().updates(), sorts = dynamics.neighbours().sorts();
    const auto now = dynamics.threads() > 1 ? wall_seconds : processor_seconds;
    const double begin = now();
    go(dynamics, flow);
    const double time = now() - begin;
    if (k == 0) continue;  // warm up
    speeds.push_back(flow.particle_steps / time / 1e6);
    const auto per = [&](std::uint64_t before, std::uint64_t after) {
      return static_cast<double>(flow.steps) / static_cast<double>(after - before);
    };
    std::printf(
        "%.2f M particle-steps/s; %.1f steps per list, %.0f per sort; %.2f pairs per grain\n", speeds.back(),
        per(updates, dynamics.neighbours().updates()), per(sorts, dynamics.neighbours().sorts()),
        static_cast<double>(dynamics.neighbours().pairs().count()) / static_cast<double>(dynamics.count()));
  }
  print_speeds(dynamics, fraction, speeds);
}

void time_pair(const Material& material, const dem::State& state, double fraction, int repeats) {
  dem::Dynamics two(material, state, 2), one(material, state), other(material, state);
  const Flow flow = flow_of(one, fraction);
  std::vector<double> together, beside, share;
  for (int k = 0; k < repeats + 1; ++k) {
    double begin = wall_seconds();
    go(two, flow);
    const double of_team = flow.particle_steps / (wall_seconds() - begin) / 1e6;
    begin = wall_seconds();
    std::thread neighbour([&] { go(other, flow); });
    go(one, flow);
    neighbour.join();
    const double of_two = 2 * flow.particle_steps / (wall_seconds() - begin) / 1e6;
    if (k == 0) continue;
    together.push_back(of_team), beside.push_back(of_two), share.push_back(of_team / of_two);
  }
  print_speeds(two, fraction, together);
  print_speeds(one, fraction, beside);
  std::sort(share.begin(), share.end());
  std::printf("share: %.2f (%.2f-%.2f)\n", share[share.size() / 2], share.front(), share.back());
}

}  // namespace

int main(int words, char** word) {
  const std::int64_t count = words > 1 ? std::atoll(word[1]) : 9261;
  const int repeats = words > 2 ? std::atoi(word[2]) : 5;
  const double fraction = words > 3 ? std::atof(word[3]) : 0.1;
  Material material;
  if (words > 5) material.w = std::atof(word[5]);
  if (words > 6) material.gamma = std::atof(word[6]);
  const dem::State state = jammed(material, count);
  if (words > 4 && std::strcmp(word[4], "pair") == 0)
    time_pair(material, state, fraction, repeats);
  else
    time_one(dem::Dynamics(material, state, words > 4 ? std::atoi(word[4]) : 1), fraction, repeats);
}
