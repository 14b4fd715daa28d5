// A crystal is told from a random packing.
#include "grainlaw/dem/packing/crystal_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Material equal_grains() {
  Material m;
  m.w = 1;
  return m;
}

TEST(CrystalOrder, OneInACrystalAlsoWhenItShakes) {
  State crystal = test::crystal(0.97, 0);
  EXPECT_EQ(crystalline_share(crystal), 1);
  Random random(3);
  for (auto& x : crystal.position)
    for (double& component : x) component += 0.05 * random.normal();
  EXPECT_EQ(crystalline_share(crystal), 1);
}

TEST(CrystalOrder, NearZeroInARandomPacking) {
  EXPECT_LT(crystalline_share(test::squeezed(equal_grains(), 300, 8, 0.64)), 0.05);
}

TEST(CrystalOrder, HalfAndHalf) {
  // A gas beside a crystal, in one box twice as long.
  State state = test::crystal(0.97, 0);
  const State gas = test::squeezed(equal_grains(), 30, 5, 0.5);
  const double edge = state.box(0, 0);
  for (const auto& x : gas.position) {
    state.position.push_back({edge + 1 + x[0] * (edge - 2) / gas.box(0, 0), x[1] * edge / gas.box(1, 1),
                              x[2] * edge / gas.box(2, 2)});
    state.velocity.push_back({});
    state.radius.push_back(1);
  }
  state.box(0, 0) *= 2;
  const double share = crystalline_share(state);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.6);
}

TEST(CrystalOrder, WarnsOfNearlyEqualGrainsOnly) {
  EXPECT_TRUE(may_crystallise(equal_grains()));
  EXPECT_FALSE(may_crystallise(Material{}));
  EXPECT_THAT(crystal_warning(equal_grains(), test::crystal(0.97, 0)),
              testing::AllOf(testing::HasSubstr("w = 1 is below 1.2"),
                             testing::HasSubstr("100 % of them stand in crystalline order")));
}

}  // namespace
}  // namespace grainlaw::dem
