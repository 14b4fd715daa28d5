// What is refused before a run because the box would become too narrow or lose its numbers, and what ends
// one.
#include "grainlaw/dem/drive/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "controlled_fixture.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Scene scene_of(const std::string& segments, int count = 100) {
  const std::string json = R"({"preparation": {"count": )" + std::to_string(count) +
                           R"(, "nu": 0.7}, "path": {"segments": [)" + segments + "]}}";
  return Scene::read(Reader(parse_json(json, "scene.json"), "scene.json"), "");
}

/// A cube before it is compressed to nu = 0.7, where the paths begin.
State gas(int count) { return test::squeezed(Material{}, count, 1, 0.3); }

/// What check_width says of a path.
std::string refused(const std::string& segments, int count = 100) {
  const Scene scene = scene_of(segments, count);
  try {
    check_width(plan_stages(scene, 0.7, LongestSteps(scene, scene.material.r_min())), gas(count), scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// -s (n n - m m), n along (t, 1, 0) and m across: extends along n by exp(s).
StrainTensor stretch(double s, double t) {
  const double square = t * t + 1;
  return {-s * (t * t - 1) / square, s * (t * t - 1) / square, 0, 0, 0, -2 * s * t / square};
}

std::string components(const StrainTensor& e, int repeat = 1) {
  std::string list;
  for (const double c : e) list += (list.empty() ? "" : ", ") + to_text(c);
  return R"({"mode": "components", "strain": [)" + list + R"(], "repeat": )" + std::to_string(repeat) + "}";
}

/// F = (2, 1; 1, 1), by which a square lattice becomes itself (Kraynik and Reinelt 1992).
const double golden = 0.5 * (1 + std::sqrt(5.0)), period = 2 * std::log(golden);

Leg leg_of(const std::string& segment) {
  return Path::read(Reader(parse_json(R"({"segments": [)" + segment + "]}", "p.json"), "p.json"))
      .leg(0, Waypoint(0.7));
}

/// The entries of the n-th power of F are Fibonacci numbers, and the box is again the cube that it was, as
/// far as the numbers of its edges hold it.
TEST(Stage, ABoxIsItselfAfterWholePeriods) {
  const double fibonacci[]{1597, 2584, 4181};
  const Leg leg = leg_of(components(stretch(9 * period, golden)));
  const Mat3 edges = Drive(Mat3::diagonal({5, 5, 5}), leg).edges(leg.duration);
  EXPECT_NEAR(edges(0, 0) / (5 * fibonacci[2]), 1, 1e-13);
  EXPECT_NEAR(edges(0, 1) / (5 * fibonacci[1]), 1, 1e-13);
  EXPECT_NEAR(edges(1, 1) / (5 * fibonacci[0]), 1, 1e-13);
  const double skew = std::hypot(fibonacci[2], fibonacci[1]) * std::hypot(fibonacci[1], fibonacci[0]);
  EXPECT_NEAR(determinant(edges) / 125, 1, 10 * std::numeric_limits<double>::epsilon() * skew);
  EXPECT_NEAR(Cell(edges).narrowest() / 5, 1, 10 * std::numeric_limits<double>::epsilon() * skew);
}

TEST(Stage, RefusesEdgesThatHoldTheBoxNoMore) {
  // The product of the edges is 1.5e7 of the volume after nine periods, and 1.02e8, more than 2^26, after
  // ten.
  const std::string one = components(stretch(period, golden));
  EXPECT_EQ(refused(components(stretch(period, golden), 9)), "accepted");
  EXPECT_EQ(
      refused(components(stretch(period, golden), 9) + R"(, {"mode": "relax"}, )" + one),
      "scene.json: path.segments[2]: tilts the box until its edges, which are never flipped, span more than "
      "6.7e+07 times its volume, so that their numbers no longer hold it; strain less");
  EXPECT_EQ(refused(components(stretch(period, golden), 9) + "," + components(stretch(-period, golden), 9)),
            "accepted");
  EXPECT_EQ(refused(R"({"mode": "simple_shear", "amount": 100, "repeat": 10})"), "accepted");
  // Along a diagonal of the cube its edges come together; steered or not, the strain is known.
  for (const char* pace : {"", R"(, "profile": "steered")"})
    EXPECT_THAT(refused(R"({"mode": "components", "strain": [0, 0, 0, 0, 0, 8])" + std::string(pace) + "}"),
                testing::StartsWith("scene.json: path.segments[0]: makes the box"));
  EXPECT_THAT(
      refused(R"({"mode": "simple_shear", "amount": 0.5}, {"mode": "d2", "controls": {"eps_dev": 30}})"),
      testing::StartsWith("scene.json: path.segments[1]: tilts the box"));
}

TEST(Stage, RefusesMoreStepsThanCanBeCounted) {
  const auto refusal_of = [](const std::string& rest) {
    const Scene scene = Scene::read(Reader(parse_json("{" + rest + "}", "s.json"), "s.json"), "");
    try {
      plan_stages(scene, 0.7, LongestSteps(scene, scene.material.r_min()));
      return std::string("accepted");
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  const std::string d2 = R"("path": {"segments": [{"mode": "d2", "amount": 0.0012}]})",
                    relax = R"("path": {"segments": [{"mode": "relax", "duration": 1e14}]})",
                    beginning = "must not take more than 9e+15 steps, but takes ";
  EXPECT_THAT(refusal_of(d2 + R"(, "measure": {"time_step": 1e-20})"),
              testing::HasSubstr("s.json: path.segments[0]: " + beginning));
  EXPECT_THAT(refusal_of(relax + R"(, "measure": {"time_step": {"error": 1e-12}})"),
              testing::HasSubstr("s.json: path.segments[0]: " + beginning));
  EXPECT_THAT(refusal_of(d2 + R"(, "preparation": {"rate": 1e-18})"),
              testing::HasSubstr("s.json: preparation.rate: " + beginning));
  EXPECT_THAT(refusal_of(d2 + R"(, "preparation": {"relax": {"duration": 1e15}})"),
              testing::HasSubstr("s.json: preparation.relax.duration: " + beginning));
  EXPECT_EQ(refusal_of(relax), "accepted");
}

/// F = (65, 8; 8, 1) makes the square lattice itself, too, but not before it was narrow.
TEST(Stage, RefusesABoxThatIsNarrowOnlyOnItsWay) {
  const double t = 4 + std::sqrt(17.0), s = 2 * std::log(t);
  const std::string segment = components(stretch(s, t));
  const Leg leg = leg_of(segment);
  const Drive drive(Mat3::identity(), leg);
  EXPECT_NEAR(Cell(drive.edges(leg.duration)).narrowest(), 1, 1e-11);
  double least = 1;
  for (int k = 1; k < 1000; ++k)
    least = std::min(least, Cell(drive.edges(leg.time_at(k / 1000.0))).narrowest());
  // The edge (0, 1) has the parts 1 and t over sqrt(1 + t^2) along n and m. It is shortest where both are
  // equal, and the box is no wider than its shortest edge is long.
  EXPECT_LE(least, std::sqrt(2 * t / (1 + t * t)));
  const State few = gas(20), many = gas(200);
  const auto cube = [](const State& state) {
    return std::cbrt(determinant(state.box) * state.volume_fraction() / 0.7);
  };
  const double widest = 2 * *std::max_element(few.radius.begin(), few.radius.end());
  ASSERT_LT(least * cube(few), widest);
  ASSERT_GT(cube(few), widest + 0.1);
  ASSERT_GT(0.9 * least * cube(many), 3.02);
  EXPECT_THAT(refused(segment, 20), testing::StartsWith("scene.json: path.segments[0]: makes the box"));
  EXPECT_EQ(refused(segment, 200), "accepted");
}

/// At gamma = 1/2 the faces of a cube are 1/sqrt(1.25) of its edge apart, and nowhere nearer.
TEST(Stage, FindsTheNarrowestPlaceOfABoxThatGlides) {
  const State start = gas(20);
  const double largest = *std::max_element(start.radius.begin(), start.radius.end()),
               least = 2 * largest + 0.02, volume = start.volume_fraction() * determinant(start.box) / 0.7;
  for (const double times : {1 - 1e-4, 1 + 1e-4}) {
    // A square of that edge in x and y, as long as it must be in z; a first leg of 1/64, so that no half lies
    // at 1/2.
    const double edge = std::sqrt(1.25) * least * times, e = std::log(std::cbrt(volume) / edge);
    const std::string said =
        refused(components({e, e, -2 * e}) + R"(, {"mode": "simple_shear", "amount": 0.015625},
                                     {"mode": "simple_shear", "amount": 0.93})",
                20);
    if (times < 1)
      EXPECT_THAT(said, testing::StartsWith("scene.json: path.segments[2]: makes the box"));
    else
      EXPECT_EQ(said, "accepted");
  }
}

TEST(Stage, RefusesAPrescribedAxisThatBecomesTooShortUnderStress) {
  const auto control = [](const std::string& x, const std::string& y, const std::string& z,
                          const std::string& more) {
    return R"({"mode": "control", "x": )" + x + R"(, "y": )" + y + R"(, "z": )" + z + more + "}";
  };
  const std::string kept = R"({"stress": "start"})", far = R"({"strain": 2})", rest = R"({"strain": 0})",
                    some = R"({"strain": 0.9})";
  for (const std::string& segment :
       {std::string(R"({"mode": "biaxial", "amount": 2})"),
        std::string(R"({"mode": "triaxial", "amount": 2})"), control(kept, far, rest, ""),
        control(far, kept, kept, R"(, "profile": "steered")"),
        control(kept, rest, rest, R"(, "yz": {"strain": 2})")})
    EXPECT_THAT(refused(segment), testing::StartsWith("scene.json: path.segments[0]: makes the box"))
        << segment;
  // What a stress strains may be as wide as it likes, and the rest goes on.
  const std::string first = control(kept, some, rest, ""), second = R"(, {"mode": "relax"}, )";
  EXPECT_EQ(refused(first + second + control(some, rest, some, "")), "accepted");
  EXPECT_THAT(refused(first + second + control(kept, some, rest, "")),
              testing::StartsWith("scene.json: path.segments[2]: makes the box"));
  // Nothing is known where a mean stress strains all axes, a shear stress tilts them, or the end is a target.
  EXPECT_EQ(refused(R"({"mode": "constant_p", "amount": 4})"), "accepted");
  EXPECT_EQ(refused(control(rest, far, rest, R"(, "xy": {"stress": 0.001})")), "accepted");
  EXPECT_EQ(refused(R"({"mode": "triaxial", "controls": {"eps_dev": 2}})"), "accepted");
  EXPECT_EQ(refused(first + R"(, {"mode": "simple_shear", "amount": 1}, )" + control(rest, far, rest, "")),
            "accepted");
}

using StageRun = test::ControlledRun;

TEST_F(StageRun, ABoxThatBecomesTooNarrowEndsTheRecord) {
  const std::string first = R"({"mode": "isotropic_stress", "P": 0.03, "rate": 1e-3}, )";
  const auto expect_ended = [&](const std::string& segment, const std::string& why, const std::string& name) {
    const Record r = run(first + segment, R"("rows": 8)", name);
    EXPECT_THAT(summary.cut_short, testing::StartsWith("scene.json: path.segments[1]: ")) << segment;
    EXPECT_THAT(summary.cut_short, testing::HasSubstr(why)) << segment;
    EXPECT_THAT(summary.cut_short, testing::EndsWith("; the test ends there")) << segment;
    EXPECT_GE(r.rows(), 2u) << segment;
    EXPECT_EQ(summary.warnings.back(), summary.cut_short);
  };
  // Slowly, so that it is within tolerance at each row, and so fast that it would be over before it is looked
  // at.
  const std::string no_room = "too narrow for its largest grain";
  expect_ended(R"({"mode": "constant_p", "amount": 4, "rate": 2e-3, "servo": {"tolerance": 0.3}})", no_room,
               "a");
  expect_ended(R"({"mode": "constant_p", "amount": 4, "rate": 100})", no_room, "b");
  expect_ended(
      R"({"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0}, "xy": {"strain": 4},
                   "P": "start", "rate": 10})",
      no_room, "c");
  // Where the servo has led is known when the segment begins.
  expect_ended(R"({"mode": "d2", "amount": 4, "rate": 1e-3})", "makes the box", "d");
}

}  // namespace
}  // namespace grainlaw::dem
