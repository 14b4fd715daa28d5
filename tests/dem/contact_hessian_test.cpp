#include "grainlaw/dem/balance/contact_hessian.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <vector>

#include "grainlaw/dem/balance/block_jacobi.hpp"
#include "grainlaw/dem/balance/static_packing.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Field random_field(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Field field(count);
  for (Quad& q : field) q = {random.normal(), random.normal(), random.normal(), 0};
  return field;
}

/// Every instruction set that the kernel may run on here, forced in its turn.
class ContactHessianOn : public testing::TestWithParam<std::int64_t> {
 protected:
  ContactHessianOn() : packing(Material{}, test::squeezed(Material{}, 61, 4, 0.8)) {
    packing.find_contacts();
    hessian.build(packing.network(), packing.count());
  }
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
  Field product(const Field& u) const {
    Field result(u.size());
    hessian.apply(u, result);
    return result;
  }
  StaticPacking packing;
  ContactHessian hessian;
};

TEST_P(ContactHessianOn, IsTheDerivativeOfTheForces) {
  // H u = -(F(x + h u) - F(x - h u))/2h
  const Field u = random_field(packing.count(), 1);
  const Field expected = product(u);
  const double h = 1e-5;
  Field difference(packing.count());
  for (const double side : {1.0, -1.0}) {
    StaticPacking moved = packing;
    moved.grains().motion = u;
    moved.move(side * h);
    moved.find_contacts();
    ASSERT_EQ(moved.network().count, packing.network().count);
    add(-side / (2 * h), moved.grains().force, difference);
  }
  add(-1, expected, difference);
  EXPECT_LT(dot(difference, difference), 1e-16 * dot(expected, expected));
}

TEST_P(ContactHessianOn, IsSymmetricAndBlindToTranslation) {
  const Field u = random_field(packing.count(), 1), v = random_field(packing.count(), 2);
  const Field hu = product(u), hv = product(v);
  EXPECT_NEAR(dot(v, hu), dot(u, hv), 1e-13 * std::sqrt(dot(hu, hu) * dot(v, v)));
  const Field moved = product(Field(packing.count(), Quad{0.3, -0.2, 0.7, 0}));
  EXPECT_LT(std::sqrt(largest_square(moved)), 1e-9);
}

TEST_P(ContactHessianOn, TakesThePrestressOfRattlersOutWhereAsked) {
  // A pair: without prestress it resists along its normal only.
  State state = test::two_grains(1, 1, 0);
  for (std::size_t c = 0; c < 3; ++c) state.position[0][c] += 0.01;
  StaticPacking pair(Material{}, state);
  pair.find_contacts();
  const double f = pair.network().force[0], d = pair.network().normal[0].w;
  EXPECT_NEAR(f, 1e5 * (2 - d), 1e-6);
  const double s = 1 / std::sqrt(2.0);
  const Field across{Quad{s, -s, 0, 0}, Quad{}};
  Field result(2);
  ContactHessian exact, springs;
  exact.build(pair.network(), 2);
  exact.apply(across, result);
  EXPECT_NEAR(result[0].x, -f / d * s, 1e-9);
  springs.build(pair.network(), 2, &pair.backbone());
  springs.apply(across, result);
  EXPECT_NEAR(result[0].x, 0, 1e-9);
  const double t = 1 / std::sqrt(3.0);
  springs.apply({Quad{t, t, t, 0}, Quad{}}, result);
  EXPECT_NEAR(result[0].x, 1e5 * t, 1e-8);
  EXPECT_NEAR(result[1].x, -1e5 * t, 1e-8);
}

TEST_P(ContactHessianOn, BlockJacobiInvertsTheBlocksOfTheDiagonal) {
  BlockJacobi preconditioner;
  preconditioner.build(hessian, 7);
  const Field r = random_field(packing.count(), 3);
  Field z(r.size());
  preconditioner.apply(r, z);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Sym6& q = hessian.diagonal()[i];
    EXPECT_NEAR((q[0] + 7) * z[i].x + q[5] * z[i].y + q[4] * z[i].z, r[i].x, 1e-10);
    EXPECT_NEAR(q[5] * z[i].x + (q[1] + 7) * z[i].y + q[3] * z[i].z, r[i].y, 1e-10);
    EXPECT_NEAR(q[4] * z[i].x + q[3] * z[i].y + (q[2] + 7) * z[i].z, r[i].z, 1e-10);
  }
}

std::vector<std::int64_t> targets_here() {
  std::vector<std::int64_t> list{HWY_SCALAR};
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3})
    if ((hwy::SupportedTargets() & target) != 0) list.push_back(target);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Targets, ContactHessianOn, testing::ValuesIn(targets_here()),
                         [](const auto& instance) { return std::string(hwy::TargetName(instance.param)); });

}  // namespace
}  // namespace grainlaw::dem
