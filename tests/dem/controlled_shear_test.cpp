// Shear components under control: the same test told in a turned frame, shear stresses that are held, and
// what cannot be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "controlled_fixture.hpp"
#include "grainlaw/dem/drive/controlled_drive.hpp"
#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/run/cost.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

/// A segment of mode control: what each of x, y, z follows, then the rest.
std::string control(const std::string& x, const std::string& y, const std::string& z,
                    const std::string& rest) {
  return R"({"mode": "control", "x": )" + x + R"(, "y": )" + y + R"(, "z": )" + z + ", " + rest + "}";
}
std::string strain(double e) { return R"({"strain": )" + to_text(e) + "}"; }
std::string stress(double s) { return R"({"stress": )" + to_text(s) + "}"; }
const std::string rest = strain(0), kept = R"({"stress": "start"})";

Leg leg_of(const std::string& segment) {
  return Path::read(Reader(parse_json(R"({"segments": [)" + segment + "]}", "p.json"), "p.json"))
      .leg(0, Waypoint(0.75));
}

/// A leg followed by a packing for so many steps, or to its end.
struct Followed {
  Followed(const State& start, const Leg& leg, std::uint64_t steps = 0, double dt = 0.02)
      : dynamics(material, start) {
    drive(dynamics, leg, plan_steps(leg, dt, 1), state,
          [steps](std::uint64_t step) { return step != steps; });
    measured = dynamics.measure();
  }
  Material material;
  Dynamics dynamics;
  LegState state;
  Measurement measured;
};

void expect_near(const Sym6& is, const Sym6& should, double tolerance) {
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(is[c], should[c], tolerance) << c;
}

/// What a leg makes of a packing in the first 300 steps is what `there` makes of it in a turned frame. The
/// last bits of both grow apart by a factor of some thousand in so many steps.
void expect_the_same_when_turned(const State& start, const Mat3& turn, const std::string& here,
                                 const std::string& there) {
  const Leg here_leg = leg_of(here), there_leg = leg_of(there);
  const Followed a(start, here_leg, 300), b(test::turned(start, turn), there_leg, 300);
  ASSERT_EQ(a.state.step, 300u);
  ASSERT_EQ(b.state.step, 300u);
  expect_near(b.measured.stress, test::turned(a.measured.stress, turn), 1e-9 * a.measured.stress[0]);
  expect_near(b.measured.kinetic_stress, test::turned(a.measured.kinetic_stress, turn),
              1e-9 * a.measured.kinetic_stress[0]);
  const StrainTensor strain = leg_strain(a.dynamics, a.state);
  EXPECT_GT(deviator_magnitude(strain), 1e-3);
  expect_near(leg_strain(b.dynamics, b.state), test::turned(strain, turn), 1e-12);
  EXPECT_NEAR(b.state.control.own_time, a.state.control.own_time, 1e-9 * a.state.control.own_time);
  EXPECT_NEAR(leg_eps_dev(b.dynamics, there_leg, b.state), leg_eps_dev(a.dynamics, here_leg, a.state), 1e-12);
}

const Mat3 by_45_degrees = test::rotation({0, 0, 1}, std::numbers::pi / 4);

TEST(ControlledShear, ConstantPressureInAFrameTurnedBy45Degrees) {
  const Material material;
  const std::string pace = R"("rate": 2e-3, "P": "start", "servo": {"tolerance": 0.3})";
  expect_the_same_when_turned(test::squeezed(material, 100, 35, 0.75), by_45_degrees,
                              control(strain(-0.02), strain(0.02), rest, pace),
                              control(rest, rest, rest, R"("xy": {"strain": -0.02}, )" + pace));
}

TEST(ControlledShear, SteeredInAFrameTurnedBy45Degrees) {
  const Material material;
  const std::string pace = R"(, "rate": 1e-3, "profile": "steered", "Ek_over_Ep": 1e-3})";
  expect_the_same_when_turned(test::squeezed(material, 100, 36, 0.75), by_45_degrees,
                              R"({"mode": "components", "strain": [-0.02, 0.02, 0])" + pace,
                              R"({"mode": "components", "strain": [0, 0, 0, 0, 0, -0.02])" + pace);
}

TEST(ControlledShear, PermutedAxes) {
  // x' = y, y' = z, z' = x; every component of another kind.
  const Material material;
  const std::string pace = R"(, "rate": 1e-3, "servo": {"tolerance": 0.05})";
  expect_the_same_when_turned(
      test::squeezed(material, 100, 37, 0.75), {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
      control(strain(0.02), stress(0.1), kept,
              R"("yz": {"strain": -0.01}, "xz": {"stress": -0.004}, "xy": {"stress": "start"})" + pace),
      control(stress(0.1), kept, strain(0.02),
              R"("xy": {"strain": -0.01}, "yz": {"stress": -0.004}, "xz": {"stress": "start"})" + pace));
}

/// The in-plane stress P - q, P + q along x and y is P, P and a shear stress of -q in a frame turned by 45
/// degrees. The servo's gains differ between the frames, so the ways there do; where nothing slips the ends
/// do not.
TEST(ControlledShear, AShearStressIsADifferenceOfNormalStressesAlongTurnedAxes) {
  const Material material;
  State start = test::squeezed(material, 100, 38, 0.8, 0);
  {
    Followed rested(start, leg_of(R"({"mode": "isotropic_stress", "P": 0.06, "rate": 1e-4})"));
    start = rested.dynamics.state();
  }
  const double P = 0.06, q = 0.0015;
  const std::string pace = R"(, "rate": 1e-4, "servo": {"tolerance": 1e-5})";
  const Followed here(start,
                      leg_of(control(stress(P - q), stress(P + q), rest, R"("xy": {"stress": 0})" + pace)));
  const Followed there(test::turned(start, by_45_degrees),
                       leg_of(control(stress(P), stress(P), rest, R"("xy": )" + stress(-q) + pace)));
  ASSERT_FALSE(here.state.control.lost || there.state.control.lost);
  const double unit = material.stress_unit();
  for (const std::size_t c : {0u, 1u, 5u}) {
    const double should = (c == 5 ? -q : P) * unit;
    EXPECT_NEAR(there.measured.stress[c], should, 1e-5 * P * unit) << c;
    EXPECT_NEAR(test::turned(here.measured.stress, by_45_degrees)[c], should, 2e-5 * P * unit) << c;
  }
  // Both are off their targets by 1e-5 P at most, and the packing is stiffer than 0.1 k* in every direction.
  const StrainTensor strain = leg_strain(there.dynamics, there.state);
  EXPECT_LT(strain[5], -1e-3);
  expect_near(test::turned(leg_strain(here.dynamics, here.state), by_45_degrees), strain, 2 * 1e-5 * P / 0.1);
}

using ControlledShearRun = test::ControlledRun;

/// sxy of every row but the first, against `target`, in units of the larger of P and the target.
double largest_error(const Record& record, double target) {
  double largest = 0;
  for (std::size_t i = 1; i < record.rows(); ++i)
    largest =
        std::max(largest, std::abs(record["sxy"][i] - target) / std::max(record["P"][i], std::abs(target)));
  return largest;
}

TEST_F(ControlledShearRun, ShearStressAtEveryRowWhileYIsCompressed) {
  const std::string pace = R"(, "rate": 1e-4)";
  const auto held = [&](const std::string& target, const std::string& name) {
    return run(control(kept, strain(0.03), rest, R"("xy": )" + target + pace), R"("rows": 10)", name, 300);
  };
  const Record free = run(control(kept, strain(0.03), rest, R"("rate": 1e-4)"), R"("rows": 10)", "free", 300);
  EXPECT_GT(largest_error(free, free["sxy"][0]), 1e-2);
  for (const double target : {0.0, 0.001, -0.001}) {
    const Record r = held(stress(target), to_text(target));
    ASSERT_EQ(r.rows(), 11u);
    EXPECT_EQ(summary.cut_short, "");
    EXPECT_LE(largest_error(r, target), 1e-3);
    for (std::size_t i = 1; i <= 10; ++i) EXPECT_NEAR(r["sxx"][i] / r["sxx"][0], 1, 1e-3);
  }
  const Record r = held(kept, "start");
  EXPECT_GT(std::abs(r["sxy"][0]), 1e-2 * r["P"][0]);
  EXPECT_LE(largest_error(r, r["sxy"][0]), 1e-3);
}

TEST_F(ControlledShearRun, SaysWhichShearStressCannotBeReached) {
  // Frictionless grains bear about a tenth of P as shear stress.
  const std::string too_much = R"("P": 0.03, "xy": {"stress": -0.012}, "rate": )";
  const Record r = run(R"({"mode": "d2", "amount": 0.01, "rate": 1e-3}, )" +
                           control(rest, rest, rest, too_much + R"(1e-3, "servo": {"wait": 100})") + "," +
                           R"({"mode": "relax"})",
                       R"("rows": 4)");
  EXPECT_EQ(r.rows(), 5u);
  EXPECT_THAT(
      summary.cut_short,
      testing::StartsWith("scene.json: path.segments[1]: sxy cannot be kept at -0.012 to 0.001 of P = 0.0"));
  EXPECT_THAT(
      summary.cut_short,
      testing::ContainsRegex(": it is -?0\\.00[0-9]+ after 100\\.[0-9]+ us out of tolerance; the test"));
  EXPECT_EQ(summary.warnings.back(), summary.cut_short);
  // Strained on and on, the box becomes too narrow first.
  run(control(rest, rest, rest, too_much + R"(1e-2, "servo": {"wait": 1e5})"), R"("rows": 4)", "b");
  EXPECT_THAT(
      summary.cut_short,
      testing::HasSubstr("us out of tolerance, and the box would become too narrow for its largest grain"));
}

TEST_F(ControlledShearRun, GoesOnFromACheckpoint) {
  expect_goes_on_from_checkpoints(
      control(stress(0.04), strain(0.01), rest,
              R"("yz": {"strain": 0.005}, "xy": {"stress": -0.001}, "rate": 3e-4, "profile": "steered")") +
          R"(, {"mode": "triaxial", "amount": 0.005, "rate": 3e-4})",
      R"("rows": 5, "snapshots": [{"segment": 0, "eps_dev": 0.008}, {"segment": 1}])");
}

TEST_F(ControlledShearRun, DeviatoricStrainOfShearAndBack) {
  const auto shear = [](double e) {
    return control(rest, rest, rest, R"("xy": )" + strain(e) + R"(, "P": "start", "rate": 5e-4)");
  };
  const Record r = run(shear(-0.02) + "," + shear(0.01) + R"(, {"mode": "components",
      "strain": [0, 0, 0, 0, 0, 0.01], "rate": 5e-4, "profile": "steered"})",
                       R"("rows": 5, "snapshots": [{"segment": 1, "eps_dev": 0.025}])");
  ASSERT_EQ(r.rows(), 16u);
  const double size = std::sqrt(3.0);
  // A row is taken at the first look after its strain was reached: ten steps on at most.
  const double look = 10 * 0.3 * 5e-4 * size;
  for (std::size_t k = 1; k <= 5; ++k) {
    const double share = static_cast<double>(k) / 5;
    EXPECT_NEAR(r["eps_dev"][k], 0.02 * size * share, look);
    EXPECT_NEAR(r["eps_dev"][5 + k], (0.02 - 0.01 * share) * size, look);
    EXPECT_NEAR(r["eps_dev"][10 + k], 0.01 * size * (1 - share), look);
  }
  EXPECT_LT(r["sxy"][5], 0);
  const Sym6 sheared{r["sxx"][5], r["syy"][5], r["szz"][5], r["syz"][5], r["sxz"][5], r["sxy"][5]};
  EXPECT_NEAR(r["sigma_dev"][5], deviator_magnitude(sheared), 1e-12);  // along the axis of xy < 0
  const auto frames = list_frames(dir / "a" / "snapshots.h5");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].eps_dev, 0.025, look);
}

TEST_F(ControlledShearRun, StrainsAloneAreComponents) {
  run(R"({"mode": "components", "strain": [0.01, 0, -0.005, 0.004, 0, -0.01], "rate": 5e-4})");
  run(control(strain(0.01), rest, strain(-0.005),
              R"("yz": {"strain": 0.004}, "xy": {"strain": -0.01}, "rate": 5e-4, "profile": "cosine")"),
      R"("rows": 10)", "b");
  EXPECT_EQ(read_file(dir / "a" / "record.csv"), read_file(dir / "b" / "record.csv"));
}

/// Left after any step and gone on with, a leg is the same leg.
TEST(ControlledShear, GoesOnWhereItWasLeft) {
  const Material material;
  const State start = test::squeezed(material, 100, 1, 0.75, 0);
  const Leg leg = leg_of(control(stress(0.1), strain(0.002), rest,
                                 R"("xz": {"strain": 0.001}, "xy": {"stress": 0.002}, "rate": 5e-4)"));
  const auto end = [&](std::uint64_t pause) {
    Dynamics dynamics(material, start);
    LegState state;
    for (bool over = false; !over;) {
      over = true;
      drive(dynamics, leg, plan_steps(leg, 0.02, 1), state, [&](std::uint64_t step) {
        over = pause == 0 || step % pause != 0;
        return over;
      });
    }
    EXPECT_FALSE(state.control.lost);
    return dynamics.state();
  };
  const State whole = end(0);
  EXPECT_GT(whole.step, 100u);
  EXPECT_TRUE(whole == end(7));
}

TEST_F(ControlledShearRun, SimpleShearAndBack) {
  const std::string segments =
      R"({"mode": "simple_shear", "amount": 0.4, "rate": 2e-3}, {"mode": "simple_shear", "amount": -0.4, "rate": 2e-3})";
  const Record r =
      run(segments, R"("rows": 4, "snapshots": [{"segment": 0, "eps_dev": 0.2}, {"segment": 0}])");
  ASSERT_EQ(r.rows(), 9u);
  const double step = 1e-4;  // rows are at the end of one
  double there = 0, back = 0;
  for (std::size_t k = 1; k <= 4; ++k) {
    const double e = std::sqrt(3.0) * std::asinh(0.05 * static_cast<double>(k));
    EXPECT_NEAR(r["eps_dev"][k], e, k == 4 ? 1e-12 : step);
    EXPECT_NEAR(r["eps_dev"][4 + k], std::sqrt(3.0) * std::asinh(0.2 - 0.05 * static_cast<double>(k)),
                k == 4 ? 1e-12 : step);
    EXPECT_NEAR(r["nu"][k] / r["nu"][0], 1, 1e-12);
    EXPECT_EQ(r["sigma_dev"][k] > 0, r["sxy"][k] < 0);
    there += r["sxy"][k];
    back += r["sxy"][4 + k];
  }
  EXPECT_LT(there, 0);
  EXPECT_GT(back, 0);
  const auto frames = list_frames(dir / "a" / "snapshots.h5");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[0].eps_dev, 0.2, step);
  EXPECT_NEAR(frames[1].eps_dev, r["eps_dev"][4], 1e-12);
  std::filesystem::remove_all(dir);
  expect_goes_on_from_checkpoints(segments, R"("rows": 4, "snapshots": [{"segment": 0, "eps_dev": 0.2}])");
}

TEST_F(ControlledShearRun, SimpleShearGoesOnAfterARestThatAServoCameBefore) {
  const Record r = run(R"({"mode": "isotropic_stress", "P": 0.05, "rate": 1e-3},
                          {"mode": "simple_shear", "amount": 0.3, "rate": 2e-3}, {"mode": "relax", "duration": 5},
                          {"mode": "simple_shear", "amount": 0.3, "rate": 2e-3})",
                       R"("rows": 1)");
  ASSERT_EQ(r.rows(), 5u);
  EXPECT_NEAR(r["eps_dev"][4] - r["eps_dev"][1], std::sqrt(3.0) * std::asinh(0.3), 1e-12);
}

TEST_F(ControlledShearRun, CanBeExplained) {
  const Scene scene =
      scene_of(control(rest, rest, rest, R"("xy": {"strain": 0.01}, "P": "start", "rate": 1e-3)") + "," +
                   control(kept, strain(0.01), rest, R"("xy": {"stress": 0}, "rate": 1e-3)"),
               R"("rows": 3)", 64, 1, "5");
  const SceneCost cost = cost_of(scene);
  ASSERT_EQ(cost.stages.size(), 4u);
  EXPECT_EQ(cost.rows, 7u);
  for (const StageCost& stage : cost.stages) EXPECT_GT(stage.seconds, 0) << stage.stage.name;
}

}  // namespace
}  // namespace grainlaw::dem
