// Moduli against the numbers that follow from Table 4.1, and B against the derivative of the law it comes
// from.
#include "grainlaw/model/laws/moduli.hpp"

#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

// Table 4.1, and the D2 row of Table 2.1 at nu_c = 0.658.
const Moduli table{0.0425, 0.2, 0.658, 1.22, 0.66, 1, 86, 0.51, 4.2, 1.9};
const ContactCurve contacts{6, 7.9219, 0.5769, 0.658, 0.1363, 15.0010};

TEST(Moduli, AtTheVolumeFractionOfFigure4_14) {
  const double F_v = isotropic_fabric(contacts, table.g3, 0.711);
  EXPECT_NEAR(F_v, 6.534, 5e-4);
  EXPECT_NEAR(bulk_modulus(table, contacts, 0.711), 0.4279, 5e-5);
  EXPECT_NEAR(initial_shear_ratio(table, F_v), 0.3607, 5e-5);
}

TEST(Moduli, AtJamming) {
  // Text after Eq. 4.11: F_v,min = 1.22 x 0.658 x 6 x 0.87, B_min = 0.22.
  const ContactCurve text{6, 7.9219, 0.5769, 0.658, 0.13, 15.0010};
  EXPECT_NEAR(isotropic_fabric(text, table.g3, 0.658), 4.19, 5e-3);
  EXPECT_NEAR(bulk_modulus(table, text, 0.658), 0.22, 5e-3);
  EXPECT_NEAR(bulk_modulus(table, text, 0.658 * (1 + 1e-12)), bulk_modulus(table, text, 0.658), 1e-6);
  EXPECT_EQ(bulk_modulus(table, text, 0.6579), 0);
}

TEST(Moduli, BulkModulusIsTheSlopeOfThePressureLaw) {
  // Eq. 4.11 is d p/d ln nu of p = p0 F_v/(g3 nu_c) e (1 - gamma_p e), Eq. 2.14.
  const PressureCurve law{contacts, table.p0, table.gamma_p, table.nu_c};
  for (const double nu : {0.67, 0.711, 0.8}) {
    EXPECT_NEAR(bulk_modulus(table, contacts, nu), pressure_slope(law, nu), 1e-14);
    expect_v_shape([&](double e) { return pressure(law, std::exp(e)); }, std::log(nu),
                   bulk_modulus(table, contacts, nu), nu - 0.66);
  }
}

TEST(Moduli, AnisotropyAndShear) {
  const double B = 0.4279, F = 0.1238, sigma = 0.0037;
  EXPECT_DOUBLE_EQ(anisotropy_modulus_1(table, B, F), 0.66 * B * F);
  EXPECT_DOUBLE_EQ(anisotropy_modulus_2(table, B, F), B * F);
  EXPECT_NEAR(shear_modulus(table, B, 0.3607, sigma, F), B * (0.3607 - 86 * sigma * F), 1e-16);
  // Stress against fabric stiffens, as after a reversal.
  EXPECT_GT(shear_modulus(table, B, 0.3607, -sigma, F), shear_modulus(table, B, 0.3607, 0, F));
}

TEST(Moduli, InitialShearRatioGrowsFromNothingToItsCeiling) {
  EXPECT_EQ(initial_shear_ratio(table, 4.2), 0);
  EXPECT_NEAR(initial_shear_ratio(table, 4.2 + 1.9), 0.51 * (1 - std::exp(-1.0)), 1e-15);
  EXPECT_NEAR(initial_shear_ratio(table, 1e3), 0.51, 1e-15);
}

}  // namespace
}  // namespace grainlaw::model
