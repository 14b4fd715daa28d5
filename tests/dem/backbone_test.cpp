#include "grainlaw/dem/balance/backbone.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "grainlaw/dem/balance/static_packing.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

StaticPacking with_contacts(const State& state) {
  StaticPacking packing(Material{}, state);
  packing.find_contacts();
  return packing;
}

TEST(Backbone, IsAllOfACrystal) {
  const StaticPacking packing = with_contacts(test::crystal(0.97, 0));
  EXPECT_EQ(packing.backbone().grains(), 32u);
  EXPECT_EQ(packing.backbone().contacts(), 192u);
  EXPECT_NEAR(packing.backbone().mean_force(), 1e5 * 2 * (1 - 0.97), 1e-6);
}

TEST(Backbone, IsNothingOfAPair) {
  State state = test::two_grains(1, 1, 0);
  state.position[0][0] += 0.1;
  const StaticPacking packing = with_contacts(state);
  EXPECT_EQ(packing.network().count, 1u);
  EXPECT_EQ(packing.backbone().grains(), 0u);
  EXPECT_EQ(packing.backbone().mean_force(), 0);
}

TEST(Backbone, GrainsAreTakenOutOneAfterTheOther) {
  // The same by taking out one grain at a time, the last one first, until nothing changes.
  const StaticPacking packing = with_contacts(test::squeezed(Material{}, 200, 5, 0.66));
  const ContactNetwork& network = packing.network();
  std::vector<bool> in(packing.count(), true);
  const auto contacts_of = [&](std::size_t g) {
    std::uint32_t n = 0;
    for (std::size_t c = 0; c < network.count; ++c) {
      const auto [i, j] = network.pairs[c];
      n += (i == g || j == g) && in[i] && in[j] ? 1 : 0;
    }
    return n;
  };
  std::size_t fewer_at_first = 0;
  for (std::size_t g = 0; g < in.size(); ++g) fewer_at_first += contacts_of(g) < 4 ? 1 : 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t g = in.size(); g-- > 0;)
      if (in[g] && contacts_of(g) < 4) {
        in[g] = false;
        changed = true;
      }
  }
  std::size_t left = 0;
  for (std::size_t g = 0; g < in.size(); ++g) {
    EXPECT_EQ(packing.backbone().holds(g), in[g]) << g;
    left += in[g] ? 1 : 0;
  }
  EXPECT_EQ(packing.backbone().grains(), left);
  EXPECT_GT(left, 20u);                               // something stays,
  EXPECT_LT(left + fewer_at_first, packing.count());  // and some go only because others went
}

}  // namespace
}  // namespace grainlaw::dem
