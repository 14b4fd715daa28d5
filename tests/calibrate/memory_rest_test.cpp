// Packings at rest along their shear, and after it: the states that are read, and the densities they say.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_account.hpp"
#include "grainlaw/calibrate/memory_tables.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::calibrate {
namespace {

const KnownValues laws{{"C0", 6},         {"C1", 8.272},     {"alpha", 0.5814},
                       {"phi_c", 0.1216}, {"phi_v", 15.895}, {"p0", 0.042}};
const model::PressureCurve law{{6, 8.272, 0.5814, 0.6567, 0.1216, 15.895}, 0.042, 0, 0.6567};

TestRecord record_of(const std::string& segments, const std::string& mode, double nu_start) {
  TestRecord test;
  test.name = mode + "-s3";
  test.seed = "3";
  test.mode = mode;
  test.role = Role::memory;
  test.nu_start = nu_start;
  test.path = Path::read(Reader(Json::parse("{\"segments\": " + segments + "}"), "test"));
  test.legs = test.path.legs(nu_start);
  test.rows =
      Record({"segment", "eps_vol", "eps_dev", "nu", "P", "s_dev", "C", "C_star", "f_NR", "percolating"});
  return test;
}

CycleDensity over_compressed() {
  CycleDensity from;
  from.phi_max = 0.82;
  from.M = 1;
  from.from_P = {0.6652, 1e-4};
  return from;
}

const std::string stopped_twice = R"([{"mode": "relax"},
    {"mode": "d2", "controls": {"eps_dev": 0.1}}, {"mode": "relax"},
    {"mode": "d2", "controls": {"eps_dev": 0.2}}, {"mode": "relax"}])";

TEST(RelaxedStates, AreTheEndsOfTheRestsThatFollowShear) {
  TestRecord test = record_of(stopped_twice, "d2", 0.66);
  EXPECT_TRUE(rests_along_shear(test));
  test.rows.append({0, 0, 0, 0.66, 0, std::nan(""), 0, std::nan(""), 0, 0});
  for (int leg = 1; leg <= 4; ++leg) {
    const bool flows = leg % 2 == 1;
    for (int i = 1; i <= (flows ? 3 : 1); ++i) {
      const double strain = 0.1 * ((leg - 1) / 2) + (flows ? 0.1 * i / 3 : 0.1);
      test.rows.append(
          {static_cast<double>(leg), 0, strain, 0.66, flows ? 2e-3 : 1e-3 * leg, 0.2, 5, 6.1, 0.8, 3});
    }
  }
  const auto states = relaxed_states(test, over_compressed());
  ASSERT_EQ(states.size(), 2u);
  EXPECT_NEAR(states[0].eps_dev, 0.1, 1e-12);
  EXPECT_NEAR(states[1].eps_dev, 0.2, 1e-12);
  EXPECT_EQ(states[0].P, 2e-3);  // of leg 2
  EXPECT_EQ(states[1].P, 4e-3);
  EXPECT_EQ(states[1].P_flow, 2e-3);
  EXPECT_EQ(states[1].percolating, 3);
  EXPECT_EQ(states[1].phi_J0.value, 0.6652);
  EXPECT_FALSE(rests_along_shear(
      record_of(R"([{"mode": "relax"}, {"mode": "d2", "controls": {"eps_dev": 0.1}}])", "d2", 0.66)));
}

std::vector<RelaxedState> steady_states() {
  std::vector<RelaxedState> states;
  for (const double nu : {0.66, 0.665, 0.67, 0.68}) {
    RelaxedState s;
    s.test = "at-" + to_text(nu);
    s.group = "3";
    s.nu = nu;
    s.eps_dev = 0.25;
    s.P = model::pressure(law, nu);
    s.s_dev = 0.2;
    s.C = model::coordination(law.contacts, nu);
    states.push_back(s);
  }
  return states;
}

TEST(RelaxedLimit, IsWhereTheLawOfTheStatesVanishes) {
  auto states = steady_states();
  states.push_back(states.front());
  states.back().eps_dev = 0.1;  // not steady: its stresses say nothing
  states.back().P *= 0.3;
  for (const double P : {4e-4, 0.0}) {  // at the edge: one of two pushes, by chance
    states.push_back(states.front());
    states.back().nu = 0.6575;
    states.back().P = P;
  }
  const RelaxedLimit limit = relaxed_limit(states, {});
  EXPECT_EQ(limit.states, 4u);
  EXPECT_NEAR(limit.by_pressure.value, 0.6567, 1e-8);
  EXPECT_NEAR(limit.by_shear_stress.value, 0.6567, 1e-8);
  EXPECT_GT(limit.by_pressure.error, 0);
}

TEST(RelaxedLimit, IsUnknownWithoutStatesThatPush) {
  auto states = steady_states();
  for (RelaxedState& s : states) s.P = 0;
  EXPECT_FALSE(relaxed_limit(states, {}).by_pressure.known());
  EXPECT_FALSE(relaxed_limit({}, {}).by_shear_stress.known());
}

TEST(Tapped, AmplitudeAndStrainAreThoseUpToTheStart) {
  const TestRecord sheared = record_of(R"([{"repeat": 4, "segments": [{"mode": "d2", "amount": 0.005},
      {"mode": "d2", "amount": -0.01}, {"mode": "d2", "amount": 0.005}]}])",
                                       "d2", 0.68);
  TestRecord test = record_of(R"([{"mode": "iso", "controls": {"nu": 0.64}}])", "iso", 0.68);
  for (int i = 1; i <= 100; ++i) {
    const double eps_vol = test.legs[0].eps_vol[1] * i / 100, nu = 0.68 * std::exp(eps_vol);
    const auto C = nu > 0.6567 ? model::coordination(law.contacts, nu) : 0;
    test.rows.append({0, eps_vol, 0, nu, model::pressure(law, nu), std::nan(""), C,
                      nu > 0.6567 ? model::corrected_coordination(law.contacts, nu) : std::nan(""),
                      1 - model::rattlers(law.contacts, nu), 0});
  }
  EXPECT_TRUE(tapped_density(test, sheared, laws, {}).empty());  // nothing says where it starts
  test.from = RecordOrigin{"d2-s3", 5};                          // after two of the four
  const auto tapped = tapped_density(test, sheared, laws, {});
  ASSERT_EQ(tapped.size(), 1u);
  EXPECT_NEAR(tapped[0].amplitude, 0.005, 1e-12);
  EXPECT_NEAR(tapped[0].strain, 0.04, 1e-12);
  EXPECT_NEAR(tapped[0].density.from_P.value, 0.6567, 1e-8);
  EXPECT_NEAR(tapped[0].density.phi_max, 0.68, 1e-12);
}

TEST(Tapped, RemembersTheLargestVolumeFraction) {
  const TestRecord test = record_of(R"([{"mode": "iso", "controls": {"nu": 0.7}},
      {"mode": "iso", "controls": {"nu": 0.64}}, {"mode": "iso", "controls": {"nu": 0.8}}])",
                                    "iso", 0.65);
  EXPECT_NEAR(largest_nu(test, 0), 0.7, 1e-12);
  EXPECT_NEAR(largest_nu(test, 1), 0.7, 1e-12);
  EXPECT_NEAR(largest_nu(test, 2), 0.8, 1e-12);
}

/// Rows of a leg at the law, over nu for iso, at a constant P for d2 and for a rest.
void add_rows(TestRecord& test, std::size_t leg, int rows) {
  for (int i = 1; i <= rows; ++i) {
    const auto between = [&](const double* range) { return range[0] + (range[1] - range[0]) * i / rows; };
    const double eps_vol = between(test.legs[leg].eps_vol), nu = test.nu_start * std::exp(eps_vol);
    const bool jams = nu > 0.6567;
    test.rows.append({static_cast<double>(leg), eps_vol, between(test.legs[leg].eps_dev), nu,
                      model::pressure(law, nu), jams ? 0.2 : std::nan(""),
                      jams ? model::coordination(law.contacts, nu) : 0,
                      jams ? model::corrected_coordination(law.contacts, nu) : std::nan(""),
                      jams ? 1 - model::rattlers(law.contacts, nu) : 0, 3});
  }
}

TestRecord whole_record(const std::string& name, const std::string& segments, const std::string& mode,
                        double nu_start, const std::optional<RecordOrigin>& from) {
  TestRecord test = record_of(segments, mode, nu_start);
  test.name = test.test = name;
  test.from = from;
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg)
    add_rows(test, leg, test.legs[leg].mode == Mode::relax ? 1 : 100);
  return test;
}

/// Which record of role memory is read as what.
TEST(MemoryAccount, TellsCyclesShearRestsAndTapsApart) {
  RecordFolder folder;
  folder.tests = {
      whole_record(
          "oc", R"([{"mode": "iso", "controls": {"nu": 0.82}}, {"mode": "iso", "controls": {"nu": 0.64}}])",
          "iso", 0.64, std::nullopt),
      whole_record("shear", R"([{"mode": "d2", "controls": {"eps_dev": 0.2}}])", "d2", 0.66,
                   RecordOrigin{"oc", 1}),
      whole_record("rests", stopped_twice, "d2", 0.66, RecordOrigin{"oc", 1}),
      whole_record("taps", R"([{"mode": "d2", "amount": 0.01}, {"mode": "d2", "amount": -0.01}])", "d2", 0.68,
                   RecordOrigin{"oc", 1}),
      whole_record("back", R"([{"mode": "iso", "controls": {"nu": 0.64}}])", "iso", 0.68,
                   RecordOrigin{"taps", 1}),
      whole_record("astray", R"([{"mode": "iso", "controls": {"nu": 0.64}}])", "iso", 0.68,
                   RecordOrigin{"gone", 0})};
  for (TestRecord* sheared : {&folder.tests[4], &folder.tests[5]}) sheared->sheared_along = StrainTensor{};
  const Account account = fit_all(
      folder, Reference(model::ParameterSet::load(thesis_file()), folder.tests[0].material), {}, {}, {});
  ASSERT_EQ(account.cycles.size(), 1u);
  EXPECT_EQ(account.cycles[0].test, "oc");
  ASSERT_EQ(account.shear_jammings.size(), 1u);
  EXPECT_EQ(account.shear_jammings[0].test, "shear");
  ASSERT_EQ(account.relaxed.size(), 2u);
  EXPECT_EQ(account.relaxed[1].test, "rests");
  EXPECT_NEAR(account.relaxed[1].phi_max, 0.82, 1e-12);
  ASSERT_EQ(account.tapped.size(), 1u);
  EXPECT_EQ(account.tapped[0].density.test, "back");
  EXPECT_NEAR(account.tapped[0].phi_max, 0.82, 1e-12);
  EXPECT_NEAR(account.tapped[0].amplitude, 0.005, 1e-12);
  ASSERT_EQ(account.left_out.size(), 1u);
  EXPECT_EQ(account.left_out[0].name, "astray");
  const Json json = account.to_json()["memory"];
  EXPECT_EQ(json["relaxed"]["nu"].size(), 2u);
  EXPECT_EQ(json["tapped"]["phi_J"].size(), 1u);
}

TEST(MemoryTables, RestsAndTapsComeBackAsTheyWere) {
  const Scratch scratch;
  auto states = steady_states();
  states[0].C_star = std::nan("");
  relaxed_table(states).write_csv(scratch.dir() / "relaxed.csv");
  const auto back = read_relaxed(scratch.dir() / "relaxed.csv");
  ASSERT_EQ(back.size(), states.size());
  EXPECT_NEAR(back[1].P, states[1].P, 5.1e-8);
  EXPECT_TRUE(std::isnan(back[0].C_star));
  EXPECT_EQ(back[0].group, "3");
  TappedDensity one;
  one.density = over_compressed();
  one.density.group = "3";
  one.phi_max = 0.9;
  one.amplitude = 0.005;
  one.strain = 0.02;
  tapped_table({one}).write_csv(scratch.dir() / "tapped.csv");
  const auto tapped = read_tapped(scratch.dir() / "tapped.csv");
  ASSERT_EQ(tapped.size(), 1u);
  EXPECT_EQ(tapped[0].strain, 0.02);
  EXPECT_EQ(tapped[0].phi_max, 0.9);
  EXPECT_EQ(tapped[0].density.from_P.value, 0.6652);
}

}  // namespace
}  // namespace grainlaw::calibrate
