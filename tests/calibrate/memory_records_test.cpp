// What records of over-compression and of shear say: branches that obey Eqs. 5.4, 5.7 and 5.8 give their
// jamming density back by all three, and rows that are jammed or not the strain from which they stay so.
#include <gtest/gtest.h>

#include <cmath>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/memory_branches.hpp"
#include "grainlaw/calibrate/memory_shear.hpp"
#include "grainlaw/calibrate/memory_tables.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::calibrate {
namespace {

const KnownValues laws{{"C0", 6},         {"C1", 8.272},     {"alpha", 0.5814},
                       {"phi_c", 0.1216}, {"phi_v", 15.895}, {"p0", 0.042}};
const model::ContactCurve contacts{6, 8.272, 0.5814, 0.6646, 0.1216, 15.895};
const model::PressureCurve pressure{contacts, 0.042, 0, 0.6646};

Path path_of(const std::string& segments) {
  return Path::read(Reader(Json::parse("{\"segments\": " + segments + "}"), "test"));
}

/// Record of a path of iso legs along which the packing's phi_J is, leg by leg, as given.
TestRecord record_of(const std::string& segments, const std::vector<double>& phi_J, int rows) {
  TestRecord test;
  test.name = "oc-s1";
  test.seed = "1";
  test.mode = "iso";
  test.role = Role::memory;
  test.nu_start = 0.64;
  test.path = path_of(segments);
  test.legs = test.path.legs(0.64);
  test.rows = Record({"segment", "eps_vol", "eps_dev", "nu", "P", "C", "C_star", "f_NR"});
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg) {
    const model::PressureCurve law = model::with_jamming_density(pressure, phi_J[leg]);
    for (int i = 1; i <= rows; ++i) {
      const Leg& l = test.legs[leg];
      const double eps_vol = l.eps_vol[0] + (l.eps_vol[1] - l.eps_vol[0]) * i / rows,
                   nu = 0.64 * std::exp(eps_vol);
      test.rows.append({static_cast<double>(leg), eps_vol, 0, nu, model::pressure(law, nu),
                        model::coordination(law.contacts, nu),
                        model::corrected_coordination(law.contacts, nu),
                        1 - model::rattlers(law.contacts, nu)});
    }
  }
  return test;
}

const std::string two_cycles = R"([{"repeat": 2, "segments": [
    {"mode": "iso", "controls": {"nu": 0.82}}, {"mode": "iso", "controls": {"nu": 0.64}}]}])";

TEST(MemoryBranches, EachUnloadingGivesItsJammingDensityThreeTimes) {
  const TestRecord test = record_of(two_cycles, {0.660, 0.6652, 0.6652, 0.6660}, 200);
  const auto cycles = cycle_densities(test, laws, {});
  ASSERT_EQ(cycles.size(), 2u);
  const double truth[] = {0.6652, 0.6660};
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(cycles[i].M, static_cast<double>(i + 1));
    EXPECT_NEAR(cycles[i].phi_max, 0.82, 1e-12);
    EXPECT_EQ(cycles[i].leg, 2 * i + 1);
    // The data obey the laws to rounding; the minimiser stops at 1e-12 of nu/0.02.
    EXPECT_NEAR(cycles[i].from_P.value, truth[i], 1e-9);
    EXPECT_NEAR(cycles[i].from_C_star.value, truth[i], 1e-9);
    EXPECT_NEAR(cycles[i].from_f_NR.value, truth[i], 1e-9);
    EXPECT_NEAR(cycles[i].p0, 0.042, 1e-9);
    EXPECT_GT(cycles[i].from_P.error, 0);  // of gamma_p, which is held at 0 +- 0.1
    EXPECT_LT(cycles[i].from_P.error, 1e-4);
  }
}

TEST(MemoryBranches, AShortBranchTakesItsSlopeFromWhatIsKnown) {
  const TestRecord test =
      record_of(R"([{"mode": "iso", "controls": {"nu": 0.668}}, {"mode": "iso", "controls": {"nu": 0.64}}])",
                {0.6646, 0.6646}, 200);
  KnownValues other = laws;
  other.insert_or_assign("p0", KnownValue(0.044, 0.002));
  const auto cycles = cycle_densities(test, other, {});
  ASSERT_EQ(cycles.size(), 1u);
  EXPECT_EQ(cycles[0].p0, 0.044);
  // p0 that is 5 % off turns e into 0.955 e: by about 5 % of the mean e of the rows, which the error covers.
  EXPECT_LT(std::abs(cycles[0].from_P.value - 0.6646), 3 * cycles[0].from_P.error);
  EXPECT_GT(std::abs(cycles[0].from_P.value - 0.6646), 1e-5);
}

TEST(MemoryBranches, UnjammedCyclesAndSmallerOnesHaveNone) {
  const std::string segments =
      R"([{"mode": "iso", "controls": {"nu": 0.66}}, {"mode": "iso", "controls": {"nu": 0.64}},
      {"mode": "iso", "controls": {"nu": 0.70}}, {"mode": "iso", "controls": {"nu": 0.64}},
      {"mode": "iso", "controls": {"nu": 0.68}}, {"mode": "iso", "controls": {"nu": 0.64}}])";
  const auto cycles =
      cycle_densities(record_of(segments, {0.6646, 0.6646, 0.6646, 0.6646, 0.6646, 0.6646}, 100), laws, {});
  ASSERT_EQ(cycles.size(), 2u);  // not the one to 0.68, which is no new largest volume fraction
  EXPECT_FALSE(cycles[0].from_P.known());
  EXPECT_EQ(cycles[0].rows, 0u);
  EXPECT_NEAR(cycles[1].phi_max, 0.70, 1e-12);
  EXPECT_EQ(cycles[1].M, 1);
}

std::vector<double> strains(std::size_t n) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(0.002 * static_cast<double>(i));
  return out;
}

std::vector<bool> jammed_from(std::size_t n, std::size_t first) {
  std::vector<bool> out(n);
  for (std::size_t i = first; i < n; ++i) out[i] = true;
  return out;
}

TEST(JammingStrain, FirstRowOfARunThatStays) {
  EXPECT_DOUBLE_EQ(jamming_strain(strains(140), jammed_from(140, 70)), 0.14);
  EXPECT_EQ(jamming_strain(strains(140), jammed_from(140, 0)), 0);
  EXPECT_TRUE(std::isnan(jamming_strain(strains(140), jammed_from(140, 140))));
}

TEST(JammingStrain, SingleRowsDoNotCount) {
  std::vector<bool> rows = jammed_from(140, 70);
  rows[20] = true;    // a contact in passing
  rows[100] = false;  // an avalanche
  EXPECT_DOUBLE_EQ(jamming_strain(strains(140), rows), 0.14);
  for (std::size_t i = 30; i < 36; ++i) rows[i] = true;  // jams for 0.012 of strain only
  EXPECT_DOUBLE_EQ(jamming_strain(strains(140), rows), 0.14);
}

TEST(JammingStrain, TooLateToTell) {
  EXPECT_TRUE(std::isnan(jamming_strain(strains(140), jammed_from(140, 135))));
  EXPECT_DOUBLE_EQ(jamming_strain(strains(140), jammed_from(140, 129)), 0.258);
}

TEST(JammingStrain, AfterAReversalItCountsFromTheLoss) {
  std::vector<bool> rows = jammed_from(140, 60);
  for (std::size_t i = 0; i < 8; ++i) rows[i] = true;  // still jammed where the leg begins
  EXPECT_DOUBLE_EQ(jamming_strain(strains(140), rows), 0.12);
}

TEST(ShearJammings, LegsThatShearWithTheirSigns) {
  TestRecord test;
  test.name = "sj-0.66-s1";
  test.seed = "1";
  test.mode = "d2";
  test.role = Role::memory;
  test.nu_start = 0.66;
  test.path = path_of(
      R"([{"mode": "relax"}, {"mode": "d2", "controls": {"eps_dev": 0.28}}, {"mode": "d2", "controls": {"eps_dev": 0}}])");
  test.legs = test.path.legs(0.66);
  test.rows = Record({"segment", "eps_vol", "eps_dev", "nu", "P", "C", "C_star", "f_NR", "percolating"});
  test.rows.append({0, 0, 0, 0.66, 0, 0, std::nan(""), 0, 0});
  for (int leg = 1; leg <= 2; ++leg)
    for (int i = 1; i <= 140; ++i) {
      const double strain = 0.002 * i, eps_dev = leg == 1 ? strain : 0.28 - strain;
      const bool contact = strain > 0.1 || leg == 2, chains = strain > 0.12 && leg == 1,
                 pushes = strain > 0.08;
      test.rows.append({static_cast<double>(leg), 0, eps_dev, 0.66, pushes ? 1e-3 : 1e-5, 4,
                        contact ? 6.1 : 5.5, 0.8, chains ? 3.0 : 2.0});
    }
  CycleDensity from;
  from.phi_max = 0.82;
  from.M = 1;
  from.from_P = {0.6652, 1e-5};
  const auto runs = shear_jammings(test, from, {});
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_NEAR(runs[0].by(JamSign::contacts), 0.102, 1e-12);
  EXPECT_NEAR(runs[0].by(JamSign::percolation), 0.122, 1e-12);
  EXPECT_NEAR(runs[0].by(JamSign::pressure), 0.082, 1e-12);
  EXPECT_FALSE(runs[0].jammed_before);
  EXPECT_EQ(runs[1].reversals, 1u);
  EXPECT_TRUE(runs[1].jammed_before);
  EXPECT_EQ(runs[1].by(JamSign::contacts), 0);     // stays jammed
  EXPECT_EQ(runs[1].by(JamSign::percolation), 0);  // never loose by contacts
  EXPECT_NEAR(runs[1].by(JamSign::pressure), 0.082, 1e-12);
  EXPECT_NEAR(runs[0].percolating, 80.0 / 90, 1e-12);  // rows beyond 0.12 of those from 0.102 on
  EXPECT_EQ(runs[1].percolating, 0);
  EXPECT_NEAR(runs[1].longest, 0.28, 1e-12);
}

TEST(MemoryTables, ComeBackAsTheyWere) {
  const Scratch scratch;
  auto cycles = cycle_densities(record_of(two_cycles, {0.660, 0.6652, 0.6652, 0.6660}, 200), laws, {});
  cycles.push_back(cycles.back());
  cycles.back().from_P = {};
  const auto file = scratch.dir() / "over_compression.csv";
  over_compression_table(cycles).write_csv(file);
  const auto back = read_over_compression(file);
  ASSERT_EQ(back.size(), 3u);
  EXPECT_NEAR(back[1].from_P.value, cycles[1].from_P.value, 5.1e-8);  // as it is rounded
  EXPECT_EQ(back[1].group, "1");
  EXPECT_EQ(back[1].test, back[0].test);
  EXPECT_FALSE(back[2].from_P.known());
  ShearJamming run;
  run.group = "7";
  run.strain = {0.1, std::nan(""), 0.09};
  run.nu = 0.66;
  run.phi_max = 0.82;
  run.reversals = 1;
  run.jammed_before = true;
  const auto sheared = scratch.dir() / "shear_jamming.csv";
  shear_jamming_table({run}).write_csv(sheared);
  const auto runs = read_shear_jamming(sheared);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].by(JamSign::contacts), 0.1);
  EXPECT_TRUE(std::isnan(runs[0].by(JamSign::percolation)));
  EXPECT_TRUE(runs[0].jammed_before);
  EXPECT_EQ(runs[0].group, "7");
}

}  // namespace
}  // namespace grainlaw::calibrate
