// Moduli that obey Eqs. 4.11 to 4.15 give their parameters back; what must not count is left out and named.
#include "grainlaw/calibrate/fit_moduli.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_noise.hpp"
#include "grainlaw/calibrate/moduli_selection.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/model/laws/moduli.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;

constexpr double g3 = 1.22475;
/// Table 2.1, D2, and Table 4.1.
constexpr model::ContactCurve contacts{6, 7.9219, 0.5769, 0.6601, 0.1363, 15.001};
constexpr model::Moduli table{0.0425, 0.2, 0.658, g3, 0.66, 1.0, 86, 0.51, 4.2, 1.9};
constexpr double strains[] = {0, 0.002, 0.004, 0.008, 0.02, 0.04, 0.07, 0.12, 0.2, 0.3, 0.4};

/// States of a test at nu whose moduli are the model's, which shares no code with the fits. Stress and fabric
/// saturate as in Eqs. 2.17 and 2.18.
ModuliSeries along_shear(double nu, const std::string& seed) {
  ModuliSeries series{"d2-" + seed, seed, {}};
  for (const double eps_dev : strains) {
    ModuliState s;
    s.eps_dev = eps_dev;
    s.nu = nu;
    // As in Fig. 4.13, the states of the first strains count as isotropic: so that they are, shear begins
    // there.
    const double sheared = std::max(0.0, eps_dev - initial_strain);
    s.F_dev = 0.11 * (1 - std::exp(-40 * sheared));
    s.P = 0.03;
    s.sigma_dev = 0.15 * s.P * (1 - std::exp(-50 * sheared));
    s.F_v = model::isotropic_fabric(contacts, g3, nu);
    s.B = model::bulk_modulus(table, contacts, nu);
    s.A1 = model::anisotropy_modulus_1(table, s.B, s.F_dev);
    s.A2 = model::anisotropy_modulus_2(table, s.B, s.F_dev);
    s.G = model::shear_modulus(table, s.B, model::initial_shear_ratio(table, s.F_v), s.sigma_dev, s.F_dev);
    series.states.push_back(s);
  }
  return series;
}

std::vector<ModuliSeries> campaign() {
  std::vector<ModuliSeries> all;
  for (const char* seed : {"1", "2", "3"})
    for (const double nu : {0.67, 0.68, 0.70, 0.72, 0.75, 0.78, 0.81}) all.push_back(along_shear(nu, seed));
  return all;
}

ModuliFit fitted(const std::vector<ModuliSeries>& series, const KnownValues& known = {}) {
  return fit_moduli(series, contacts, g3, {0.658, 0}, known);
}

void expect_value(const FitResult& fit, const std::string& name, double truth) {
  EXPECT_NEAR(fit.value(name), truth, 1e-6 * std::abs(truth)) << name;
  EXPECT_TRUE(fit[name].determined) << name << ": " << fit[name].reason;
}

TEST(ModuliFits, BulkModulus) {
  const ModuliFit fit = fitted(campaign());
  expect_value(fit.B, "p0", table.p0);
  expect_value(fit.B, "gamma_p", table.gamma_p);
  EXPECT_TRUE(fit.B["nu_c"].held);
}

TEST(ModuliFits, FirstAnisotropyModulus) { expect_value(fitted(campaign()).A1, "a_I", table.a_I); }

TEST(ModuliFits, SecondAnisotropyModulus) { expect_value(fitted(campaign()).A2, "a_II", table.a_II); }

/// States whose A1 and A2 are those of one energy, with A/B0 = a_F F_dev/F_v + a_s s_dev.
TEST(ModuliFits, AnisotropyModulusOfTheEnergy) {
  constexpr double a_F = 3.6, a_s = 0.15;
  std::vector<ModuliSeries> series = campaign();
  for (ModuliSeries& test : series)
    for (ModuliState& s : test.states) {
      const double A = (s.B - 2 * s.P / 3) * (a_F * s.F_dev / s.F_v + a_s * s.sigma_dev / s.P);
      s.A1 = A - 2 * s.sigma_dev / 9;
      s.A2 = 3 * A / 2 + 2 * s.sigma_dev / 3;
    }
  const FitResult fit = fitted(series).A;
  expect_value(fit, "a_F", a_F);
  expect_value(fit, "a_s", a_s);
}

TEST(ModuliFits, InitialShearRatio) {
  const ModuliFit fit = fitted(campaign());
  EXPECT_EQ(fit.GB_ini.n, 21u);  // one point per test
  expect_value(fit.GB_ini, "GB_max", table.GB_max);
  expect_value(fit.GB_ini, "Fv_min", table.Fv_min);
  expect_value(fit.GB_ini, "Fv_alpha", table.Fv_alpha);
}

TEST(ModuliFits, ShearModulus) { expect_value(fitted(campaign()).G, "g_I", table.g_I); }

/// Each seed has a deviation of its own beside the noise of its states; the truth must lie within the errors
/// as often as Student's t says.
TEST(ModuliFits, ErrorsComeFromTheScatterOverSeeds) {
  Noise noise(5);
  int within = 0;
  constexpr int replicates = 60;
  for (int k = 0; k < replicates; ++k) {
    std::vector<ModuliSeries> series = campaign();
    double of_seed = 0;
    std::string seed;
    for (ModuliSeries& s : series) {
      if (s.group != seed) of_seed = 0.03 * noise.one();
      seed = s.group;
      const std::vector<double> z = noise.series(s.states.size(), 0);
      for (std::size_t i = 0; i < z.size(); ++i) {
        ModuliState& state = s.states[i];
        state.A1 = state.B * (table.a_I * (1 + of_seed) * state.F_dev + 0.004 * z[i]);
      }
    }
    const FitResult fit = fitted(series).A1;
    EXPECT_EQ(fit.stderr_from, "scatter over seeds");
    const auto interval = *fit["a_I"].interval95;
    within += interval.first <= table.a_I && table.a_I <= interval.second ? 1 : 0;
  }
  EXPECT_GE(within, 51);  // 57 expected of 60, less three standard deviations
}

TEST(ModuliFits, WhatTheDataDoNotDetermineIsHeldAtWhatIsKnown) {
  const std::vector<ModuliSeries> one{along_shear(0.75, "1")};
  const ModuliFit fit = fitted(one, {{"gamma_p", 0.2}, {"Fv_alpha", 1.9}, {"Fv_min", 4.2}, {"GB_max", 0.51}});
  EXPECT_TRUE(fit.B["gamma_p"].held);
  EXPECT_THAT(fit.B["gamma_p"].reason, HasSubstr("only 1 different x"));
  expect_value(fit.B, "p0", table.p0);
  EXPECT_TRUE(fit.GB_ini["Fv_alpha"].held);
  EXPECT_FALSE(fit.GB_ini.determined());
}

TEST(ModuliFits, WithoutStatesNothingIsKnown) {
  const ModuliFit fit = fitted({});
  EXPECT_TRUE(std::isnan(fit.A1.value("a_I")));
  EXPECT_EQ(fit.A1["a_I"].reason, "no data");
}

/// A table with the columns that selections read: amplitude, contacts_changed, unstable, B and the rest.
Record rows(const std::vector<std::vector<double>>& some) {
  Record out(moduli_columns());
  for (const auto& row : some) {
    std::vector<double> whole(moduli_columns().size(), std::nan(""));
    out.append(whole);
    const std::size_t k = out.rows() - 1;
    const char* names[] = {"segment",  "eps_dev",  "amplitude", "B",       "contacts_changed",
                           "unstable", "backbone", "contacts",  "residual"};
    for (std::size_t i = 0; i < row.size(); ++i) out[names[i]][k] = row[i];
    for (const char* same : {"A1", "A2", "G_oct", "nu", "P", "sigma_dev", "F_v", "F_dev"})
      out[same][k] = row[3];
  }
  return out;
}

TEST(ModuliSelection, TakesLinearResponseAndNamesWhatItLeavesOut) {
  const double none = std::nan("");
  const Record made = rows({{0, 0, 0, 0.5, 0, 0, 900, 3000, 1e-11},
                            {0, 0, 1e-6, 0.7, 0, none, 900, 3000, 1e-11},
                            {0, 0.1, 0, 0.6, 0, 2, 900, 3000, 1e-11},
                            {0, 0.2, 0, none, 0, none, 0, 0, 0},
                            {0, 0.3, 0, none, 0, none, 100, 200, 1e-11},
                            {0, 0.4, 0, none, 0, none, 900, 3000, 1e-3},
                            {0, 0.5, 0, 0.4, 0, 0, 900, 3000, 2e-5},
                            {1, 0.4, 0, 0.4, 0, 0, 900, 3000, 1e-11}});
  ModuliCount count;
  const ModuliSeries series = moduli_states(made, "d2-s1", "1", 0, count);
  ASSERT_EQ(series.states.size(), 1u);
  EXPECT_EQ(series.states[0].B, 0.5);
  EXPECT_EQ(count.unstable, 1u);
  EXPECT_EQ(count.refused, 4u);
  EXPECT_EQ(
      count.text(),
      "1 state in no stable balance; eps_dev = 0.2: unjammed: no grain bears load; eps_dev = 0.3: contacts "
      "below isostatic: 200 between the 100 grains that bear load, a stable balance takes at least 298; "
      "eps_dev = 0.4: not in balance: the largest net force on a grain is 0.001 times the mean contact "
      "force; eps_dev = 0.5: not in balance: the largest net force on a grain is 2e-05 times the mean "
      "contact "
      "force");
}

TEST(ModuliSelection, APackingThatWouldGiveWayIsNoState) {
  Record made = rows({{0, 0, 0, 0.5, 0, 0, 900, 3000, 1e-11}, {0, 0.1, 0, 0.5, 0, 0, 900, 3000, 1e-11}});
  const char* names[] = {"xx", "yy", "zz", "yz", "xz", "xy"};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = a; b < 6; ++b)
      for (std::size_t k = 0; k < 2; ++k)
        made[std::string("E_") + names[a] + "_" + names[b]][k] = a == b ? 1 : 0;
  made["E_xz_xz"][1] = -0.1;
  ModuliCount count;
  const ModuliSeries series = moduli_states(made, "d2-s1", "1", 0, count);
  ASSERT_EQ(series.states.size(), 1u);
  EXPECT_EQ(series.states[0].eps_dev, 0);
  EXPECT_EQ(count.text(), "1 state that would give way to a strain of the box");
}

/// -0 is no modulus to divide by.
TEST(ModuliSelection, WithoutBulkModulusItIsNoState) {
  const Record made =
      rows({{0, 0, 0, -0.0, 0, 0, 900, 3000, 1e-11}, {0, 0.1, 0, 0.5, 0, 0, 900, 3000, 1e-11}});
  ModuliCount count;
  EXPECT_EQ(moduli_states(made, "d2-s1", "1", 0, count).states.size(), 1u);
  EXPECT_EQ(count.soft, 1u);
}

TEST(ModuliSelection, ProbesThatChangedContactsAreNeverAveragedIn) {
  const double none = std::nan("");
  const Record made =
      rows({{0, 0, 1e-4, 0.5, 0, none, 900, 3000, 1e-11}, {0, 0, -1e-4, 0.7, 3, none, 900, 3000, 1e-11}});
  ModuliCount count;
  const ModuliSeries series = moduli_states(made, "d2-s1", "1", 0, count);
  ASSERT_EQ(series.states.size(), 1u);
  EXPECT_EQ(series.states[0].B, 0.5);
  EXPECT_EQ(count.changed, 1u);
  EXPECT_EQ(count.text(), "1 state whose contacts changed under the strain");
}

}  // namespace
}  // namespace grainlaw::calibrate
