// A trajectory does not depend on how grains are numbered, where the origin lies, or how axes are named.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "packings.hpp"

namespace grainlaw::dem {
namespace {

class TrajectoryInvariance : public testing::Test {
 protected:
  Material m;
  State start = test::squeezed(m, 120, 31, 0.72);
  Vec3 flow{1e-3, -2e-3, 5e-4};
  State end = followed(start, flow);

  /// 200 steps of a flow in which contacts open and close.
  State followed(const State& from, const Vec3& rate) const {
    Dynamics dynamics(m, from);
    const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.1);
    dynamics.start(dt, rate);
    for (int n = 1; n <= 200; ++n) {
      Vec3 length;
      for (std::size_t c = 0; c < 3; ++c) length[c] = from.box(c, c) * std::exp(rate[c] * dt * n);
      dynamics.step(length, rate);
    }
    return dynamics.state();
  }

  /// Grain i of `other` is where grain `grain(i)` of `end` is, once moved back by `back`, which may also
  /// change its axes. Rounding differs; the flow lets it grow over so few steps to no more than this.
  template <class Grain, class Back>
  void expect_same(const State& other, Grain&& grain, Back&& back) const {
    for (std::size_t i = 0; i < other.count(); ++i) {
      const Vec3 x = back(other.position[i]), &should = end.position[grain(i)];
      const Vec3 d = Cell(end.box).nearest_image({x[0] - should[0], x[1] - should[1], x[2] - should[2]});
      EXPECT_LT(norm(d), 1e-9) << i;
    }
  }
};

TEST_F(TrajectoryInvariance, ContactsOpenAndClose) {
  EXPECT_NE(test::brute_force(start).size(), test::brute_force(end).size());
}

TEST_F(TrajectoryInvariance, Permutation) {
  const std::vector<std::size_t> order = test::shuffled(start.count(), 2);
  const State other = test::permuted(start, order);
  expect_same(
      followed(other, flow), [&](std::size_t i) { return order[i]; }, [](const Vec3& x) { return x; });
}

TEST_F(TrajectoryInvariance, TranslationAndImages) {
  const Vec3 by{1.234, -0.77, 3.1};
  State other = start;
  for (std::size_t i = 0; i < other.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      other.position[i][c] += by[c] + start.box(c, c) * (static_cast<double>(i % 3) - 1);
  // The box deforms about the origin, and carries the shift along.
  const Vec3 stretch = Cell(end.box).deformation_from(start.box).diagonal();
  expect_same(
      followed(other, flow), [](std::size_t i) { return i; },
      [&](const Vec3& x) {
        return Vec3{x[0] - by[0] * stretch[0], x[1] - by[1] * stretch[1], x[2] - by[2] * stretch[2]};
      });
}

TEST_F(TrajectoryInvariance, AxisSwap) {
  const auto swapped = [](const Vec3& x) { return Vec3{x[1], x[2], x[0]}; };
  State other = start;
  for (auto& x : other.position) x = swapped(x);
  for (auto& v : other.velocity) v = swapped(v);
  other.box = Mat3::diagonal(swapped(start.box.diagonal()));
  expect_same(
      followed(other, swapped(flow)), [](std::size_t i) { return i; },
      [](const Vec3& x) {
        return Vec3{x[2], x[0], x[1]};
      });
}

}  // namespace
}  // namespace grainlaw::dem
