// Six systems in step: each is solved, on every instruction set, and is the one that its right-hand side asks
// for.
#include "grainlaw/dem/stiffness/six_systems.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/numbers/field.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

class SixSystemsOn : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

std::vector<std::int64_t> targets_here() {
  std::vector<std::int64_t> list{HWY_SCALAR};
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3})
    if ((hwy::SupportedTargets() & target) != 0) list.push_back(target);
  return list;
}

const StaticPacking& jammed() {
  static const StaticPacking once = [] {
    StaticPacking packing(Material{}, test::squeezed(Material{}, 101, 3, 0.75));
    minimise(packing);
    return packing;
  }();
  return once;
}

Field one_of(const SixFields& fields, std::size_t a) {
  Field one(fields.size());
  for (std::size_t g = 0; g < fields.size(); ++g)
    one[g] = {fields[g].q[0][a], fields[g].q[1][a], fields[g].q[2][a], 0};
  return one;
}

/// Field a is made of the random number a of each grain alone, times 10^a: no two alike. The fifth is zero.
SixFields displacements(const StaticPacking& packing) {
  Random random(5);
  SixFields x(packing.count());
  for (std::size_t g = 0; g < x.size(); ++g)
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = std::pow(10, a) * random.normal();
        if (packing.backbone().holds(g) && a != 4) x[g].q[k][a] = value;
      }
  return x;
}

TEST_P(SixSystemsOn, SolvesEachToItsOwnRightHandSide) {
  const StaticPacking& packing = jammed();
  const ContactNetwork network = bearing(packing.network(), packing.backbone());
  ContactHessian hessian;
  hessian.build(network, packing.count());
  SixSystems systems(network, packing.count(), 1e-3 * packing.law().stiffness(0));
  const SixFields b = systems.product(displacements(packing));
  SixFields left = b, x(packing.count());
  SixSystems::Options options;
  options.residual = 1e-12;
  const SixSystems::Result result = systems.solve(left, x, options);
  EXPECT_FALSE(result.gave_up);
  EXPECT_GT(result.products, 4 * result.iterations);
  EXPECT_LT(result.products, 6 * result.iterations);
  for (std::size_t a = 0; a < 6; ++a) {
    EXPECT_FALSE(result.unstable[a]);
    const Field wanted = one_of(b, a);
    Field product(packing.count());
    hessian.apply(one_of(x, a), product);
    add(-1, wanted, product);
    EXPECT_LE(std::sqrt(dot(product, product)), 1e-10 * std::sqrt(dot(wanted, wanted))) << a;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SixSystemsOn, testing::ValuesIn(targets_here()),
                         [](const auto& instance) { return hwy::TargetName(instance.param); });

TEST(SixSystems, SayWhereTheyGiveUp) {
  const StaticPacking& packing = jammed();
  SixSystems systems(bearing(packing.network(), packing.backbone()), packing.count(), 1);
  SixFields b = systems.product(displacements(packing)), x(packing.count());
  SixSystems::Options options;
  options.most_iterations = 3;
  EXPECT_TRUE(systems.solve(b, x, options).gave_up);
}

}  // namespace
}  // namespace grainlaw::dem
