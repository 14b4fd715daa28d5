// Percolation of the strong contacts: chains through upright and tilted boxes, and random networks by brute
// force.
#include "grainlaw/dem/observe/percolation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "grainlaw/dem/numbers/random.hpp"
#include "observed.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

using observe::Observers;
using test::contacts_of;
using test::elastic;
using test::Met;
using test::see;

/// A state of unit grains: `strong` in a row from `begin` by `step`, overlapping by 0.1, and far away thirty
/// pairs that hardly touch, so that the forces in the row are more than 2.2 times the mean.
State row_of_grains(std::size_t strong, const Vec3& begin, const Vec3& step, const Mat3& box) {
  State state;
  state.box = box;
  const auto put = [&](const Vec3& x) {
    state.position.push_back(x);
    state.velocity.push_back({});
    state.radius.push_back(1);
  };
  for (std::size_t k = 0; k < strong; ++k) {
    const auto n = static_cast<double>(k);
    put({begin[0] + n * step[0], begin[1] + n * step[1], begin[2] + n * step[2]});
  }
  for (int a = 0; a < 5; ++a)
    for (int b = 0; b < 6; ++b) {
      put({2 + 3 * a + 0.0, 3 * b + 2.0, 20});
      put({2 + 3 * a + 0.0, 3 * b + 2.0, 21.999});
    }
  return state;
}

State row_of_grains(std::size_t strong, const Vec3& begin, const Vec3& step, const Vec3& box) {
  return row_of_grains(strong, begin, step, Mat3::diagonal(box));
}

using Directions = std::array<int, 3>;

void expect_spans(const std::map<std::string, double>& seen, const Vec3& xi, const Directions& percolates) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    EXPECT_NEAR(seen.at("xi_" + axis), xi[c], 1e-12) << axis;
    EXPECT_EQ(seen.at("percolates_" + axis), percolates[c]) << axis;
  }
  EXPECT_EQ(seen.at("percolating"), percolates[0] + percolates[1] + percolates[2]);
}

void expect_spans(const State& state, const Vec3& xi, const Directions& percolates) {
  expect_spans(see(elastic(), state), xi, percolates);
}

TEST(Percolation, AStraightChainThroughTheBox) {
  expect_spans(row_of_grains(10, {5, 5, 5}, {1.9, 0, 0}, {19, 19, 30}), {1, 0, 0}, {1, 0, 0});
  // one grain is missing: nine in a row, through the face of the box
  expect_spans(row_of_grains(9, {12, 5, 5}, {1.9, 0, 0}, {19, 19, 30}), {8 * 1.9 / 19, 0, 0}, {0, 0, 0});
}

TEST(Percolation, AlongEachAxis) {
  expect_spans(row_of_grains(10, {5, 5, 5}, {0, 1.9, 0}, {19, 19, 30}), {0, 1, 0}, {0, 1, 0});
  expect_spans(row_of_grains(15, {17.5, 9.5, 1}, {0, 0, -1.9}, {19, 19, 28.5}), {0, 0, 1}, {0, 0, 1});
}

TEST(Percolation, ADiagonalChainRunsAlongTwoAxes) {
  const double step = 1.9 / std::sqrt(2.0);
  expect_spans(row_of_grains(14, {1, 3, 5}, {step, step, 0}, {14 * step, 14 * step, 30}), {1, 1, 0},
               {1, 1, 0});
}

TEST(Percolation, AChainLongerThanTheBoxThatMissesItselfDoesNotPercolate) {
  // After a turn around x it has moved 3 along y.
  const Vec3 step{1.8735, 0.3, 0.1};  // of length 1.9 or so
  expect_spans(row_of_grains(14, {1, 3, 5}, step, {19, 19, 30}), {1, 13 * 0.3 / 19, 13 * 0.1 / 30},
               {0, 0, 0});
}

/// A box of 19 x 19 x 30 after simple shear: x flows, y is the gradient.
Mat3 sheared_box(double gamma) { return {{19, 19 * gamma, 0}, {0, 19, 0}, {0, 0, 30}}; }

/// A row as long as so many edges of this box, without the last `missing` of the grains that close it.
State row_along(const Vec3& edges, const Mat3& box, std::size_t missing = 0) {
  const Vec3 way = box * edges;
  const double grains = std::ceil(norm(way) / 1.92);
  const Vec3 step{way[0] / grains, way[1] / grains, way[2] / grains};
  return row_of_grains(static_cast<std::size_t>(grains) - missing, {9.5, 9.5, 5}, step, box);
}

// The cell counts images in edges that it chooses anew, in simple shear at gamma = 0.5, 1.5 ...
TEST(Percolation, ARowThatShearsWithTheBoxPercolatesAsBefore) {
  for (int n = -24; n <= 24; ++n) {
    const double gamma = n / 20.0;
    SCOPED_TRACE(gamma);
    const Mat3 box = sheared_box(gamma);
    expect_spans(row_along({1, 0, 0}, box), {1, 0, 0}, {1, 0, 0});
    expect_spans(row_along({0, 1, 0}, box), {0, 1, 0}, {0, 1, 0});
    expect_spans(row_along({0, 0, 1}, box), {0, 0, 1}, {0, 0, 1});
    expect_spans(row_along({1, 1, 0}, box), {1, 1, 0}, {1, 1, 0});
    const State open = row_along({0, 1, 0}, box, 1);
    const double grains = static_cast<double>(open.count()) - 60;
    expect_spans(open, {0, (grains - 1) / (grains + 1), 0}, {0, 0, 0});
  }
  EXPECT_EQ(Cell(sheared_box(0.45)).basis(), Mat3::identity());
  EXPECT_NE(Cell(sheared_box(0.55)).basis(), Mat3::identity());
}

TEST(Percolation, StraightUpInABoxThatLeansIsAlongBothEdges) {
  // Straight up is once along the second edge and once back along the first.
  expect_spans(row_of_grains(10, {9.5, 9.5, 5}, {0, 1.9, 0}, sheared_box(1)), {1, 1, 0}, {1, 1, 0});
  expect_spans(row_of_grains(10, {9.5, 9.5, 5}, {0, 1.9, 0}, sheared_box(0)), {0, 1, 0}, {0, 1, 0});
}

/// Which edges H the largest cluster of strong contacts, without viscosity, percolates along: grains are
/// given images until no contact wants another, and what contradicts them are the ways around.
Directions directions_by_brute_force(const State& state) {
  std::vector<Met> strong = contacts_of(state);
  double mean = 0;
  for (const Met& c : strong) mean += c.overlap / static_cast<double>(strong.size());
  std::erase_if(strong, [&](const Met& c) { return c.overlap < 2.2 * mean; });
  std::size_t largest = 0;
  Directions result{};
  std::vector<bool> seen(state.count(), false);
  for (std::size_t first = 0; first < state.count(); ++first) {
    if (seen[first]) continue;
    std::map<std::size_t, std::array<int, 3>> place{{first, {}}};
    Directions around{};
    for (std::size_t before = 0; before != place.size();) {
      before = place.size();
      for (const Met& c : strong) {
        std::array<int, 3> there;
        const bool i = place.contains(c.i), j = place.contains(c.j);
        for (std::size_t k = 0; k < 3; ++k) {
          if (i) there[k] = place[c.i][k] + c.image[k];
          if (!i && j) there[k] = place[c.j][k] - c.image[k];
          if (i && j) around[k] |= there[k] != place[c.j][k] ? 1 : 0;
        }
        if (i != j) place[i ? c.j : c.i] = there;
      }
    }
    for (const auto& [grain, image] : place) seen[grain] = true;
    if (place.size() > largest) result = around;
    largest = std::max(largest, place.size());
  }
  return result;
}

/// 125 places, 1.9 apart along x, y and z, in a box of which the second edge leans by `lean` of them: some
/// hold a unit grain, so that neighbours overlap by 0.1, the others three tiny grains that hardly touch.
State random_places(int lean, Random& random) {
  const double apart = 1.9;
  State state;
  state.box = apart * Mat3{{5, 1.0 * lean, 0}, {0, 5, 0}, {0, 0, 5}};
  for (int n = 0; n < 125; ++n) {
    const bool large = random.uniform() < 0.35;
    for (int k = 0; k < (large ? 1 : 3); ++k) {
      const double along = n % 5 + n / 5 % 5 * lean / 5.0;  // of the first edge; may be beside a place
      const double up = apart * (n / 25) + 0.0999 * k;
      state.position.push_back({apart * std::floor(along), apart * (n / 5 % 5), up});
      state.velocity.push_back({});
      state.radius.push_back(large ? 1 : 0.05);
    }
  }
  return state;
}

TEST(Percolation, OfRandomNetworksByBruteForce) {
  std::map<Directions, int> met;
  Random random(5);
  for (int n = 0; n < 32; ++n) {
    SCOPED_TRACE(n);
    const State state = random_places(n % 8, random);  // gamma from 0 to 1.4
    const auto seen = see(elastic(), state);
    const Directions here{static_cast<int>(seen.at("percolates_x")),
                          static_cast<int>(seen.at("percolates_y")),
                          static_cast<int>(seen.at("percolates_z"))};
    EXPECT_EQ(here, directions_by_brute_force(state));
    ++met[here];
  }
  EXPECT_GE(met.size(), 5u);  // of the eight answers
}

// Lists are renewed, and the edges in which images are counted chosen anew, between rows of one path.
TEST(Percolation, ARenewalOfListsChangesNothing) {
  const Mat3 before = sheared_box(0.499), after = sheared_box(0.501);
  const double dt = 0.02;
  const Mat3 gradient{{0, 0.002 / dt, 0}, {0, 0, 0}, {0, 0, 0}};
  for (const State& state : {row_along({0, 1, 0}, before), row_along({1, 1, 0}, before)}) {
    Dynamics old(elastic(), state);
    old.start_flow(dt, gradient);
    old.step(after, gradient);
    const Dynamics renewed(elastic(), old.state());
    ASSERT_EQ(old.cell().basis(), Mat3::identity());
    ASSERT_NE(renewed.cell().basis(), Mat3::identity());
    Observers percolation({"percolation"});
    const auto was = see(percolation, elastic(), old), is = see(percolation, elastic(), renewed);
    for (const auto& [column, value] : was) EXPECT_NEAR(is.at(column), value, 1e-12) << column;
    EXPECT_GT(was.at("percolating"), 0);
  }
}

TEST(Percolation, OfAnEarlierRecordIsKnownByItsCountAlone) {
  EXPECT_THAT(observe::lasting_columns({"percolation", "overlap"}),
              testing::ElementsAre("overlap", "xi_x", "xi_y", "xi_z", "percolating"));
  EXPECT_EQ(observe::lasting_columns({"contacts", "radius"}), observe::columns({"contacts", "radius"}));
}

}  // namespace
}  // namespace grainlaw::dem
