// What several steps at a time could gain where grains do not fit into the caches: each run of 256 grains is
// moved as soon as its forces are complete, and the next step follows on behind, as far as partners reach in
// the order of the grains; so grains come from memory once for all steps of a sweep. Jammed packings of 1000
// grains are laid out to cubes and to long boxes, in which partners lie near. The most that could be gained:
// the list stays, nothing looks at a step, nothing is kept to go back to where a grain leaves the list, and
// pairs that meet from one end of the order to the other are left out. Usage: grainlaw_bench_several_steps
// [TURNS (5)]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

#include "grainlaw/dem/run/trial_packing.hpp"
#include "grainlaw/dem/step/advance.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "grainlaw/dem/step/neighbours.hpp"
#include "grainlaw/dem/step/shares.hpp"
#include "random_packing.hpp"

namespace {

using namespace grainlaw;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A packing in a box at rest, and the runs of its grains, each a share.
class Sweeps {
 public:
  Sweeps(const Material& material, const dem::State& state)
      : law_(dem::ContactLaw::of(material)),
        cell_(state.box),
        neighbours_(material.r_mean, 0.5 * state.box(0, 0)) {
    dem::Grains grains(state, material.rho);
    neighbours_ = dem::Neighbours(material.r_mean, grains.largest_radius());
    dt_ = dem::time_step(material, grains.smallest_radius(), 0.02);
    gamma_b_ = material.gamma_b;
    neighbours_.update(grains, cell_, 0);
    share_.grains = std::move(grains);
    cut();
  }

  std::size_t count() const { return share_.grains.count(); }
  std::size_t reach() const { return neighbours_.pairs().within.reach; }
  const dem::Quads& places() const { return share_.grains.place; }

  /// Forces of all, then motion of all.
  void one_step() {
    for (Run& run : runs_) add_forces(run);
    advance(0, static_cast<std::uint32_t>(count()));
  }
  /// The same `steps` times in one sweep, to the last bit.
  void sweep(std::size_t steps) {
    const std::size_t behind = furthest_ + 1;
    for (std::size_t front = 0; front < runs_.size() + (steps - 1) * behind; ++front)
      for (std::size_t k = 0; k < steps; ++k) {
        if (front < k * behind || front - k * behind >= runs_.size()) continue;
        Run& run = runs_[front - k * behind];
        add_forces(run);
        advance(run.first, run.last);
      }
  }

 private:
  struct Run {
    std::uint32_t first, last;
    std::size_t first_group, last_group;
    dem::CrossingPairs crossing;  ///< whose first grain in the order lies in here
  };

  void cut() {
    const dem::Pairs& pairs = neighbours_.pairs();
    const auto grains = static_cast<std::uint32_t>(count());
    std::size_t group = 0;
    for (std::uint32_t first = 0; first < grains; first += dem::GroupedPairs::block) {
      Run run{first, std::min(first + dem::GroupedPairs::block, grains), group, group, {}};
      while (group < pairs.within.groups.size() && pairs.within.groups[group].grain[0] < run.last) ++group;
      run.last_group = group;
      runs_.push_back(run);
    }
    furthest_ = pairs.within.reach;
    for (std::size_t p = 0; p < pairs.crossing.count; ++p) {
      const dem::CrossingPairs::Pair& pair = pairs.crossing.pairs[p];
      const auto [before, after] = std::minmax(pair.i, pair.j);
      if (after - before > grains / 2) continue;
      runs_[before / dem::GroupedPairs::block].crossing.pairs.push_back(pair);
      furthest_ = std::max<std::size_t>(furthest_, after - before);
    }
    for (Run& run : runs_) run.crossing.fill_up();
    furthest_ = furthest_ / dem::GroupedPairs::block + 1;
  }

  void add_forces(Run& run) {
    share_.first_group = run.first_group, share_.last_group = run.last_group;
    share_.crossing.pairs.swap(run.crossing.pairs);
    dem::add_contact_forces(law_, neighbours_.pairs(), cell_, share_);
    share_.crossing.pairs.swap(run.crossing.pairs);
  }
  void advance(std::uint32_t first, std::uint32_t last) {
    const dem::Stride at_rest{dt_, dem::Mat3::diagonal({1, 1, 1}), {}, gamma_b_, false};
    dem::advance(at_rest, neighbours_.reach(cell_), first, last, share_.grains);
  }

  dem::ContactLaw law_;
  dem::Cell cell_;
  dem::Neighbours neighbours_;
  double dt_, gamma_b_;
  dem::Share share_;
  std::vector<Run> runs_;
  std::size_t furthest_ = 0;  ///< runs from a grain to its partners
};

double largest_difference(const dem::Quads& a, const dem::Quads& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest =
        std::max({largest, std::abs(a[i].x - b[i].x), std::abs(a[i].y - b[i].y), std::abs(a[i].z - b[i].z)});
  return largest;
}

}  // namespace

int main(int words, char** word) {
  const int turns = words > 1 ? std::max(1, std::atoi(word[1])) : 5;
  Material material;
  const dem::State one = dem::random_packing(material, 1000, 1, 0.75, 1e-6).state();
  const std::vector<std::array<std::size_t, 3>> boxes{{1, 1, 1},    {2, 2, 2},  {3, 3, 3},  {5, 5, 5},
                                                      {10, 10, 10}, {40, 5, 5}, {111, 3, 3}};
  const std::vector<std::size_t> at_once{0, 1, 2, 4, 8};  // 0: step by step
  std::vector<std::unique_ptr<Sweeps>> packings;
  for (const auto& times : boxes)
    packings.push_back(std::make_unique<Sweeps>(material, dem::laid_out(one, times)));

  Sweeps by_steps(material, dem::laid_out(one, std::array<std::size_t, 3>{4, 2, 2})), swept = by_steps;
  const dem::Quads begin_places = by_steps.places();
  for (int k = 0; k < 8; ++k) by_steps.one_step();
  swept.sweep(8);
  std::printf("8 steps: places move by up to %g mm; in one sweep they differ by %g mm\n",
              largest_difference(begin_places, by_steps.places()),
              largest_difference(by_steps.places(), swept.places()));

  std::vector<std::vector<std::vector<double>>> cost(packings.size(),
                                                     std::vector<std::vector<double>>(at_once.size()));
  for (int turn = 0; turn <= turns; ++turn)
    for (std::size_t p = 0; p < packings.size(); ++p)
      for (std::size_t q = 0; q < at_once.size(); ++q) {
        Sweeps& packing = *packings[p];
        const std::size_t steps = std::max<std::size_t>(16, 3'000'000 / packing.count() / 8 * 8);
        const double begin = processor_seconds();
        for (std::size_t k = 0; k < steps; k += std::max<std::size_t>(1, at_once[q]))
          at_once[q] == 0 ? packing.one_step() : packing.sweep(at_once[q]);
        const double ns = (processor_seconds() - begin) * 1e9 / static_cast<double>(steps * packing.count());
        if (turn > 0) cost[p][q].push_back(ns);  // the first one warms up
      }
  std::printf("ns per particle-step, median and range\n%20s %7s", "", "reach");
  for (const std::size_t steps : at_once)
    std::printf(" %12zu%s", steps, steps == 0 ? " (two passes)" : " at a time ");
  std::printf("\n");
  for (std::size_t p = 0; p < packings.size(); ++p) {
    std::printf("%10zu %2zux%2zux%3zu %7zu", packings[p]->count(), boxes[p][0], boxes[p][1], boxes[p][2],
                packings[p]->reach());
    for (std::vector<double>& ns : cost[p]) {
      std::sort(ns.begin(), ns.end());
      std::printf("   %6.2f (%5.2f-%5.2f)", ns[ns.size() / 2], ns.front(), ns.back());
    }
    std::printf("\n");
  }
}
