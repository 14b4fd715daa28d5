// Threads share a step without a trace in its result.
#include "grainlaw/dem/step/shares.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/thread_pool.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

struct Flow {
  std::vector<Sym6> stress;  ///< looked at now and then
  std::vector<double> energy;
  State end;
  Pairs pairs;
  std::size_t flights = 0;  ///< how often a grain was looked for among all others
  std::uint64_t updates = 0, sorts = 0;
};

/// A jammed packing under D2 with grains that fly about, lists and order of grains made anew many times.
Flow flow(int threads) {
  const Material m;
  const State start = test::squeezed(
      m, 1400, 6, 0.7, 0.1);  // six runs of grains: shares of five threads have neighbours on both sides
  const Vec3 edges = start.box.diagonal();
  Dynamics dynamics(m, start, threads);
  const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.1), rate = 1e-2;
  dynamics.start(dt, {rate, -rate, 0});
  Flow flow;
  for (int n = 1; n <= 300; ++n) {
    const double stretch = std::exp(rate * dt * n);
    dynamics.step({edges[0] * stretch, edges[1] / stretch, edges[2]}, {rate, -rate, 0});
    if (n % 7 != 0) continue;
    flow.stress.push_back(dynamics.static_stress());
    flow.energy.push_back(dynamics.energies().kinetic);
    for (const CrossingPairs::Pair& pair : dynamics.neighbours().pairs().crossing.pairs)
      flow.flights += pair.image == Cell::home_image && pair.i != pair.j;
  }
  EXPECT_GT(dynamics.neighbours().updates(), 20u);
  EXPECT_GT(dynamics.neighbours().sorts(), 2u);
  flow.updates = dynamics.neighbours().updates();
  flow.sorts = dynamics.neighbours().sorts();
  flow.end = dynamics.state();
  flow.pairs = dynamics.neighbours().pairs();
  return flow;
}

void expect_same_list(const Pairs& a, const Pairs& b) {
  EXPECT_EQ(a.within.count, b.within.count);
  EXPECT_EQ(a.within.partner, b.within.partner);
  ASSERT_EQ(a.within.groups.size(), b.within.groups.size());
  for (std::size_t g = 0; g < a.within.groups.size(); ++g) {
    EXPECT_EQ(a.within.groups[g].grain, b.within.groups[g].grain) << g;
    EXPECT_EQ(a.within.groups[g].first, b.within.groups[g].first) << g;
    EXPECT_EQ(a.within.groups[g].last, b.within.groups[g].last) << g;
  }
  EXPECT_EQ(a.crossing.count, b.crossing.count);
  const auto same = [](const CrossingPairs::Pair& p, const CrossingPairs::Pair& q) {
    return p.i == q.i && p.j == q.j && p.image == q.image;
  };
  EXPECT_TRUE(std::equal(a.crossing.pairs.begin(), a.crossing.pairs.end(), b.crossing.pairs.begin(),
                         b.crossing.pairs.end(), same));
}

// In what order forces are added depends on the instruction set.
TEST(Shares, TheirNumberChangesNoBitOfTheMotion) {
  for (const std::int64_t target : {HWY_SCALAR, HWY_AVX2, HWY_AVX3}) {
    if (target != HWY_SCALAR && (hwy::SupportedTargets() & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target);
    const Flow alone = flow(1);
    EXPECT_GT(alone.flights, 0u);
    for (const int threads : {2, 5}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, " + hwy::TargetName(target));
      const Flow shared = flow(threads);
      EXPECT_TRUE(shared.end == alone.end);
      EXPECT_EQ(shared.stress, alone.stress);
      EXPECT_EQ(shared.energy, alone.energy);
      EXPECT_EQ(shared.flights, alone.flights);
      EXPECT_EQ(shared.updates, alone.updates);
      EXPECT_EQ(shared.sorts, alone.sorts);
      expect_same_list(shared.pairs, alone.pairs);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

/// Where a flow comes to that is copied, kept and read back, and started again, each in the middle of it.
std::vector<State> eventful(const Material& m, const Mat3& gradient, int threads, int threads_of_reader) {
  Dynamics dynamics(m, test::squeezed(m, 700, 4, 0.7, 0.2), threads);
  double dt = time_step(Material{}, dynamics.grains().smallest_radius(), 0.1);
  const auto go = [&](Dynamics& d, const Mat3& with) {
    for (int n = 0; n < 30; ++n) d.step(test::deformation(with, dt) * d.cell().edges(), with);
  };
  std::vector<State> states;
  dynamics.start_flow(dt, gradient);
  go(dynamics, gradient);
  Dynamics copy = dynamics;
  const auto file =
      std::filesystem::temp_directory_path() / ("grainlaw-shares-" + std::to_string(::getpid()));
  ArchiveWriter writer(file);
  writer(dynamics);
  writer.finish();
  go(dynamics, gradient);
  go(copy, gradient);
  ArchiveReader reader(file);
  Dynamics read(m, reader, threads_of_reader);
  reader.finish();
  std::filesystem::remove(file);
  go(read, gradient);
  for (const Dynamics* d : {&dynamics, &copy, &read}) states.push_back(d->state());
  EXPECT_TRUE(states[0] == states[1] && states[0] == states[2]);
  dt *= 0.7;
  dynamics.start_flow(dt, 0.5 * gradient);
  go(dynamics, 0.5 * gradient);
  states.push_back(dynamics.state());
  return states;
}

TEST(Shares, ComeToTheSameThroughCopiesCheckpointsAndStarts) {
  Material undamped;
  undamped.gamma = 0;
  for (const Material& m : {Material{}, undamped})
    for (const Mat3& gradient : {Mat3::diagonal({5e-3, -5e-3, 1e-3}),
                                 Mat3{{5e-3, 2e-3, -1e-3}, {5e-4, -5e-3, 2e-3}, {0, -2e-3, 1e-3}}}) {
      const std::vector<State> alone = eventful(m, gradient, 1, 1);
      EXPECT_TRUE(eventful(m, gradient, 2, 3) == alone);
      EXPECT_TRUE(eventful(m, gradient, 3, 1) == alone);
    }
}

// What a step has of another share are the places and motions of the grains that it lists there, and no more.
TEST(Shares, ReadNoGrainOfAnotherThatTheyDoNotList) {
  const Material m;
  Dynamics dynamics(m, test::squeezed(m, 1400, 6, 0.7, 0.1));
  const Pairs& pairs = dynamics.neighbours().pairs();
  const std::size_t count = dynamics.count();
  Grains expected = dynamics.grains();
  add_contact_forces(dynamics.law(), pairs, dynamics.cell(), expected);
  for (std::size_t index = 0; index < 5; ++index) {
    Share share;
    deal(pairs, count, index, 5, force_lanes(), share);
    EXPECT_TRUE(std::is_sorted(share.foreign.begin(), share.foreign.end()));
    EXPECT_GT(share.foreign.size(), 0u);
    EXPECT_LT(share.foreign.size() + (share.last - share.first), count);
    share.grains = dynamics.grains();
    for (std::uint32_t i = 0; i < count; ++i)
      if (!share.owns(i) && !std::binary_search(share.foreign.begin(), share.foreign.end(), i))
        share.grains.place[i].x = share.grains.motion[i].x = std::numeric_limits<double>::quiet_NaN();
    add_contact_forces(dynamics.law(), pairs, dynamics.cell(), share);
    for (std::uint32_t i = share.first; i < share.last; ++i) {
      EXPECT_EQ(share.grains.force[i].x, expected.force[i].x) << i;
      EXPECT_EQ(share.grains.force[i].y, expected.force[i].y) << i;
      EXPECT_EQ(share.grains.force[i].z, expected.force[i].z) << i;
    }
  }
}

// Two runs of 256, and one of them with a grain that is nobody's first.
TEST(Shares, MayBeOfOneGrainOrOfWholeRuns) {
  const Material m;
  for (const int count : {257, 512}) {
    const State start = test::squeezed(m, count, 4, 0.7, 0.1);
    const auto end = [&](int threads) {
      Dynamics dynamics(m, start, threads);
      EXPECT_EQ(dynamics.threads(), threads);
      dynamics.start(0.02, {});
      for (int n = 0; n < 200; ++n) dynamics.step();
      return dynamics.state();
    };
    EXPECT_TRUE(end(2) == end(1)) << count;
  }
}

TEST(Shares, AreNoMoreThanRunsOfGrains) {
  const Material m;
  const State start = test::squeezed(m, 61, 4, 0.7);
  const auto end = [&](int threads) {
    Dynamics dynamics(m, start, threads);
    EXPECT_EQ(dynamics.threads(), 1);
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

TEST(ThreadPool, GivesEachThreadACopyOfItsOwn) {
  ThreadPool team(3);
  std::array<const double*, 3> at{};
  team.run([&at, captured = 0.5](int t) {
    EXPECT_EQ(captured, 0.5);
    at[static_cast<std::size_t>(t)] = &captured;
  });
  EXPECT_TRUE(at[0] != at[1] && at[1] != at[2] && at[2] != at[0]);
}

TEST(ThreadPool, ThrowsWhatAPartThrewOnceAllHaveMet) {
  ThreadPool team(3);
  for (const int bad : {0, 2}) {
    std::array<int, 3> done{};
    EXPECT_THROW(team.run([&](int t) {
      if (t == bad) throw Error("out of grains");
      done[static_cast<std::size_t>(t)] = 1;
    }),
                 Error);
    EXPECT_EQ(done[0] + done[1] + done[2], 2);
  }
  int sum = 0;
  team.run([&](int t) {
    if (t == 0) sum = 1;
  });
  EXPECT_EQ(sum, 1);
}

}  // namespace
}  // namespace grainlaw::dem
