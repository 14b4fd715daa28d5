// Cost of a particle-step against the size of the packing: one jammed packing of 1000 grains, laid out 1, 2,
// 4, ... times along each axis, so that all sizes do the same thing, under D2 flow with list updates. Turns
// go around the sizes; median of the turns, and by how much the process grew with each packing. Usage:
// grainlaw_bench_packing_size [MOST TIMES (10, that is 1e6 grains)] [TURNS (5)] [W (3)] [TIME STEP (over t_c,
// 0.02)]
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <vector>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "random_packing.hpp"

namespace {

using namespace grainlaw;

/// Of this process, in memory.
double resident_bytes() {
  std::ifstream pages("/proc/self/statm");
  double all = 0, resident = 0;
  pages >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Nanoseconds per particle-step.
double turn(dem::Dynamics& dynamics, double dt) {
  const std::uint64_t steps = std::max<std::uint64_t>(20, 5'000'000 / dynamics.count());
  Leg d2{};
  d2.mode = Mode::d2;
  d2.duration = dt * static_cast<double>(steps);
  d2.strain = {-2.839e-5 * d2.duration, 2.839e-5 * d2.duration, 0};
  d2.profile = Profile::constant;
  const double begin = processor_seconds();
  dem::drive(dynamics, d2, dem::plan_steps(d2, d2.duration, steps));
  return (processor_seconds() - begin) * 1e9 / static_cast<double>(steps * dynamics.count());
}

}  // namespace

int main(int words, char** word) {
  const std::size_t most = words > 1 ? std::strtoull(word[1], nullptr, 10) : 10;
  const int turns = words > 2 ? std::atoi(word[2]) : 5;
  Material material;
  if (words > 3) material.w = std::atof(word[3]);
  const double fraction = words > 4 ? std::atof(word[4]) : 0.02;
  const dem::State one = dem::random_packing(material, 1000, 1, 0.75, 1e-6).state();
  std::vector<std::unique_ptr<dem::Dynamics>> packings;
  std::vector<double> bytes;
  for (const std::size_t times : {1, 2, 3, 4, 5, 6, 8, 10}) {
    if (times > most) break;
    const double before = resident_bytes();
    packings.push_back(std::make_unique<dem::Dynamics>(material, dem::laid_out(one, times)));
    bytes.push_back(resident_bytes() - before);
  }
  std::vector<std::vector<double>> cost(packings.size());
  for (int k = 0; k <= turns; ++k)
    for (std::size_t p = 0; p < packings.size(); ++p) {
      dem::Dynamics& dynamics = *packings[p];
      const double dt = dem::time_step(material, dynamics.grains().smallest_radius(), fraction);
      const double ns = turn(dynamics, dt);
      if (k > 0) cost[p].push_back(ns);  // the first one warms up
    }
  std::printf("%10s %24s %10s %12s %6s\n", "grains", "ns per particle-step", "over 1000", "contacts/N", "MB");
  for (std::size_t p = 0; p < packings.size(); ++p) {
    std::sort(cost[p].begin(), cost[p].end());
    const double median = cost[p][cost[p].size() / 2];
    std::printf("%10zu %10.2f (%.2f-%.2f) %10.2f %12.3f %6.0f\n", packings[p]->count(), median,
                cost[p].front(), cost[p].back(), median / cost[0][cost[0].size() / 2],
                packings[p]->measure().C / 2, bytes[p] / 1e6);
  }
}
