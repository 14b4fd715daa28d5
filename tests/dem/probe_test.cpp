// Probes of a packing in balance against its linear response.
#include "grainlaw/dem/probe.hpp"

#include <gtest/gtest.h>

#include "grainlaw/dem/minimise.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

constexpr StrainTensor d2{-1, 1, 0}, d3{-0.5, -0.5, 1};

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
  for (const StrainTensor& axis : {d2, d3})
    for (const double amplitude : {1e-7, -1e-7}) {
      const Moduli expected = moduli_of(response.stress, axis);
      const Probe seen = probe(packing, axis, amplitude, 1e-13);
      EXPECT_EQ(seen.amplitude, amplitude);
      EXPECT_EQ(seen.contacts_changed, 0u);
      EXPECT_NEAR(seen.moduli.B, expected.B, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.A1, expected.A1, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.A2, expected.A2, 1e-4 * expected.B);
      EXPECT_NEAR(seen.moduli.G_oct, expected.G_oct, 1e-4 * expected.B);
    }
}

TEST(Probe, LargeStrainsChangeContactsAndSoftenShear) {
  StaticPacking packing = in_balance();
  const double elastic = moduli_of(linear_response(packing).stress, d2).G_oct;
  const Probe plastic = probe(packing, d2, 2e-2);
  EXPECT_GT(plastic.contacts_changed, 10u);
  EXPECT_LT(plastic.moduli.G_oct, 0.8 * elastic);
}

}  // namespace
}  // namespace grainlaw::dem
