// Probes of a packing in balance against its linear response.
#include "grainlaw/dem/stiffness/probe.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

constexpr StrainTensor d2{-1, 1, 0}, d3{-0.5, -0.5, 1}, uni{0, 0, 1};

StaticPacking in_balance() {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 3, 0.75));
  MinimiseOptions options;
  options.residual = 1e-12;
  minimise(packing, options);
  return packing;
}

TEST(Probe, SmallStrainsMeasureTheLinearResponse) {
  StaticPacking packing = in_balance();
  const LinearResponse response = linear_response(packing);
  for (const StrainTensor& axis : {d2, d3, uni})
    for (const double amplitude : {1e-7, -1e-7}) {
      const Moduli expected = moduli_of(response.stress, axis);
      const Probe seen = probe(packing, axis, amplitude, {.residual = 1e-13, .undo = true});
      EXPECT_EQ(seen.amplitude, amplitude);
      EXPECT_EQ(seen.changed.both() + seen.contacts_left.both(), 0u);
      EXPECT_NEAR(seen.left.B, 0, 1e-4 * expected.B);
      EXPECT_NEAR(seen.left.G_oct, 0, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.B, expected.B, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.A1, expected.A1, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.A2, expected.A2, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.G_oct, expected.G_oct, 1e-4 * expected.B);
    }
}

TEST(Probe, LargeStrainsChangeContactsAndSoftenShear) {
  StaticPacking packing = in_balance();
  const double elastic = moduli_of(linear_response(packing).stress, d2).G_oct;
  const Probe plastic = probe(packing, d2, 2e-2, {.undo = true});
  EXPECT_GT(plastic.changed.by_shear, 10u);
  EXPECT_LT(plastic.moduli.G_oct, 0.8 * elastic);
  EXPECT_GT(plastic.contacts_left.by_shear, 3u);  // the way back leads elsewhere
  EXPECT_GT(std::abs(plastic.left.G_oct), 1e-3 * elastic);
  EXPECT_EQ(probe(packing, d2, 2e-2).left.G_oct, 0);
}

}  // namespace
}  // namespace grainlaw::dem
