// The vector kernels on every instruction set that this machine has, against the same sums done one by one.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/dem/step/advance.hpp"
#include "grainlaw/dem/step/forces.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

/// Every target that the kernels may run on here, forced in its turn.
class EachTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { force(GetParam()); }
  void TearDown() override { force(0); }
  static void force(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
};

std::vector<std::int64_t> targets_here() {
  std::vector<std::int64_t> list{HWY_SCALAR};
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3})
    if ((hwy::SupportedTargets() & target) != 0) list.push_back(target);
  return list;
}

/// A jammed heap of grains in a box that deforms, with a list of pairs; 61 grains: no multiple of four.
struct Heap {
  Material material;
  Grains grains;
  Cell cell;
  Neighbours neighbours;

  explicit Heap(const Mat3& gradient) : Heap(test::squeezed(Material{}, 61, 4, 0.8, 0.3), gradient) {}
  Heap(const State& state, const Mat3& gradient)
      : grains(state, material.rho), cell(state.box, gradient), neighbours(1, grains.largest_radius()) {
    neighbours.update(grains, cell, 1);
  }
};

const Mat3 along_axes = Mat3::diagonal({1e-3, -2e-3, 5e-4});
const Mat3 any_gradient{{1e-3, 2e-3, -3e-3}, {5e-4, -2e-3, 1.5e-3}, {-1e-3, 2.5e-3, 5e-4}};

void expect_forces_of_equation_2_1(const Mat3& gradient, double gamma) {
  Heap heap(gradient);
  const LinearContact law{heap.material.k, gamma};
  contact_forces(law, heap.neighbours.pairs(), heap.cell, heap.grains);
  std::vector<Vec3> expected(heap.grains.count(), Vec3{});
  int contacts = 0;
  const auto add_images = [&](std::uint32_t i, std::uint32_t j) {
    const Quad &a = heap.grains.place[i], &b = heap.grains.place[j];
    for (const Quad& shift : heap.cell.shifts()) {
      const Vec3 l{a.x - b.x - shift.x, a.y - b.y - shift.y, a.z - b.z - shift.z};
      const double distance = norm(l), overlap = a.w + b.w - distance;
      if (overlap < 0) continue;
      ++contacts;
      const Quad &va = heap.grains.motion[i], &vb = heap.grains.motion[j];
      const Vec3 flow = heap.cell.affine_velocity(l);
      const double closing =
          -dot(l, {va.x - vb.x + flow[0], va.y - vb.y + flow[1], va.z - vb.z + flow[2]}) / distance;
      const double f = law.k * overlap + gamma * closing;
      for (std::size_t c = 0; c < 3; ++c) {
        expected[i][c] += f * l[c] / distance;
        expected[j][c] -= f * l[c] / distance;
      }
    }
  };
  for (std::uint32_t i = 0; i < heap.grains.count(); ++i)
    for (std::uint32_t j = i + 1; j < heap.grains.count(); ++j) add_images(i, j);
  EXPECT_GT(contacts, 150);
  for (std::size_t i = 0; i < heap.grains.count(); ++i) {
    const Quad& f = heap.grains.force[i];
    EXPECT_NEAR(f.x, expected[i][0], 1e-9);  // forces are of order 1e4
    EXPECT_NEAR(f.y, expected[i][1], 1e-9);
    EXPECT_NEAR(f.z, expected[i][2], 1e-9);
  }
}

TEST_P(EachTarget, ContactForcesAreEquation2_1) {
  for (const double gamma : {1000.0, 0.0}) {
    expect_forces_of_equation_2_1(along_axes, gamma);
    expect_forces_of_equation_2_1(any_gradient, gamma);
  }
}

// The loop for more grains than caches hold: copies of a box, twelve along each axis, feel what the box
// feels.
TEST_P(EachTarget, ManyGrainsAreNoDifferent) {
  Heap one(along_axes);
  State state = test::squeezed(Material{}, 61, 4, 0.8, 0.3), many = state;
  const Vec3 edge = state.box.diagonal();
  constexpr int times = 12;
  many.box = times * state.box;
  many.position.clear(), many.velocity.clear(), many.radius.clear();
  for (int copy = 0; copy < times * times * times; ++copy)
    for (std::size_t i = 0; i < state.count(); ++i) {
      const Vec3& x = state.position[i];
      many.position.push_back({x[0] + edge[0] * (copy % times), x[1] + edge[1] * (copy / times % times),
                               x[2] + edge[2] * (copy / times / times)});
      many.velocity.push_back(state.velocity[i]);
      many.radius.push_back(state.radius[i]);
    }
  Heap all(many, along_axes);
  const LinearContact law = LinearContact::of(one.material);
  contact_forces(law, one.neighbours.pairs(), one.cell, one.grains);
  contact_forces(law, all.neighbours.pairs(), all.cell, all.grains);
  ASSERT_GT(all.grains.count(), 100'000u);
  std::vector<Vec3> expected(state.count());
  for (std::size_t i = 0; i < state.count(); ++i) {
    const Quad& f = one.grains.force[i];
    expected[one.grains.id[i]] = {f.x, f.y, f.z};
  }
  double worst = 0;
  for (std::size_t i = 0; i < all.grains.count(); ++i) {
    const Quad& f = all.grains.force[i];
    const Vec3& e = expected[all.grains.id[i] % state.count()];
    worst = std::max({worst, std::abs(f.x - e[0]), std::abs(f.y - e[1]), std::abs(f.z - e[2])});
  }
  EXPECT_LT(worst, 1e-7);  // of 1e4: places up to 70 mm are rounded to 1e-14 mm, and k is 1e5
}

void expect_one_step_of_verlet(const Mat3& gradient, const Mat3& deformation) {
  Heap heap(gradient);
  contact_forces(LinearContact::of(heap.material), heap.neighbours.pairs(), heap.cell, heap.grains);
  const Grains before = heap.grains;
  const double dt = 1e-3, gamma_b = 100;
  const Cell next = heap.cell.moved(deformation * heap.cell.edges(), {});
  const Mat3 root = square_root(deformation);
  const ListReach list = heap.neighbours.reach(next);
  const double excess = advance({dt, deformation, gradient, gamma_b, heap.cell.tilted()}, list, heap.grains);
  double expected_excess = -1;
  for (std::size_t i = 0; i < before.count(); ++i) {
    const auto three = [](const Quad& q) { return Vec3{q.x, q.y, q.z}; };
    const Vec3 a =
        three(acceleration(before.force[i], before.motion[i], before.acceleration[i], gamma_b, gradient));
    const Vec3 last = three(before.acceleration[i]), v = three(before.half[i]), x = three(before.place[i]);
    const Vec3 is_x = three(heap.grains.place[i]), is_v = three(heap.grains.half[i]);
    const Vec3 is_seen = three(heap.grains.motion[i]), is_a = three(heap.grains.acceleration[i]);
    EXPECT_EQ(norm(three(heap.grains.force[i])), 0);
    double strayed = 0;
    const Vec3 carried = deformation * x, flown = root * is_v;
    const Vec3 left = list.deformation * three(list.reference[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(is_a[c], a[c], 1e-12 * (1 + std::abs(a[c])));
      EXPECT_NEAR(is_v[c], v[c] + dt * a[c], 1e-13);
      EXPECT_NEAR(is_x[c], carried[c] + dt * flown[c], 1e-13);
      EXPECT_NEAR(is_seen[c], is_v[c] + dt * (a[c] - 0.5 * last[c]), 1e-13);
      strayed += std::pow(is_x[c] - left[c], 2);
    }
    expected_excess = std::max(expected_excess, strayed - list.reference[i].w);
    EXPECT_EQ(heap.grains.place[i].w, before.place[i].w);                // radius
    EXPECT_EQ(heap.grains.acceleration[i].w, before.acceleration[i].w);  // 1/mass
    EXPECT_EQ(heap.grains.half[i].w, 0);
    EXPECT_EQ(heap.grains.motion[i].w, 0);
  }
  EXPECT_NEAR(excess, expected_excess, 1e-13);
}

// Vectors hold two grains, and an odd last one is alone.
TEST(MotionKernel, TellsAPlaceThatIsNoNumberWhicheverGrainsItIs) {
  for (const std::size_t last : {60u, 61u})
    for (std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{30}, last - 2, last - 1}) {
      Heap heap(along_axes);
      const ListReach list = heap.neighbours.reach(heap.cell);
      heap.grains.half[i].y = std::numeric_limits<double>::quiet_NaN();
      const Stride stride{1e-3, Mat3::diagonal({1, 1, 1}), along_axes, 100, false};
      EXPECT_TRUE(std::isnan(advance(stride, list, 0, last, heap.grains))) << i << " of " << last;
    }
}

TEST_P(EachTarget, AdvanceIsOneStepOfVerlet) {
  expect_one_step_of_verlet(along_axes, Mat3::diagonal({1.01, 0.99, 1}));
  expect_one_step_of_verlet(any_gradient, {{1.01, 0.02, -0.01}, {0.005, 0.99, 0.015}, {0, -0.02, 1}});
}

INSTANTIATE_TEST_SUITE_P(Targets, EachTarget, testing::ValuesIn(targets_here()),
                         [](const auto& instance) { return std::string(hwy::TargetName(instance.param)); });

}  // namespace
}  // namespace grainlaw::dem
