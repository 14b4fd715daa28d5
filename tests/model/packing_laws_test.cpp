// Packing laws against Table 2.1 and the numbers the thesis quotes from it.
#include "grainlaw/model/laws/packing_laws.hpp"

#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

struct Row {
  const char* mode;
  PressureCurve law;
};

// Table 2.1: C0, C1, alpha, nu_c(C*), phi_c, phi_v; p0, gamma_p, nu_c(p).
const Row iso{"iso", {{6, 8.2720, 0.5814, 0.6646, 0.1216, 15.8950}, 0.04172, 0.06228, 0.6649}};
const Row uni{"uni", {{6, 8.370, 0.5998, 0.6625, 0.1507, 15.6835}, 0.04006, 0.03270, 0.6619}};
const Row d2{"d2", {{6, 7.9219, 0.5769, 0.6601, 0.1363, 15.0010}, 0.03886, 0.03219, 0.6581}};

TEST(PackingLaws, PressureAtTheVolumeFractionOfFigure4_14) {
  EXPECT_NEAR(pressure(iso.law, 0.711), 0.0222, 5e-5);
  EXPECT_NEAR(pressure(d2.law, 0.711), 0.0242, 5e-5);
  const PressureCurve table_4_1{{6, 7.9219, 0.5769, 0.658, 0.1363, 15.0010}, 0.0425, 0.2, 0.658};
  EXPECT_NEAR(pressure(table_4_1, 0.711), 0.0264, 5e-5);
}

TEST(PackingLaws, CoordinationOfTheDensestUniaxialState) {
  EXPECT_NEAR(corrected_coordination(uni.law.contacts, 0.82), 9.5, 0.1);  // Fig. 2.3
}

TEST(PackingLaws, PressureIsTheProductOfItsFactors) {
  const double nu = 0.75, e = std::log(nu / 0.6649);
  const double x = nu / 0.6646 - 1;
  const double C = (6 + 8.272 * std::pow(x, 0.5814)) * (1 - 0.1216 * std::exp(-15.895 * x));
  EXPECT_NEAR(coordination(iso.law.contacts, nu), C, 1e-14);
  EXPECT_NEAR(pressure(iso.law, nu), 0.04172 * nu * C / 0.6649 * e * (1 - 0.06228 * e), 1e-16);
  EXPECT_NEAR(isotropic_fabric(iso.law.contacts, 1.22475, nu), 1.22475 * nu * C, 1e-14);
}

TEST(PackingLaws, BelowJammingThereIsNothing) {
  for (const Row& row : {iso, uni, d2}) {
    const ContactCurve& c = row.law.contacts;
    const double below = c.nu_c - 1e-9;
    EXPECT_TRUE(std::isnan(corrected_coordination(c, below))) << row.mode;
    EXPECT_EQ(rattlers(c, below), 1) << row.mode;
    EXPECT_EQ(coordination(c, below), 0) << row.mode;
    EXPECT_EQ(isotropic_fabric(c, 1.2, below), 0) << row.mode;
    EXPECT_EQ(pressure(row.law, jamming_density(row.law)), 0) << row.mode;
    EXPECT_EQ(pressure(row.law, 0.5), 0) << row.mode;
  }
}

TEST(PackingLaws, AtJammingContactsAreIsostaticAndSlopesInfinite) {
  const ContactCurve& c = iso.law.contacts;
  EXPECT_EQ(corrected_coordination(c, c.nu_c), 6);
  EXPECT_NEAR(coordination(c, c.nu_c), 6 * (1 - 0.1216), 1e-14);
  EXPECT_TRUE(std::isinf(corrected_coordination_slope(c, c.nu_c)));
  // The product that the bulk modulus needs is finite all the way down.
  EXPECT_EQ(strain_times_fabric_slope(c, c.nu_c, 0), 0);
  double last = 1;
  for (const double x : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const double value = strain_times_fabric_slope(c, c.nu_c * (1 + x), std::log1p(x));
    EXPECT_GT(value, 0);
    EXPECT_LT(value, 0.2 * last);
    last = value;
  }
}

TEST(PackingLaws, PressureRisesFromZeroWhereItsContactsBeginLater) {
  // D2: the pressure law begins at 0.6581, its contacts only at 0.6601; between, C is that of 0.6601.
  EXPECT_EQ(jamming_density(d2.law), 0.6581);
  EXPECT_EQ(pressure(d2.law, 0.6581), 0);
  for (const double nu : {0.6581 * (1 + 1e-9), 0.6582, 0.6595, 0.6601}) {
    const double e = std::log(nu / 0.6581), C = 6 * (1 - 0.1363);
    const double expected = 0.03886 * nu * C / 0.6581 * e * (1 - 0.03219 * e);
    EXPECT_NEAR(pressure(d2.law, nu), expected, 1e-14 * expected + 1e-18) << nu;
  }
  EXPECT_NEAR(pressure(d2.law, 0.6601 * (1 + 1e-12)), pressure(d2.law, 0.6601), 1e-8);
  expect_v_shape([](double e) { return pressure(d2.law, std::exp(e)); }, std::log(0.6590),
                 pressure_slope(d2.law, 0.6590), 0.01);
}

TEST(PackingLaws, Slopes) {
  for (const Row& row : {iso, uni, d2})
    for (const double nu : {0.68, 0.711, 0.8}) {
      const ContactCurve& c = row.law.contacts;
      const double room = nu - 0.665;  // a step must not leave the jammed side
      expect_v_shape([&](double x) { return corrected_coordination(c, x); }, nu,
                     corrected_coordination_slope(c, nu), room);
      expect_v_shape([&](double x) { return rattlers(c, x); }, nu, rattlers_slope(c, nu), room);
      expect_v_shape([&](double x) { return coordination(c, x); }, nu, coordination_slope(c, nu), room);
      expect_v_shape([&](double e) { return pressure(row.law, std::exp(e)); }, std::log(nu),
                     pressure_slope(row.law, nu), room);
      expect_v_shape([&](double e) { return 0.3 * std::log(isotropic_fabric(c, 1.2, std::exp(e))); },
                     std::log(nu), strain_times_fabric_slope(c, nu, 0.3), room);
    }
}

TEST(PackingLaws, AnotherHistoryShiftsEveryJammingDensity) {
  const PressureCurve law = with_jamming_density(iso.law, 0.66);
  EXPECT_EQ(jamming_density(law), 0.66);
  const double x = 0.662 / (0.6646 * 0.66 / 0.6649) - 1, e = std::log(0.662 / 0.66);
  const double C = (6 + 8.272 * std::pow(x, 0.5814)) * (1 - 0.1216 * std::exp(-15.895 * x));
  EXPECT_NEAR(pressure(law, 0.662), 0.04172 * 0.662 * C / 0.66 * e * (1 - 0.06228 * e), 1e-16);
  // Its own history changes nothing.
  EXPECT_EQ(pressure(with_jamming_density(iso.law, 0.6649), 0.711), pressure(iso.law, 0.711));
}

}  // namespace
}  // namespace grainlaw::model
