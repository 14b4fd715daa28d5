// Particle-steps per second of processor time of the engine, in a jammed packing under D2 flow, list updates
// included. Usage: grainlaw_bench_dem_step [COUNT] [REPEATS] [TIME_STEP (over t_c)]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "grainlaw/dem/drive.hpp"
#include "grainlaw/dem/dynamics.hpp"
#include "grainlaw/dem/forces.hpp"
#include "grainlaw/dem/preparation.hpp"

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

}  // namespace

int main(int count_of_arguments, char** arguments) {
  const std::int64_t count = count_of_arguments > 1 ? std::atoll(arguments[1]) : 9261;
  const int repeats = count_of_arguments > 2 ? std::atoi(arguments[2]) : 5;
  const double fraction = count_of_arguments > 3 ? std::atof(arguments[3]) : 0.1;
  const Material material;
  dem::Dynamics dynamics(material, jammed(material, count));
  const double dt = dem::time_step(material, dynamics.grains().smallest_radius(), fraction);
  const std::uint64_t steps = std::max<std::uint64_t>(200, 20'000'000 / static_cast<std::uint64_t>(count));
  Leg flow{};
  flow.mode = Mode::d2;
  flow.duration = dt * static_cast<double>(steps);
  flow.strain = {-2.839e-5 * flow.duration, 2.839e-5 * flow.duration, 0};
  flow.profile = Profile::constant;
  std::vector<double> speeds;
  for (int k = 0; k < repeats + 1; ++k) {
    const auto updates = dynamics.neighbours().updates(), sorts = dynamics.neighbours().sorts();
    const double begin = processor_seconds();
    dem::drive(dynamics, flow, dem::plan_steps(flow, dt * 1.000001, 1));
    const double wall = processor_seconds() - begin;
    if (k == 0) continue;  // warm up
    speeds.push_back(static_cast<double>(steps) * static_cast<double>(count) / wall / 1e6);
    std::printf("%.2f M particle-steps/s; %.1f steps per list, %.0f per sort; %.2f pairs per grain\n",
                speeds.back(),
                static_cast<double>(steps) / static_cast<double>(dynamics.neighbours().updates() - updates),
                static_cast<double>(steps) / static_cast<double>(dynamics.neighbours().sorts() - sorts),
                static_cast<double>(dynamics.neighbours().pairs().count()) / static_cast<double>(count));
  }
  std::sort(speeds.begin(), speeds.end());
  const auto m = dynamics.measure();
  std::printf("N = %lld, t_c/%.0f: median %.2f M particle-steps/s (%.2f-%.2f); C = %.3f, nu = %.3f\n",
              static_cast<long long>(count), 1 / fraction, speeds[speeds.size() / 2], speeds.front(),
              speeds.back(), m.C, m.nu);
}
