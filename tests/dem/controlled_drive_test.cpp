// Element tests under stress control and at a steered rate: rows are on target, presets are one thing, and
// what cannot be reached is said.
#include "grainlaw/dem/drive/controlled_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "controlled_fixture.hpp"
#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

using ControlledDrive = test::ControlledRun;

void expect_kept(const Record& record, const char* column, double target, double tolerance) {
  for (std::size_t i = 1; i < record.rows(); ++i)
    EXPECT_NEAR(record[column][i] / target, 1, tolerance) << column << " in row " << i;
}

TEST_F(ControlledDrive, ConstantPressureAtEveryRow) {
  const Record r =
      run(R"({"mode": "constant_p", "amount": 0.04, "rate": 1e-4, "servo": {"tolerance": 2e-3}})");
  ASSERT_EQ(r.rows(), 11u);
  EXPECT_EQ(summary.cut_short, "");
  expect_kept(r, "P", r["P"][0], 2e-3);
  for (std::size_t k = 1; k <= 10; ++k) EXPECT_NEAR(r["eps_dev"][k], 0.004 * static_cast<double>(k), 1e-4);
  EXPECT_GT(r["syy"][10], r["sxx"][10]);
  EXPECT_NE(r["nu"][10], r["nu"][0]);
}

TEST_F(ControlledDrive, SideStressesAtEveryRow) {
  const Record biaxial =
      run(R"({"mode": "biaxial", "stress": 0.03, "controls": {"eps_dev": 0.04}, "rate": 1e-4})");
  expect_kept(biaxial, "sxx", 0.03, 1e-3);
  EXPECT_NEAR(biaxial["eps_dev"][10], 0.04, 1e-4);
  const Record triaxial = run(R"({"mode": "triaxial", "amount": 0.04, "rate": 1e-4})", R"("rows": 10)", "b");
  expect_kept(triaxial, "sxx", triaxial["sxx"][0], 1e-3);
  expect_kept(triaxial, "syy", triaxial["syy"][0], 1e-3);
  // 0.04 of axial strain, and the sides give way
  EXPECT_GT(triaxial["eps_dev"][10], 0.04);
}

TEST_F(ControlledDrive, AxialStressRisesInTriaxialCompression) {
  // Over 24 packings of so few grains it ends at 1.16 times what it was, standard deviation 0.08 to 0.09.
  double ratio = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const Record r = run(R"({"mode": "triaxial", "amount": 0.04, "rate": 1e-4})", R"("rows": 1)",
                         std::to_string(seed), 150, seed);
    ratio += r["szz"][1] / r["szz"][0] / 6;
  }
  EXPECT_NEAR(ratio, 1.16, 4 * 0.09 / std::sqrt(6));
}

TEST_F(ControlledDrive, TriaxialShearsAndDilatesADensePacking) {
  const Record r = run(R"({"mode": "iso", "controls": {"nu": 0.82}, "rate": 1e-3},
                          {"mode": "iso", "controls": {"nu": 0.68}, "rate": 2e-4}, {"mode": "relax"},
                          {"mode": "triaxial", "amount": 0.1, "rate": 2e-4})",
                       R"("rows": 10)", "a", 300);
  ASSERT_EQ(r.rows(), 32u);
  EXPECT_GT(r["s_dev"][31], 0.1);
  EXPECT_LT(r["nu"][31], r["nu"][21]);
}

TEST_F(ControlledDrive, IsotropicStressThenATargetFromThere) {
  const Record r = run(R"({"mode": "isotropic_stress", "P": 0.05, "rate": 1e-4},
                          {"mode": "isotropic_stress", "P": 0.02, "rate": 1e-4},
                          {"mode": "iso", "controls": {"nu": 0.73}, "rate": 1e-4},
                          {"mode": "d2", "controls": {"eps_dev": 0.03}, "rate": 1e-4})",
                       R"("rows": 5, "snapshots": [{"segment": 0}, {"segment": 2, "nu": 0.72}])");
  ASSERT_EQ(r.rows(), 1u + 1 + 1 + 5 + 5);
  for (const char* side : {"sxx", "syy", "szz"}) {
    EXPECT_NEAR(r[side][1] / 0.05, 1, 1e-3);
    EXPECT_NEAR(r[side][2] / 0.02, 1, 1e-3);
  }
  EXPECT_NEAR(r["nu"][7], 0.73, 1e-12);
  EXPECT_NEAR(r["eps_vol"][7], std::log(0.73 / 0.72), 1e-12);
  EXPECT_NEAR(r["eps_dev"][12], 0.03, 1e-12);
  const auto frames = list_frames(dir / "a" / "snapshots.h5");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[0].nu, r["nu"][1], 1e-12);
  EXPECT_NEAR(frames[1].nu, 0.72, 1e-4);
}

TEST_F(ControlledDrive, StrainPresetsAreControl) {
  const double third = 0.06 / 3, d2 = 0.02 / std::sqrt(3.0), d3 = 0.02 / 1.5;
  run(R"({"mode": "iso", "amount": 0.06, "rate": 5e-4}, {"mode": "uni", "amount": -0.02, "rate": 5e-4},
         {"mode": "d2", "amount": 0.02, "rate": 5e-4}, {"mode": "d3", "amount": 0.02, "rate": 5e-4})");
  const auto control = [](double x, double y, double z, const char* profile) {
    return R"({"mode": "control", "x": {"strain": )" + to_text(x) + R"(}, "y": {"strain": )" + to_text(y) +
           R"(}, "z": {"strain": )" + to_text(z) + R"(}, "rate": 5e-4, "profile": ")" + profile + "\"}";
  };
  run(control(third, third, third, "cosine") + "," + control(0, 0, -0.02, "cosine") + "," +
          control(-d2, d2, 0, "constant") + "," + control(-0.5 * d3, -0.5 * d3, d3, "constant"),
      R"("rows": 10)", "b");
  EXPECT_EQ(read_file(dir / "a" / "record.csv"), read_file(dir / "b" / "record.csv"));
}

TEST_F(ControlledDrive, RowsDoNotChangeTheRun) {
  const char* const segment = R"({"mode": "triaxial", "amount": 0.02, "rate": 2e-4, "profile": "steered"})";
  const Record coarse = run(segment, R"("rows": 5)"), again = run(segment, R"("rows": 5)", "b"),
               fine = run(segment, R"("rows": 10)", "c");
  EXPECT_EQ(read_file(dir / "a" / "record.csv"), read_file(dir / "b" / "record.csv"));
  for (std::size_t k = 0; k <= 5; ++k) EXPECT_EQ(coarse["szz"][k], fine["szz"][2 * k]);
}

TEST_F(ControlledDrive, SaysWhatItCannotReachAndKeepsTheRest) {
  // k* is more than grains at nu = 1 bear.
  const Record r = run(R"({"mode": "d2", "amount": 0.01, "rate": 1e-3},
                          {"mode": "isotropic_stress", "P": 1, "rate": 1e-2}, {"mode": "relax"})",
                       R"("rows": 4)");
  EXPECT_EQ(r.rows(), 5u);
  EXPECT_THAT(summary.cut_short, testing::StartsWith("scene.json: path.segments[1]: s"));
  EXPECT_THAT(summary.cut_short, testing::HasSubstr(" cannot be kept at 1 to 0.001: it is "));
  EXPECT_EQ(summary.warnings.back(), summary.cut_short);
  EXPECT_THAT(read_file(dir / "a" / "provenance.json"), testing::HasSubstr("cannot be kept at 1 to"));
  run(R"({"mode": "constant_p", "P": 0.05, "amount": 0.01, "rate": 1e-4, "servo": {"rate": 1e-6, "wait": 20}})",
      R"("rows": 4)", "b");
  EXPECT_THAT(summary.cut_short, testing::HasSubstr("P cannot be kept at 0.05"));
  EXPECT_THAT(summary.cut_short, testing::HasSubstr("us out of tolerance; the test ends there"));
}

TEST_F(ControlledDrive, GoesOnFromACheckpoint) {
  expect_goes_on_from_checkpoints(
      R"({"mode": "triaxial", "stress": 0.04, "amount": 0.01, "rate": 3e-4, "profile": "steered"},
         {"mode": "iso", "controls": {"nu": 0.74}, "rate": 1e-3})",
      R"("rows": 5, "snapshots": [{"segment": 0, "eps_dev": 0.01}, {"segment": 0}])");
}

TEST_F(ControlledDrive, WarnsOfASnapshotThatWasNotPassed) {
  run(R"({"mode": "triaxial", "amount": 0.005, "rate": 2e-4})",
      R"("rows": 2, "snapshots": [{"segment": 0, "nu": 0.5}, {"segment": 0, "eps_dev": 0.003}])");
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_THAT(summary.warnings,
              testing::Contains("segment 0 never came to nu = 0.5, so there is no snapshot of it"));
  const auto frames = list_frames(dir / "a" / "snapshots.h5");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].eps_dev, 0.003, 1e-4);
}

/// A leg that is left after any step and gone on with is the same leg.
TEST(ControlledLeg, GoesOnWhereItWasLeft) {
  const Material material;
  const Path path = Path::read(Reader(parse_json(R"({"segments": [
      {"mode": "biaxial", "stress": 0.1, "amount": 0.002, "rate": 5e-4, "profile": "steered", "Ek_over_Ep": 1e-2}]})",
                                                 "p.json"),
                                      "p.json"));
  const Leg leg = path.leg(0, Waypoint(0.75));
  const StepPlan plan = plan_steps(leg, 0.02, 1);
  const State start = test::squeezed(material, 100, 1, 0.75, 0);
  const auto end = [&](std::uint64_t pause) {
    Dynamics dynamics(material, start);
    LegState state;
    bool over = false;
    while (!over) {
      over = true;
      drive(dynamics, leg, plan, state, [&](std::uint64_t step) {
        over = pause == 0 || step % pause != 0;
        return over;
      });
    }
    EXPECT_FALSE(state.control.lost);
    EXPECT_GE(state.control.progress, 1);
    return dynamics.state();
  };
  const State whole = end(0);
  EXPECT_GT(whole.step, 100u);
  EXPECT_TRUE(whole == end(1));
  EXPECT_TRUE(whole == end(7));
}

TEST(ControlledLeg, SteeredRateStaysBetweenItsStops) {
  const Material material;
  const auto speed_at_end = [&](const std::string& ratio, const std::string& amount) {
    const std::string json =
        R"({"segments": [{"mode": "d2", "rate": 1e-4, "profile": "steered", "amount": )" + amount +
        R"(, "Ek_over_Ep": )" + ratio + "}]}";
    const Leg leg = Path::read(Reader(parse_json(json, "p.json"), "p.json")).leg(0, Waypoint(0.75));
    Dynamics dynamics(material, test::squeezed(material, 100, 1, 0.75, 0));
    LegState state;
    drive(dynamics, leg, plan_steps(leg, 0.02, 1), state, [](std::uint64_t) { return true; });
    const StrainTensor strain = leg_strain(dynamics, state);
    EXPECT_NEAR(strain[1], leg.strain[1], 1e-3);
    EXPECT_NEAR(strain[0] + strain[1] + strain[2], 0, 1e-11);  // rounding of many steps
    return state.control.speed;
  };
  EXPECT_EQ(speed_at_end("1e-12", "0.01"), slowest_steered);
  EXPECT_EQ(speed_at_end("0.9", "0.05"), fastest_steered);
}

/// What is seen of a steered flow at every look.
struct Look {
  double ratio;  ///< E_k/E_p
  double s_dev;  ///< along the flow
  double rate;   ///< of strain until then, over that of the segment
};

constexpr double steered_rate = 5e-5;  // 1/us

/// D2 of 200 grains from balance at nu = 0.75 to eps_dev = 0.1.
struct SteeredFlow {
  std::vector<Look> looks;
  double largest_change = 0;         ///< of ln(rate) from look to look: 1 in ten contact durations
  bool steady_between_looks = true;  ///< whether the strain grows by the same amount in all steps of a look
};

SteeredFlow steered_flow(double wanted, std::uint64_t seed) {
  const Material material;
  StaticPacking packing(material, test::squeezed(material, 200, seed, 0.75));
  minimise(packing, {});
  const std::string json = R"({"segments": [{"mode": "d2", "profile": "steered", "amount": 0.1, "rate": )" +
                           to_text(steered_rate) + R"(, "Ek_over_Ep": )" + to_text(wanted) + "}]}";
  const Leg leg = Path::read(Reader(parse_json(json, "p.json"), "p.json")).leg(0, Waypoint(0.75));
  Dynamics dynamics(material, packing.state());
  const StepPlan plan = plan_steps(leg, time_step(material, material.r_min(), 0.2), 1);
  SteeredFlow flow;
  flow.largest_change =
      static_cast<double>(look_interval) * plan.dt / (10 * material.contact_duration(material.r_mean));
  LegState state;
  double strain = 0, step_before = 0;
  drive(dynamics, leg, plan, state, [&](std::uint64_t step) {
    if (state.control.own_time >= leg.duration) return true;  // all strain is applied, within a look
    const double now = leg_strain(dynamics, state)[1] / leg.strain[1], grown = now - strain;
    strain = now;
    if (step % look_interval != 1 && std::abs(grown / step_before - 1) > 1e-6)
      flow.steady_between_looks = false;
    step_before = grown;
    if (step % look_interval != 0) return true;
    const Glance seen = dynamics.glance(Stresses::normal);
    const Sym6& s = seen.stress;
    const double s_dev = 1.5 * std::sqrt(3.0) * (s[1] - s[0]) / (s[0] + s[1] + s[2]);
    flow.looks.push_back({seen.kinetic / seen.elastic, s_dev, grown * leg.duration / plan.dt});
    return true;
  });
  return flow;
}

bool at_a_stop(double rate) { return rate < 1.001 * slowest_steered || rate > 0.999 * fastest_steered; }

/// Six packings each, all from one rate: a rate that nothing steers has one median, and cannot be within 2.5
/// of two values that are 10 apart. Over twelve packings the medians are 1.4 times 1e-4 and 0.7 times 1e-3,
/// standard deviations of ln 0.2 and 0.4; the stops are what keeps them from the value wanted.
TEST(ControlledLeg, SteeredFlowHasTheEnergyRatioWanted) {
  for (const double wanted : {1e-4, 1e-3}) {
    double log_of_median = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      std::vector<double> ratios;
      for (const Look& look : steered_flow(wanted, seed).looks) ratios.push_back(look.ratio);
      const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
      std::nth_element(ratios.begin(), middle, ratios.end());
      log_of_median += std::log(*middle / wanted) / 6;
    }
    EXPECT_LT(std::abs(log_of_median), std::log(2.5)) << wanted;
  }
}

/// Towards what is wanted at every look, the more the further it is off, and by at most a factor e in ten
/// contact durations: by all of that where E_k/E_p is off by e^2, the rate by e, and by next to nothing where
/// it is right.
TEST(ControlledLeg, SteeredRateChangesSmoothly) {
  const double wanted = 1e-3;
  const SteeredFlow flow = steered_flow(wanted, 1);
  EXPECT_TRUE(flow.steady_between_looks);
  int near = 0, far = 0;
  for (std::size_t i = 1; i < flow.looks.size(); ++i) {
    const Look &before = flow.looks[i - 1], &after = flow.looks[i];
    const double change = std::log(after.rate / before.rate) / flow.largest_change;
    const double off = std::log(before.ratio / wanted);
    EXPECT_LT(std::abs(change), 1 + 1e-4);
    if (at_a_stop(after.rate)) continue;
    EXPECT_LE(change * off, 1e-4) << change << " at " << off;
    if (std::abs(off) > 2) {
      ++far;
      EXPECT_NEAR(std::abs(change), 1, 1e-4) << off;
    } else if (std::abs(off) < 0.2) {
      ++near;
      EXPECT_LT(std::abs(change), 0.1 + 1e-4) << off;
    }
  }
  EXPECT_GT(near, 10);
  EXPECT_GT(far, 30);
}

/// An avalanche is where s_dev falls by 0.01 over fifty looks, or 35 contact durations. Over twelve packings
/// the rate then falls to 0.1 of what it was, and goes up by 1.8 where s_dev rises.
TEST(ControlledLeg, SteeredRateFallsInAvalanchesAndRisesBetweenThem) {
  constexpr std::size_t stretch = 50;
  int avalanches = 0, quiet = 0;
  double in_avalanches = 0, between = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::vector<Look> looks = steered_flow(1e-4, seed).looks;
    for (std::size_t i = stretch; i < looks.size(); i += stretch) {
      const double stress = looks[i].s_dev - looks[i - stretch].s_dev;
      const double change = std::log(looks[i].rate / looks[i - stretch].rate);
      if (stress < -0.01) in_avalanches += change, ++avalanches;
      if (stress > 0) between += change, ++quiet;
    }
  }
  ASSERT_GT(avalanches, 10);
  ASSERT_GT(quiet, 50);
  EXPECT_LT(in_avalanches / avalanches, -1);
  EXPECT_GT(between / quiet, 0.2);
}

}  // namespace
}  // namespace grainlaw::dem
