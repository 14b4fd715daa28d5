// grainlaw_bench_six_systems SNAPSHOTS.h5 NU... : the six systems of linear response solved in step against
// one after the other, in alternating pairs, in processor time. Prints for each density the ratio in the
// median pair and its range, and by how much the two solutions differ.
#include "grainlaw/dem/stiffness/six_systems.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "one_by_one.hpp"

namespace {

using namespace grainlaw;
using namespace grainlaw::dem;

constexpr int pairs = 7;
constexpr double residual = 1e-6, floor_share = 1e-3;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Balanced to 1e-10, and without what its rattlers touch.
ContactNetwork network_of(StaticPacking& packing) {
  MinimiseOptions options;
  options.residual = 1e-10;
  minimise(packing, options);
  return bearing(packing.network(), packing.backbone());
}

/// Right-hand sides that have a solution: random pairs of forces on grains that touch.
SixFields forces(const ContactNetwork& network, std::size_t grains) {
  Random random(1);
  SixFields b(grains);
  for (std::size_t c = 0; c < network.count; ++c) {
    const Quad& n = network.normal[c];
    for (std::size_t a = 0; a < 6; ++a) {
      const double f = random.normal();
      const std::array<double, 3> along{f * n.x, f * n.y, f * n.z};
      for (std::size_t k = 0; k < 3; ++k) {
        b[network.pairs[c].i].q[k][a] += along[k];
        b[network.pairs[c].j].q[k][a] -= along[k];
      }
    }
  }
  return b;
}

Field one_of(const SixFields& b, std::size_t a) {
  Field one(b.size());
  for (std::size_t g = 0; g < b.size(); ++g) one[g] = {b[g].q[0][a], b[g].q[1][a], b[g].q[2][a], 0};
  return one;
}

struct Turn {
  double in_step, one_by_one, difference;
  std::uint64_t iterations, products;
};

Turn turn(const ContactNetwork& network, std::size_t grains, double floor, const SixFields& b) {
  Turn result{};
  double begin = processor_seconds();
  SixSystems systems(network, grains, floor);
  SixFields r = b, x(grains);
  SixSystems::Options options;
  options.residual = residual;
  result.iterations = systems.solve(r, x, options).iterations;
  result.in_step = processor_seconds() - begin;
  begin = processor_seconds();
  OneSystem system(network, grains, floor);
  std::array<Field, 6> y;
  for (std::size_t a = 0; a < 6; ++a) result.products += system.solve(one_of(b, a), residual, y[a]);
  result.one_by_one = processor_seconds() - begin;
  double largest = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    Field difference = one_of(x, a);
    add(-1, y[a], difference);
    result.difference = std::max(result.difference, std::sqrt(largest_square(difference)));
    largest = std::max(largest, std::sqrt(largest_square(y[a])));
  }
  result.difference /= largest;
  return result;
}

void compare(const std::string& file, double nu) {
  FrameChoice choice;
  choice.nu = nu;
  choice.segment = list_frames(file).back().segment;
  StaticPacking packing(Material{}, read_frame(file, choice));
  const ContactNetwork network = network_of(packing);
  const double floor = floor_share * packing.law().stiffness(0);
  const SixFields b = forces(network, packing.count());
  std::vector<Turn> turns;
  for (int n = 0; n < pairs; ++n) turns.push_back(turn(network, packing.count(), floor, b));
  std::sort(turns.begin(), turns.end(),
            [](const Turn& p, const Turn& q) { return p.one_by_one / p.in_step < q.one_by_one / q.in_step; });
  const Turn &median = turns[pairs / 2], &least = turns.front(), &most = turns.back();
  std::printf(
      "nu %.3f  one by one over in step: %.2f (%.2f-%.2f)  %.3f and %.3f s  %llu iterations, %llu products"
      "  largest difference %.0e\n",
      nu, median.one_by_one / median.in_step, least.one_by_one / least.in_step,
      most.one_by_one / most.in_step, median.one_by_one, median.in_step,
      static_cast<unsigned long long>(median.iterations), static_cast<unsigned long long>(median.products),
      median.difference);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s SNAPSHOTS.h5 NU...\n", argv[0]);
    return 2;
  }
  for (int a = 2; a < argc; ++a) compare(argv[1], std::strtod(argv[a], nullptr));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
