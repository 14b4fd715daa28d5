// The neighbour list against brute force over all images, at random moments of runs in which grains fly and
// the box deforms.
#include "grainlaw/dem/step/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

struct Flow {
  const char* name;
  double w;
  std::int64_t count;
  double nu, speed;
  Mat3 gradient;  ///< 1/us
  int steps;
  int images = 2;  ///< edges that the farthest image to look at lies away
};

Mat3 axes(double x, double y, double z) { return Mat3::diagonal({x, y, z}); }

void PrintTo(const Flow& flow, std::ostream* out) { *out << flow.name; }

class NeighboursInFlow : public testing::TestWithParam<Flow> {};

TEST_P(NeighboursInFlow, EqualBruteForce) {
  const Flow flow = GetParam();
  Material m;
  m.w = flow.w;
  const State start = test::squeezed(m, flow.count, 11, flow.nu, flow.speed);
  Dynamics dynamics(m, start);
  const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.1);
  Random random(5);
  dynamics.start_flow(dt, flow.gradient);
  int checks = 0;
  for (int n = 1; n <= flow.steps; ++n) {
    dynamics.step(test::deformation(flow.gradient, dt * n) * start.box, flow.gradient);
    if (random.below(static_cast<std::uint64_t>(flow.steps) / 40) != 0 && n != flow.steps) continue;
    ++checks;
    const auto is = test::listed(dynamics), should = test::brute_force(dynamics.state(), flow.images);
    ASSERT_EQ(is.size(), should.size()) << "step " << n;
    for (std::size_t c = 0; c < is.size(); ++c) {
      EXPECT_EQ(std::get<0>(is[c]), std::get<0>(should[c]));
      EXPECT_EQ(std::get<1>(is[c]), std::get<1>(should[c]));
      EXPECT_NEAR(std::get<2>(is[c]), std::get<2>(should[c]), 1e-10);
    }
  }
  EXPECT_GT(checks, 10);
  EXPECT_LT(dynamics.neighbours().updates(), static_cast<std::uint64_t>(flow.steps));  // or it is no list
}

INSTANTIATE_TEST_SUITE_P(
    Flows, NeighboursInFlow,
    testing::Values(
        Flow{"gas", 3, 200, 0.3, 0.5, axes(0, 0, 0), 2000},
        Flow{"compressed gas", 3, 200, 0.3, 0.1, axes(-5e-3, -5e-3, -5e-3), 2500},
        Flow{"decompression", 3, 200, 0.8, 0.02, axes(3e-3, 3e-3, 3e-3), 2000},
        // eps_dev = 2: x and y change by a factor 3.2
        Flow{"d2 to large strain", 3, 300, 0.7, 0.02, axes(1e-2, -1e-2, 0), 5060},
        Flow{"w = 10", 10, 200, 0.7, 0.05, axes(2e-3, -2e-3, 0), 4000},
        // under two cut-offs wide: the same two grains touch through several images
        Flow{"eight grains", 3, 8, 0.75, 0.02, axes(3e-4, -3e-4, 0), 4000},
        Flow{"narrow", 3, 60, 0.7, 0.05, axes(5e-3, 5e-3, -5e-3), 5000},
        // to gamma = 2
        Flow{"simple shear", 3, 60, 0.7, 0.05, {{0, 2e-2, 0}, {0, 0, 0}, {0, 0, 0}}, 4390, 6},
        Flow{"shear of all planes",
             3,
             60,
             0.7,
             0.05,
             {{2e-3, 1e-2, -8e-3}, {0, -4e-3, 1.5e-2}, {5e-3, 0, 2e-3}},
             3000,
             6},
        Flow{"pure shear of eight", 3, 8, 0.6, 0.02, {{0, 3e-4, 0}, {3e-4, 0, 0}, {0, 0, 0}}, 4000, 4}),
    [](const auto& test) {
      std::string name;
      for (const char c : std::string(test.param.name))
        if (std::isalnum(static_cast<unsigned char>(c))) name += c;
      return name;
    });

TEST(Neighbours, FewFlyingGrainsDoNotForceRebuilds) {
  // A grain that flies gets room of its own: the list lives long although one grain leaves the skin of a
  // grain at rest in every few steps.
  Material m;
  m.gamma_b = 0;
  State state = test::two_grains(0.5, 0.5, 0);
  state.box = Mat3::diagonal({40, 40, 40});
  state.position = {{1, 1, 1}, {20, 20, 20}};
  state.velocity = {{0.2, 0.1, 0}, {0, 0, 0}};
  Dynamics dynamics(m, state);
  dynamics.start(0.02, {});
  for (int n = 0; n < 2000; ++n) dynamics.step();
  EXPECT_LT(dynamics.neighbours().updates(), 200u);
  EXPECT_LT(dynamics.neighbours().sorts(), 10u);  // it flew 9 mm, 25 times what the outer list allows
}

TEST(Neighbours, TheInnerListIsMadeOfPlacesAndMotionsAlone) {
  const Material m;
  Dynamics dynamics(m, test::squeezed(m, 400, 3, 0.7, 0.1));
  Grains grains = dynamics.grains(), bare;
  Cell cell = dynamics.cell();
  Neighbours neighbours(m.r_mean, grains.largest_radius()), of_bare = neighbours;
  bare.place = grains.place, bare.motion = grains.motion;
  EXPECT_FALSE(of_bare.update_inner(bare, cell, 1));  // there is no outer list yet
  EXPECT_EQ(of_bare.updates(), 0u);
  neighbours.update(grains, cell, 1);
  of_bare = neighbours;
  const std::vector<std::uint32_t> before = neighbours.pairs().within.partner;
  for (std::size_t i = 0; i < grains.count(); ++i) {
    const double shift = 0.01 * m.r_mean * static_cast<double>(i % 7);
    grains.place[i].x += shift, grains.place[i].z -= shift;
  }
  bare.place = grains.place, bare.motion = grains.motion;  // sorted by now
  ASSERT_TRUE(of_bare.update_inner(bare, cell, 0.3));
  neighbours.update(grains, cell, 0.3);
  EXPECT_EQ(neighbours.sorts(), 1u);
  EXPECT_EQ(of_bare.sorts(), 1u);
  EXPECT_EQ(of_bare.updates(), 2u);
  EXPECT_NE(of_bare.pairs().within.partner, before);
  EXPECT_EQ(of_bare.pairs().within.partner, neighbours.pairs().within.partner);
  const auto& [a, b] = std::tie(of_bare.pairs().crossing.pairs, neighbours.pairs().crossing.pairs);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.i == q.i && p.j == q.j && p.image == q.image;
  }));
}

TEST(Neighbours, RefusesABoxThatItsGrainsCannotFitIn) {
  const Material m;
  State state = test::two_grains(1.5, 1.5, 0);
  state.box = Mat3::diagonal({20, 3.01, 20});
  try {
    Dynamics dynamics(m, state);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("3.01 mm wide"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("wider than 3.02"), std::string::npos) << error.what();
  }
}

TEST(Neighbours, RefusesTwoGrainsAtOnePoint) {
  const Material m;
  State state = test::two_grains(1, 1, 0);
  state.position[1] = state.position[0];
  EXPECT_THROW(Dynamics(m, state), Error);
}

}  // namespace
}  // namespace grainlaw::dem
