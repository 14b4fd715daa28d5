// Eqs. 5.7, 5.8 and 5.9 inverted give back the jamming density of the states they made; what says nothing is
// left empty.
#include "grainlaw/model/infer_jamming.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::model {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Table 5.1, isotropic, at one nu_c for contacts and pressure.
PackingLaw table_5_1() {
  PackingLaw law;
  const auto set = [](Parameter& p, double value) { p.value = value; };
  set(law.C0, 6);
  set(law.C1, 8.5);
  set(law.alpha, 0.58);
  set(law.nu_c_contacts, 0.66);
  set(law.phi_c, 0.13);
  set(law.phi_v, 15);
  set(law.p0, 0.042);
  set(law.gamma_p, 0.05);
  set(law.nu_c, 0.66);
  return law;
}

TEST(InferJamming, EachQuantityGivesTheDensityBack) {
  const PackingLaw law = table_5_1();
  for (const double phi_J : {0.6567, 0.6652, 0.67}) {
    const PressureCurve moved = with_jamming_density(law.pressure(), phi_J);
    for (const double nu : {0.671, 0.7, 0.82}) {
      const double C_star = corrected_coordination(moved.contacts, nu),
                   f_NR = 1 - rattlers(moved.contacts, nu);
      // 80 halvings, or one power: rounding, amplified by 1/alpha.
      EXPECT_NEAR(*jamming_density_from_contacts(law.contacts(), nu, C_star), phi_J, 1e-13);
      EXPECT_NEAR(*jamming_density_from_nonrattlers(law.contacts(), nu, f_NR), phi_J, 1e-13);
      EXPECT_NEAR(
          *jamming_density_from_pressure_and_contacts(law.pressure(), nu, pressure(moved, nu), C_star * f_NR),
          phi_J, 1e-13);
    }
  }
}

TEST(InferJamming, UnjammedStatesSayNothing) {
  const PackingLaw law = table_5_1();
  EXPECT_FALSE(jamming_density_from_contacts(law.contacts(), 0.66, 5.9));
  EXPECT_FALSE(jamming_density_from_contacts(law.contacts(), 0.66, nan));
  EXPECT_EQ(*jamming_density_from_contacts(law.contacts(), 0.66, 6), 0.66);
  EXPECT_FALSE(jamming_density_from_nonrattlers(law.contacts(), 0.66, 0.5));
  EXPECT_FALSE(jamming_density_from_nonrattlers(law.contacts(), 0.66, 1));
  EXPECT_FALSE(jamming_density_from_pressure_and_contacts(law.pressure(), 0.66, 0, 5));
  EXPECT_FALSE(jamming_density_from_pressure_and_contacts(law.pressure(), 0.66, 1e-3, nan));
  EXPECT_FALSE(jamming_density_from_pressure_and_contacts(law.pressure(), 0.66, 100, 6));
}

TEST(InferJamming, AlongARecordWithErrors) {
  PackingLaw law = table_5_1();
  law.p0.stderr_ = 0.001;
  const PressureCurve moved = with_jamming_density(law.pressure(), 0.6652);
  Record record({"segment", "nu", "P", "C", "C_star", "f_NR"});
  record.append({0, 0.64, 0, 0, nan, 0});
  record.append({0, 0.7, pressure(moved, 0.7), coordination(moved.contacts, 0.7),
                 corrected_coordination(moved.contacts, 0.7), 1 - rattlers(moved.contacts, 0.7)});
  const Record out = infer_jamming_density(record, law);
  ASSERT_EQ(out.rows(), 2u);
  EXPECT_FALSE(out.has("eps_dev"));
  for (const char* name : {"phi_J", "phi_J_pressure_alone", "phi_J_contacts", "phi_J_nonrattlers"}) {
    EXPECT_TRUE(std::isnan(out[name][0])) << name;
    EXPECT_NEAR(out[name][1], 0.6652, 1e-12) << name;
  }
  // P = p0 C e^e e (1 - g e): d ln p0 = -d ln(e e^e (1 - g e)), and d phi_J = -phi_J de.
  const double e = std::log(0.7 / 0.6652), slope = 1 / e + 1 - 0.05 / (1 - 0.05 * e);
  EXPECT_NEAR(out["phi_J_error"][1], 0.6652 * 0.001 / 0.042 / slope, 2e-5);  // to first order in 1/42
  EXPECT_TRUE(std::isnan(out["phi_J_contacts_error"][1]));  // p0 is no matter of the contacts
}

/// What the law's numbers leave open, and how far packings differ.
TEST(InferJamming, ScatterOfPackingsAddsInQuadrature) {
  PackingLaw law = table_5_1();
  law.p0.stderr_ = 0.001;
  Record record({"nu", "P", "C_star"});
  record.append({0.7, 0.02, 7.5});
  record.append({0.66, 0, nan});
  const Record alone = infer_jamming_density(record, law), both = infer_jamming_density(record, law, 5e-4);
  EXPECT_NEAR(both["phi_J_pressure_alone_error"][0], std::hypot(alone["phi_J_pressure_alone_error"][0], 5e-4),
              1e-15);
  EXPECT_NEAR(both["phi_J_contacts_error"][0], 5e-4, 1e-15);
  EXPECT_TRUE(std::isnan(both["phi_J_contacts_error"][1]));     // not jammed
  EXPECT_TRUE(std::isnan(both["phi_J_nonrattlers_error"][0]));  // not measured
}

/// Grains that touch in passing press, too: with fewer contacts than balance needs there is nothing to infer.
TEST(InferJamming, PressureOfTooFewContactsSaysNothing) {
  Record record({"nu", "P", "C", "C_star", "f_NR"});
  record.append({0.66, 1e-3, 5, 5.9, 0.85});
  record.append({0.66, 1e-3, 5.2, 6.1, 0.85});
  const Record out = infer_jamming_density(record, table_5_1());
  for (const char* name : {"phi_J", "phi_J_pressure_alone"}) {
    EXPECT_TRUE(std::isnan(out[name][0])) << name;
    EXPECT_GT(out[name][1], 0.6) << name;
  }
}

TEST(InferJamming, PressureAloneIsEnough) {
  Record record({"nu", "P"});
  record.append({0.7, 0.02});
  record.append({0.663, 1e-9});  // grains in passing: nothing tells them from phi_J = nu
  const Record out = infer_jamming_density(record, table_5_1());
  EXPECT_TRUE(std::isnan(out["phi_J_pressure_alone"][1]));
  EXPECT_TRUE(std::isnan(out["phi_J"][0]));
  EXPECT_NEAR(out["phi_J_pressure_alone"][0],
              *jamming_density_from_pressure(table_5_1().pressure(), 0.7, 0.02), 0);
}

}  // namespace
}  // namespace grainlaw::model
