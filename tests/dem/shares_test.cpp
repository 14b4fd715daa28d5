// Threads share a step without a trace in its result.
#include "grainlaw/dem/step/shares.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/element/thread_pool.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

/// A jammed packing under D2 with grains that fly about, lists and order of grains made anew many times.
State flow(int threads) {
  const Material m;
  const State start = test::squeezed(
      m, 1400, 6, 0.7, 0.1);  // six runs of grains: shares of five threads have neighbours on both sides
  const Vec3 edges = start.box.diagonal();
  Dynamics dynamics(m, start, threads);
  const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.1), rate = 1e-2;
  dynamics.start(dt, {rate, -rate, 0});
  for (int n = 1; n <= 300; ++n) {
    const double stretch = std::exp(rate * dt * n);
    dynamics.step({edges[0] * stretch, edges[1] / stretch, edges[2]}, {rate, -rate, 0});
  }
  EXPECT_GT(dynamics.neighbours().updates(), 20u);
  EXPECT_GT(dynamics.neighbours().sorts(), 2u);
  return dynamics.state();
}

// In what order forces are added depends on the instruction set.
TEST(Shares, TheirNumberChangesNoBitOfTheMotion) {
  std::set<std::size_t> lanes;
  for (const std::int64_t target : {HWY_SCALAR, HWY_AVX2, HWY_AVX3}) {
    if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    if (lanes.insert(force_lanes()).second) {
      const State alone = flow(1);
      for (const int threads : {2, 3, 5})
        EXPECT_TRUE(flow(threads) == alone) << threads << " threads, " << force_lanes() << " lanes";
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

// Instruction sets add in orders of their own: at first by rounding, later as far apart as chaos takes them.
TEST(Targets, GoApartByRoundingOnly) {
  const Material m;
  const State start = test::squeezed(m, 500, 6, 0.7, 0.1);
  const auto after = [&](std::int64_t target, int steps) {
    hwy::SetSupportedTargetsForTest(target);
    Dynamics dynamics(m, start);
    dynamics.start(time_step(m, dynamics.grains().smallest_radius(), 0.1), {});
    for (int n = 0; n < steps; ++n) dynamics.step();
    hwy::SetSupportedTargetsForTest(0);
    return dynamics.state();
  };
  const State plain = after(HWY_SCALAR, 50);
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    const State other = after(target, 50);
    double worst = 0;
    for (std::size_t i = 0; i < plain.count(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(other.position[i][c] - plain.position[i][c]));
    EXPECT_LT(worst,
              1e-11);  // mm; a rounding is 2e-15 mm, and grows by 1e3 in five contact durations at most
    EXPECT_GT(worst, 0);
  }
}

TEST(Shares, MoreThreadsThanBlocksOfGrainsDoNoHarm) {
  const Material m;
  const State start = test::squeezed(m, 61, 4, 0.7);
  const auto end = [&](int threads) {
    Dynamics dynamics(m, start, threads);
    dynamics.start(0.02, {});
    for (int n = 0; n < 50; ++n) dynamics.step();
    return dynamics.state();
  };
  EXPECT_TRUE(end(4) == end(1));
}

TEST(ThreadPool, RunsEveryPartEachTime) {
  ThreadPool team(3);
  ASSERT_EQ(team.threads(), 3);
  std::array<int, 3> sum{};
  for (int n = 1; n <= 200; ++n) team.run([&](int t) { sum[static_cast<std::size_t>(t)] += n * (t + 1); });
  EXPECT_EQ(sum, (std::array<int, 3>{20100, 40200, 60300}));
}

}  // namespace
}  // namespace grainlaw::dem
