// Moduli against the numbers that follow from Table 4.1, and B against the derivative of the law it comes
// from.
#include "grainlaw/model/laws/moduli.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/model/forms/law.hpp"
#include "walks.hpp"
#include "written.hpp"

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

/// Eq. 4.16 with one F_v in Eqs. 4.11 and 4.14.
struct OneFabric : Written {
  static constexpr double F_v = 6.2;
  void operator()(const Vector& y, Vector& dy, double t) const {
    const double n = nu(t), B = bulk(n) * F_v / fabric(n);
    const double S = (1 - q() * y[1] / y[0] / s_max(n)) / S_I;
    Written::operator()(y, dy, t);
    dy[0] = B * v + 0.66 * B * y[2] * S * e;
    dy[1] = B * y[2] * v + B * (0.51 * (1 - std::exp(-(F_v - 4.2) / 1.9)) - 86 * y[1] * y[2]) * S * e;
  }
};

ParameterSet with_one_fabric(double F_v) {
  ParameterSet set = thesis();
  set.moduli->F_v.emplace().value = F_v;
  return set;
}

TEST(ConstantFabric, AgainstAnIndependentIntegration) {
  const Prediction p =
      walk(R"({"start": {"nu": 0.69, "P": 0.012, "sigma_dev": -0.001, "F_dev": 0.03}, "segments": [
               {"mode": "uni", "amount": 0.12}, {"mode": "uni", "amount": -0.08}]})",
           choice_of("coupled+constant_F_v"), 20, with_one_fabric(OneFabric::F_v));
  expect_agreement<OneFabric>(0.69, {0.012, -0.001, 0.03}, {{0.12, 0.12}, {-0.08, -0.08}}, p, 20);
}

/// The thesis holds F_v constant in undrained shear, where F_v(nu) is.
TEST(ConstantFabric, ChangesNothingInUndrainedShear) {
  const double F_v = isotropic_fabric(laws_of(thesis(), Form::coupled).contacts, 1.22, 0.711);
  const char* path = R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.2},
                         {"mode": "d2", "amount": -0.1}]})";
  for (const Form form : {Form::coupled, Form::coupled_3_14}) {
    const Choice choice{form, {.constant_F_v = true}};
    const Prediction off = walk(path, form), on = walk(path, choice, 20, with_one_fabric(F_v)),
                     other = walk(path, choice, 20, with_one_fabric(0.9 * F_v));
    for (const char* column : {"P", "sigma_dev", "F_dev"}) {
      EXPECT_LT(difference(off, on, column), 1e-12) << name_of(choice) << " " << column;
      EXPECT_EQ(difference(off, walk(path, form, 20, with_one_fabric(1.0)), column), 0)
          << "off unless asked for";
    }
    EXPECT_GT(difference(off, other, "sigma_dev"), 1e-5);
  }
}

TEST(ConstantFabric, NeedsItsNumber) {
  EXPECT_THAT(refusal([] { make_law(thesis(), choice_of("coupled+constant_F_v")); }),
              testing::HasSubstr("moduli.F_v: is missing; the coupled+constant_F_v form needs it"));
  EXPECT_THAT(refusal([] { choice_of("memory+constant_F_v"); }),
              testing::HasSubstr("memory takes the terms"));
  const ParameterSet set = with_one_fabric(6.5);
  EXPECT_EQ(ParameterSet::read(Reader(set.to_json(), "p.json")).moduli->F_v->value, 6.5);
}

}  // namespace
}  // namespace grainlaw::model
