// The path schema: targets become strains, modes carry their signs, and what cannot be is refused.
#include "grainlaw/element/path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grainlaw/element/error.hpp"

namespace grainlaw {
namespace {

Path path_of(const std::string& text) { return Path::read({parse_json(text, "p.json"), "p.json"}); }

std::string refusal(const std::string& text) {
  try {
    path_of(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// What grains cannot follow in a segment after a rest, or "accepted".
std::string refused_for_grains(const std::string& segment) {
  try {
    path_of(R"({"segments": [{"mode": "relax"}, )" + segment + "]}").need_grains_can_follow();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

std::string refused_segment(const std::string& segment) {
  return refusal(R"({"start": {"nu": 0.7}, "segments": [)" + segment + "]}");
}

TEST(Path, ModesGiveTheirStrainRates) {
  const auto legs = path_of(R"({"segments": [
      {"mode": "iso", "amount": 0.3}, {"mode": "uni", "amount": 0.1},
      {"mode": "d3", "amount": 0.3}, {"mode": "components", "strain": [0.1, 0.2, -0.3]}]})")
                        .legs(0.3);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(legs[0].strain[c], 0.1);
  for (std::size_t c = 3; c < 6; ++c) EXPECT_EQ(legs[0].strain[c], 0);
  EXPECT_EQ(legs[1].strain, (StrainTensor{0, 0, 0.1}));
  EXPECT_NEAR(legs[2].strain[2], 0.2, 1e-15);
  EXPECT_NEAR(legs[2].strain[0], -0.1, 1e-15);
  EXPECT_NEAR(legs[1].eps_dev[1], 0.1, 1e-15);  // |eps_dev rate| of UNI is the rate itself
  EXPECT_NEAR(legs[2].eps_dev[1], 0.4, 1e-15);
}

TEST(Path, D2ExtendsXCompressesYRestsZ) {
  const auto legs = path_of(R"({"segments": [{"mode": "d2", "controls": {"eps_dev": 0.4}}]})").legs(0.7);
  EXPECT_NEAR(legs[0].strain[0], -0.4 / std::numbers::sqrt3, 1e-15);
  EXPECT_NEAR(legs[0].strain[1], 0.4 / std::numbers::sqrt3, 1e-15);
  EXPECT_EQ(legs[0].strain[2], 0);
  EXPECT_EQ(legs[0].eps_vol[1], 0);
  EXPECT_NEAR(legs[0].duration, 0.4 / std::numbers::sqrt3 / 2.839e-5, 1e-6);  // Eq. for D2: sqrt(3) rate
}

TEST(Path, TargetsAreAbsoluteAlongThePath) {
  const auto legs = path_of(R"({"start": {"nu": 0.711}, "segments": [
      {"mode": "d2", "controls": {"eps_dev": 0.4}}, {"mode": "d2", "controls": {"eps_dev": -0.4}},
      {"repeat": 2, "segments": [{"mode": "d2", "amount": 0.1}, {"mode": "d2", "amount": -0.1}]},
      {"mode": "iso", "controls": {"nu": 0.8}}, {"mode": "iso", "controls": {"eps_vol": 0}}]})")
                        .legs(0.711);
  ASSERT_EQ(legs.size(), 8u);
  EXPECT_DOUBLE_EQ(legs[1].eps_dev[0], 0.4);
  EXPECT_DOUBLE_EQ(legs[1].eps_dev[1], -0.4);
  EXPECT_NEAR(legs[5].eps_dev[1], -0.4, 1e-15);
  EXPECT_NEAR(legs[6].eps_vol[1], std::log(0.8 / 0.711), 1e-15);
  EXPECT_NEAR(legs[7].eps_vol[1], 0, 1e-15);
}

TEST(Path, RoundTripKeepsThePath) {
  const Path once = path_of(R"({"start": {"nu": 0.7, "F_dev": -0.1}, "segments": [
      {"mode": "uni", "controls": {"nu": 0.8}, "duration": 900, "profile": "constant"}, {"mode": "relax", "duration": 10},
      {"mode": "d3", "amount": 0.1, "repeat": 3}]})");
  const Json written = once.to_json();
  EXPECT_EQ(written["segments"].size(), 5u);
  EXPECT_EQ(Path::read({written, "p.json"}).to_json(), written);
}

TEST(Path, CosineStartsAndEndsAtRest) {
  const auto leg = path_of(R"({"segments": [{"mode": "iso", "amount": 0.1, "duration": 100}]})").legs(0.6)[0];
  EXPECT_EQ(leg.profile, Profile::cosine);
  EXPECT_EQ(leg.progress(0), 0);
  EXPECT_EQ(leg.progress(100), 1);
  EXPECT_NEAR(leg.progress(1), std::pow(std::numbers::pi / 2 / 100, 2), 1e-7);
  EXPECT_NEAR(leg.progress(37), (1 - std::cos(std::numbers::pi * 0.37)) / 2, 1e-15);
  for (const double f : {0.0, 1e-6, 0.3, 0.9, 1.0}) EXPECT_NEAR(leg.progress(leg.time_at(f)), f, 1e-14);
}

TEST(Path, RefusesWhatCannotBe) {
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "controls": {"nu": 0.8}})"),
            "p.json: segments[0].controls.nu: d2 keeps the volume, so nu cannot be a target");
  EXPECT_EQ(
      refused_segment(R"({"mode": "iso", "controls": {"nu": 0.8, "eps_vol": 0.1}})"),
      "p.json: segments[0].controls: redundant: in iso each of nu and eps_vol fixes the other; give one");
  EXPECT_EQ(refused_segment(R"({"mode": "iso", "controls": {"eps_dev": 0.1}})"),
            "p.json: segments[0].controls.eps_dev: iso does not shear, so eps_dev cannot be a target");
  EXPECT_EQ(refused_segment(R"({"mode": "iso", "controls": {"nu": 0.8}, "amount": 0.1})"),
            "p.json: segments[0]: redundant: controls and amount both say how far; give one");
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "amount": 0.1, "rate": 1e-5, "duration": 10})"),
            "p.json: segments[0].duration: redundant: rate and duration both say how fast; give one");
  EXPECT_EQ(
      refused_segment(R"({"mode": "d2", "controls": {"eps_dev": 0.1}, "repeat": 2})"),
      "p.json: segments[0].repeat: needs amount: a target is already reached the second time, got controls");
  EXPECT_EQ(refused_segment(R"({"mode": "iso", "controls": {"nu": 1.2}})"),
            "p.json: segments[0].controls.nu: must be > 0 and < 1, got 1.2");
  EXPECT_EQ(refused_segment(R"({"mode": "iso", "controls": {"nu": 0.7}})"),
            "p.json: segments[0]: has nothing to do: its target is the state already reached");
  EXPECT_THAT(refused_segment(R"({"mode": "iso", "amount": 3})"),
              testing::HasSubstr("it must stay > 0 and < 1"));
  EXPECT_THAT(refused_segment(R"({"mode": "shear"})"), testing::HasSubstr("must be one of iso, uni"));
  EXPECT_THAT(refused_segment(R"({"mode": "components", "strain": [1, 2, 3, 4]})"),
              testing::HasSubstr("three numbers [xx, yy, zz] or six [xx, yy, zz, yz, xz, xy], got 4"));
  EXPECT_THAT(refused_segment(R"({"mode": "components", "strain": [0, 0, 0, 0, 0, 0]})"),
              testing::HasSubstr("must have a component of at least 1e-12 in size"));
  EXPECT_THAT(refused_segment(R"({"mode": "relax", "rate": 1})"), testing::HasSubstr("unknown key"));
  EXPECT_THAT(
      refused_segment(R"({"repeat": 1000000, "segments": [{"mode": "d2", "amount": 0.1, "repeat": 1000}]})"),
      testing::HasSubstr("longer than 1000000 segments"));
  EXPECT_EQ(refusal(R"({"segments": []})"), "p.json: segments: must have at least one entry, got []");
}

TEST(Path, PresetsOfStressControl) {
  const auto path = path_of(R"({"segments": [
      {"mode": "constant_p", "P": 0.02, "amount": 0.3, "shear": "d3"}, {"mode": "biaxial", "amount": 0.1},
      {"mode": "triaxial", "stress": 0.01, "amount": -0.1, "rate": 1e-5}, {"mode": "isotropic_stress", "P": 0.03},
      {"mode": "control", "x": {"stress": "start"}, "y": {"strain": 0.1}, "z": {"strain": 0}}]})");
  const auto legs = path.nominal_legs(0.7);
  EXPECT_EQ(legs[0].control.mean->stress, 0.02);
  EXPECT_NEAR(legs[0].strain[2], 0.2, 1e-15);
  EXPECT_NEAR(legs[0].eps_dev[1], 0.3, 1e-15);
  EXPECT_TRUE(legs[1].control.by_stress(0));
  EXPECT_FALSE(std::get<StressTarget>(legs[1].control.component[0]).stress);
  EXPECT_FALSE(legs[1].control.by_stress(1) || legs[1].control.by_stress(2));
  EXPECT_EQ(legs[1].strain, (StrainTensor{0, 0.1, 0}));
  for (const std::size_t side : {0u, 1u})
    EXPECT_EQ(std::get<StressTarget>(legs[2].control.component[side]).stress, 0.01);
  EXPECT_EQ(legs[2].strain, (StrainTensor{0, 0, -0.1}));
  EXPECT_EQ(legs[2].control.servo.rate, 1e-4);
  EXPECT_EQ(legs[2].control.servo.wait, 5000);  // a strain of 0.5
  EXPECT_FALSE(legs[3].drives());
  EXPECT_EQ(legs[3].control.servo.rate, 5e-6);
  EXPECT_EQ(legs[4].strain, legs[1].strain);
  EXPECT_EQ(Path::read({path.to_json(), "p.json"}).to_json(), path.to_json());
}

TEST(Path, TwoTargetsAndStopsAreForTheLaw) {
  const auto path = path_of(R"({"start": {"nu": 0.7}, "segments": [
      {"mode": "d2", "controls": {"s_dev": 0.1, "eps_vol": "start"}},
      {"mode": "d2", "amount": -0.1, "stop": {"column": "s_dev", "below": -0.1}}, {"mode": "iso", "controls": {"nu": 0.7}}]})");
  ASSERT_EQ(path.segments[0].law_controls.size(), 2u);
  EXPECT_EQ(path.segments[0].law_controls[0].quantity, Quantity::eps_vol);
  EXPECT_FALSE(path.segments[0].law_controls[0].target);
  EXPECT_EQ(path.segments[0].law_controls[1].target, 0.1);
  EXPECT_EQ(path.segments[1].stop->column, "s_dev");
  EXPECT_FALSE(path.segments[1].stop->above);
  EXPECT_FALSE(path.strain_is_known());
  EXPECT_EQ(path.nominal_legs(0.7).size(), 3u);
  EXPECT_THROW(path.legs(0.7), Error);
  EXPECT_EQ(Path::read({path.to_json(), "p.json"}).to_json(), path.to_json());
  EXPECT_THAT(refused_for_grains(R"({"mode": "d2", "controls": {"P": "start", "eps_dev": 0.1}})"),
              testing::HasSubstr("p.json: segments[1].controls: has two targets"));
  EXPECT_THAT(refused_for_grains(R"({"mode": "d2", "amount": 0.1, "stop": {"column": "P", "above": 1}})"),
              testing::HasSubstr("p.json: segments[1].stop: ends a segment of the law"));
  EXPECT_EQ(refused_for_grains(R"({"mode": "constant_p", "amount": 0.1})"), "accepted");
}

TEST(Path, RefusesTwoTargetsThatCannotBe) {
  EXPECT_EQ(
      refused_segment(R"({"mode": "d2", "controls": {"nu": 0.8, "eps_vol": 0.1, "P": 1}})"),
      "p.json: segments[0].controls: must give one target or two of nu, eps_vol, eps_dev, P, sigma_dev, "
      "s_dev, got 3");
  EXPECT_EQ(refused_segment(R"({"mode": "uni", "controls": {"P": "start", "s_dev": "start"}})"),
            "p.json: segments[0].controls: has nothing to do: both controls stay as at the start");
  EXPECT_EQ(refused_segment(R"({"mode": "uni", "controls": {"P": -1, "s_dev": "start"}})"),
            "p.json: segments[0].controls.P: must be >= 0 and <= 1 of k* = k/(2<r>), got -1");
  EXPECT_THAT(refused_segment(R"({"mode": "uni", "controls": {"P": "stat", "eps_dev": 1}})"),
              testing::HasSubstr("segments[0].controls.P: must be"));
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "amount": 0.1, "stop": {"column": "P"}})"),
            "p.json: segments[0].stop: must give above or below");
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "amuont": 0.1})"),
            "p.json: segments[0].amuont: unknown key, did you mean amount?");
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "rate": 0.1})"),
            "p.json: segments[0]: must give either controls or amount");
  EXPECT_THAT(refused_segment(R"({"mode": "d2", "amount": 0.1, "stop": {"column": "t", "above": 1}})"),
              testing::HasSubstr("segments[0].stop.column: must be one of eps_vol, eps_dev, nu"));
}

TEST(Path, StrainUnderStressControlIsNotKnownInAdvance) {
  const auto path = path_of(R"({"segments": [{"mode": "d2", "amount": 0.1},
      {"mode": "triaxial", "controls": {"eps_dev": 0.3}}, {"mode": "iso", "controls": {"nu": 0.7}}]})");
  try {
    path.legs(0.7);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "p.json: segments[1]: is under stress control (mode triaxial): its strain is known "
                 "only when the grains have run");
  }
  EXPECT_EQ(path.nominal_legs(0.7).size(), 3u);
  Waypoint at(0.7);
  at.move({0, 0, 0.1}, StrainTensor{-0.5, -0.5, 1});
  EXPECT_NEAR(path.leg(2, at).eps_vol[1], 0, 1e-15);
  EXPECT_NEAR(path.leg(1, at).to_eps_dev.value(), 0.3, 0);
}

TEST(Path, RefusesStressControlThatMeansNothing) {
  EXPECT_EQ(refused_segment(R"({"mode": "triaxial", "amount": 0.1, "stress": -0.01})"),
            "p.json: segments[0].stress: must be > 0 and <= 1 of k* = k/(2<r>) (at 0 grains have lost their "
            "contacts), got -0.01");
  EXPECT_EQ(refused_segment(R"({"mode": "biaxial", "amount": 0.1, "stress": "hold"})"),
            "p.json: segments[0].stress: must be \"start\" or a number > 0 and <= 1 of k* = k/(2<r>) (at 0 "
            "grains have "
            "lost their contacts), got \"hold\"");
  EXPECT_EQ(
      refused_segment(
          R"({"mode": "control", "x": {"strain": 0.1, "stress": 0.1}, "y": {"strain": 0}, "z": {"strain": 0}})"),
      "p.json: segments[0].x: redundant: strain and stress both control this component; give one");
  EXPECT_THAT(refused_segment(R"({"mode": "d2", "amount": 0.1, "servo": {}})"),
              testing::HasSubstr("segments[0].servo: unknown key"));
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "amount": 0.1, "profile": "steered", "duration": 10})"),
            "p.json: segments[0].duration: means nothing with a steered rate; give rate");
  EXPECT_EQ(refused_segment(R"({"mode": "d2", "amount": 0.1, "profile": "quasistatic", "rate": 1e-5})"),
            "p.json: segments[0].rate: means nothing in a quasistatic segment: no time passes");
  EXPECT_EQ(refused_segment(R"({"mode": "biaxial", "amount": 0.1, "profile": "quasistatic"})"),
            "p.json: segments[0].profile: must not be quasistatic under stress control: a servo needs time");
  EXPECT_EQ(
      refused_segment(R"({"mode": "relax", "residual": 1e-8, "tolerance": 1e-6})"),
      "p.json: segments[0].tolerance: means nothing with residual: the energy is minimised, and no time "
      "passes");
  EXPECT_THAT(refused_segment(R"({"mode": "d2", "amount": 0.1, "increment": 1e-5})"),
              testing::HasSubstr("segments[0].increment: unknown key"));
}

TEST(Path, ControlOfShearComponents) {
  const auto path = path_of(R"({"segments": [
      {"mode": "control", "x": {"stress": "start"}, "y": {"strain": 0.1}, "z": {"strain": 0},
       "yz": {"stress": 0}, "xz": {"strain": -0.02}, "xy": {"stress": -0.01}},
      {"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0}, "xy": {"strain": -0.2}, "P": "start"},
      {"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0}, "yz": {"strain": 0}, "xy": {"stress": "start"}}]})");
  const auto legs = path.nominal_legs(0.7);
  EXPECT_EQ(legs[0].strain, (StrainTensor{0, 0.1, 0, 0, -0.02, 0}));
  EXPECT_TRUE(legs[0].control.axis_by_stress() && legs[0].control.shear_by_stress());
  EXPECT_TRUE(legs[0].control.by_stress(3) && legs[0].control.by_stress(5));
  EXPECT_FALSE(legs[0].control.by_stress(1) || legs[0].control.by_stress(4));
  EXPECT_EQ(std::get<StressTarget>(legs[0].control.component[3]).stress, 0.0);
  EXPECT_EQ(std::get<StressTarget>(legs[0].control.component[5]).stress, -0.01);
  EXPECT_EQ(legs[1].duration, 0.2 / 2.839e-5);  // by its largest component
  EXPECT_NEAR(legs[1].eps_dev[1] - legs[1].eps_dev[0], 0.2 * std::sqrt(3.0), 1e-15);
  EXPECT_FALSE(legs[1].control.shear_by_stress() || legs[1].control.axis_by_stress());
  EXPECT_FALSE(legs[2].drives());
  EXPECT_FALSE(std::get<StressTarget>(legs[2].control.component[5]).stress);
  EXPECT_EQ(Path::read({path.to_json(), "p.json"}).to_json(), path.to_json());
  const Json segments = path.to_json()["segments"];
  EXPECT_EQ(segments[0]["xy"], (Json{{"stress", -0.01}}));
  EXPECT_EQ(segments[0]["xz"], (Json{{"strain", -0.02}}));
  EXPECT_EQ(segments[2]["xy"], (Json{{"stress", "start"}}));
  EXPECT_FALSE(segments[1].contains("yz") || segments[2].contains("yz"));  // strain 0 is the default
}

TEST(Path, RefusesShearControlThatMeansNothing) {
  const auto refused = [](const std::string& more, const std::string& y = R"({"strain": 0.1})") {
    return refused_segment(R"({"mode": "control", "x": {"strain": 0}, "z": {"strain": 0}, "y": )" + y + ", " +
                           more + "}");
  };
  EXPECT_EQ(refused(R"("xy": {"stress": 2})"),
            "p.json: segments[0].xy.stress: must be >= -1 and <= 1 of k* = k/(2<r>), got 2");
  EXPECT_EQ(refused(R"("xy": {"stress": "hold"})"),
            "p.json: segments[0].xy.stress: must be \"start\" or a number >= -1 and <= 1 of k* = k/(2<r>), "
            "got \"hold\"");
  EXPECT_EQ(refused(R"("yz": {"stress": 0, "strain": 0})"),
            "p.json: segments[0].yz: redundant: strain and stress both control this component; give one");
  EXPECT_EQ(refused(R"("xz": {})"), "p.json: segments[0].xz: must give strain or stress");
  EXPECT_EQ(refused(R"("yx": {"strain": 0.1})"), "p.json: segments[0].yx: unknown key, did you mean xy?");
  EXPECT_EQ(
      refused(R"("xy": {"stress": -0.01})", R"({"stress": 0})"),
      "p.json: segments[0].y.stress: must be > 0 and <= 1 of k* = k/(2<r>) (at 0 grains have lost their "
      "contacts), got 0");
  EXPECT_EQ(refused(R"("xy": {"strain": 0})", R"({"strain": 0})"),
            "p.json: segments[0]: has nothing to do: no component has a strain or a stress");
  EXPECT_EQ(refused(R"("xy": {"stress": 0.01}, "profile": "cosine")", R"({"strain": 0})"),
            "p.json: segments[0].profile: means nothing here: no component is strained");
  EXPECT_EQ(
      refused(R"("xy": {"stress": 0.01}, "P": 0.1)", R"({"stress": 0.1})"),
      "p.json: segments[0].P: needs a strain on each of x, y, z: the isotropic strain that keeps P adds "
      "to it");
  EXPECT_EQ(
      refused(R"("xy": {"strain": 0.01}, "profile": "quasistatic")"),
      "p.json: segments[0].profile: must not be quasistatic in control; with strains alone, components is "
      "the same");
}

TEST(Path, SimpleShear) {
  const auto path = path_of(R"({"segments": [{"mode": "simple_shear", "amount": 1.5, "rate": 1e-4},
      {"mode": "simple_shear", "amount": -1.5, "duration": 100, "profile": "cosine"}]})");
  const auto legs = path.legs(0.7);
  EXPECT_DOUBLE_EQ(legs[0].duration, 1.5e4);
  EXPECT_EQ(legs[0].gamma, 1.5);
  // Squares of stretches are the eigenvalues of (1 + gamma^2, gamma; gamma, 1): exp(2 e) + exp(-2 e) = 2 +
  // gamma^2.
  const double e = legs[0].eps_dev[1] / std::sqrt(3.0);
  EXPECT_NEAR(2 * std::cosh(2 * e), 2 + 1.5 * 1.5, 1e-14);
  EXPECT_NEAR(deviator_magnitude(legs[0].strain), legs[0].eps_dev[1], 1e-15);
  EXPECT_LT(legs[0].strain[5], 0);
  EXPECT_LT(legs[0].strain[0], 0);  // the longest axis turns towards x
  EXPECT_EQ(legs[0].eps_vol[1], 0);
  EXPECT_NEAR(legs[1].eps_dev[1], 0, 1e-15);
  for (const Leg& leg : legs)
    for (const double f : {0.0, 0.3, 1.0}) EXPECT_NEAR(leg.fraction_at(leg.eps_dev_at(f)), f, 1e-15);
  EXPECT_NEAR(legs[0].eps_dev_at(1), legs[0].eps_dev[1], 1e-15);
  const SignConvention sign(legs);
  EXPECT_DOUBLE_EQ(sign.signed_deviator({1, 1, 1, 0, 0, -0.5}, 1), 0.5 * std::sqrt(3.0));
  EXPECT_EQ(Path::read({path.to_json(), "p.json"}).to_json(), path.to_json());
  EXPECT_TRUE(path.spins());
  try {
    path.need_law_can_follow();
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("p.json: segments[0].mode: must not be simple_shear"));
  }
  EXPECT_EQ(refused_segment(R"({"mode": "simple_shear", "amount": 0})"),
            "p.json: segments[0].amount: must be at least 1e-12 in size, got 0");
  EXPECT_EQ(refused_segment(R"({"mode": "simple_shear", "amount": 1e-16})"),
            "p.json: segments[0].amount: must be at least 1e-12 in size, got 1e-16");
  EXPECT_THAT(refused_segment(R"({"mode": "simple_shear", "controls": {"eps_dev": 0.1}})"),
              testing::HasSubstr("segments[0].controls: means nothing in simple_shear; give amount"));
  EXPECT_THAT(refused_segment(R"({"mode": "simple_shear", "amount": 0.1, "profile": "quasistatic"})"),
              testing::HasSubstr("segments[0].profile: must be one of constant, cosine, got"));
}

/// In however many segments: eps_dev is that of the whole shear, sqrt(3) asinh(gamma/2). What does not shear
/// may come between, another shear ends it.
TEST(Path, SimpleShearGoesOnAcrossSegments) {
  const auto eps_dev = [](double gamma) { return std::sqrt(3.0) * std::asinh(gamma / 2); };
  const auto end = [](const std::string& segments) {
    return path_of(R"({"segments": [)" + segments + "]}").legs(0.7).back();
  };
  const auto shear = [](double gamma, int repeat = 1) {
    return R"({"mode": "simple_shear", "amount": )" + to_text(gamma) + R"(, "repeat": )" +
           std::to_string(repeat) + "}";
  };
  EXPECT_NEAR(end(shear(2)).eps_dev[1], eps_dev(2), 1e-15);
  EXPECT_NEAR(end(shear(0.02, 100)).eps_dev[1], eps_dev(2), 1e-13);
  EXPECT_NEAR(
      end(shear(2) + R"(, {"mode": "relax"}, {"mode": "iso", "amount": 0.01}, )" + shear(-3)).eps_dev[1],
      eps_dev(-1), 1e-14);
  EXPECT_NEAR(end(shear(2) + R"(, {"mode": "d2", "amount": 0.1}, )" + shear(1)).eps_dev[1],
              eps_dev(2) + 0.1 + eps_dev(1), 1e-14);
  const Leg back = end(shear(2) + "," + shear(-3));
  for (const double f : {0.0, 0.3, 2.0 / 3, 1.0}) {
    EXPECT_NEAR(back.eps_dev_at(f), eps_dev(2 - 3 * f), 1e-14);
    EXPECT_NEAR(back.fraction_at(back.eps_dev_at(f)), f, 1e-14);
  }
}

TEST(Path, GrainsNeedABoxWhoseNumbersHold) {
  const auto control = [](double x, double y, double xy, const std::string& more) {
    return R"({"mode": "control", "x": {"strain": )" + to_text(x) + R"(}, "y": {"strain": )" + to_text(y) +
           R"(}, "z": {"strain": 0}, "xy": {"strain": )" + to_text(xy) + "}" + more + "}";
  };
  const std::string steered = R"(, "profile": "steered")", kept = R"(, "P": "start")";
  for (const std::string& more : {std::string(), steered, kept})
    EXPECT_EQ(
        refused_for_grains(control(0, 0, 50, more)),
        "p.json: segments[1].xy.strain: strains the box of grains beyond what its edges can hold in double "
        "precision: principal strains of one segment may differ by at most 18, so this must be, the others "
        "in "
        "proportion, at most 9 in size, got 50");
  // Of xy alone they differ by 2 xy, of x, -x and xy by 2 hypot(x, xy).
  EXPECT_EQ(refused_for_grains(control(0, 0, 8.999, kept)), "accepted");
  EXPECT_EQ(refused_for_grains(control(5.39, -5.39, -7.19, kept)), "accepted");
  EXPECT_THAT(refused_for_grains(control(6, -6, -8, kept)),
              testing::HasSubstr("at most 7.2 in size, got -8"));
  EXPECT_THAT(refused_for_grains(R"({"mode": "components", "strain": [0, 0, 0, 0, 9.1, 0]})"),
              testing::HasSubstr("segments[1].strain[4]: strains"));
  EXPECT_THAT(refused_for_grains(R"({"mode": "triaxial", "amount": -20})"),
              testing::HasSubstr("segments[1].amount: strains"));
  EXPECT_EQ(refused_for_grains(R"({"mode": "simple_shear", "amount": 100})"), "accepted");
  EXPECT_EQ(refused_for_grains(R"({"mode": "iso", "amount": -50})"), "accepted");
}

TEST(SignConvention, AShearStressIsTheAxisWhereNothingIsStrained) {
  const auto waits = [](const std::string& xy) {
    return R"({"mode": "control", "x": {"stress": 0.1}, "y": {"stress": 0.1}, "z": {"stress": 0.1}, "xy": {"stress": )" +
           xy + "}}";
  };
  const auto legs = path_of(R"({"segments": [)" + waits("-0.01") + "," + waits("0.01") + "," + waits("0") +
                            "," + R"({"mode": "d2", "amount": 0.1}, )" + waits("\"start\"") + "]}")
                        .nominal_legs(0.7);
  const SignConvention sign(legs);
  const Sym6 sheared{1, 1, 1, 0, 0, -0.5};
  for (const std::size_t i : {0u, 1u, 2u})  // back along the axis of the first
    EXPECT_DOUBLE_EQ(sign.signed_deviator(sheared, i), 0.5 * std::sqrt(3.0)) << i;
  for (const std::size_t i : {3u, 4u}) EXPECT_EQ(sign.axis(i), (StrainTensor{-1, 1, 0}));
}

TEST(SignConvention, FollowsTheAxesOfTheMode) {
  const auto legs = path_of(R"({"segments": [{"mode": "iso", "amount": 0.1}, {"mode": "d2", "amount": -0.1},
      {"mode": "relax"}, {"mode": "uni", "amount": 0.1}]})")
                        .legs(0.6);
  const SignConvention sign(legs);
  const Sym6 y_loaded{1, 3, 2, 0, 0, 0}, z_loaded{1, 1, 2, 0, 0, 0}, x_loaded{3, 1, 2, 0, 0, 0};
  EXPECT_DOUBLE_EQ(sign.signed_deviator(y_loaded, 0), std::sqrt(3.0));  // iso before D2 takes D2's axis
  EXPECT_DOUBLE_EQ(sign.signed_deviator(y_loaded, 1),
                   std::sqrt(3.0));  // sgn(Qyy - Qxx), whatever the direction of strain
  EXPECT_DOUBLE_EQ(sign.signed_deviator(x_loaded, 2), -std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(sign.signed_deviator(z_loaded, 3), 1.0);
}

TEST(SignConvention, ReversalByComponentsKeepsTheAxis) {
  const auto legs = path_of(R"({"segments": [{"mode": "components", "strain": [0.1, -0.3, 0.2]},
      {"mode": "components", "strain": [-0.1, 0.3, -0.2]}, {"mode": "components", "strain": [0.1, -0.1, 0]}]})")
                        .legs(0.6);
  EXPECT_GT(legs[0].eps_dev[1], 0);
  EXPECT_NEAR(legs[1].eps_dev[1], 0, 1e-15);
  EXPECT_LT(legs[2].eps_dev[1], 0);  // along D2's axis, backwards
}

TEST(Path, SixComponentsOfStrain) {
  const Path path = path_of(R"({"segments": [{"mode": "components", "strain": [0, 0, 0, 0, 0, 0.1]},
      {"mode": "components", "strain": [0.1, 0.2, 0, 0.3, 0, -0.1]}, {"mode": "components", "strain": [0.1, 0, 0, 0, 0, 0]}]})");
  const auto legs = path.legs(0.6);
  EXPECT_EQ(legs[1].strain, (StrainTensor{0.1, 0.2, 0, 0.3, 0, -0.1}));
  EXPECT_NEAR(legs[0].duration, 0.1 / 2.839e-5, 1e-9);  // by its largest component
  // Pure shear: the magnitude of D2 with the same principal strains, 0.1 and -0.1.
  EXPECT_NEAR(legs[0].eps_dev[1], 0.1 * std::sqrt(3.0), 1e-15);
  EXPECT_EQ(legs[0].eps_vol[1], 0);
  EXPECT_NEAR(legs[1].eps_vol[1], 0.3, 1e-15);
  const SignConvention sign(legs);
  EXPECT_DOUBLE_EQ(sign.signed_deviator({1, 1, 1, 0, 0, 0.5}, 0), 0.5 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(sign.signed_deviator({1, 1, 1, 0, 0, -0.5}, 0), -0.5 * std::sqrt(3.0));
  const Json written = path.to_json();
  EXPECT_EQ(written["segments"][0]["strain"].size(), 6u);
  EXPECT_EQ(written["segments"][2]["strain"].size(), 3u);
  EXPECT_EQ(Path::read({written, "p.json"}).to_json(), written);
}

TEST(Path, CoaxialModes) {
  EXPECT_TRUE(coaxial({0, 0, 1}, {-0.5, -0.5, 1}));  // UNI and D3
  EXPECT_TRUE(coaxial({-1, 1, 0}, {1, -1, 0}));
  EXPECT_TRUE(coaxial({1, 1, 1}, {-1, 1, 0}));  // ISO has no axis
  EXPECT_FALSE(coaxial({-1, 1, 0}, {0, 0, 1}));
  EXPECT_FALSE(coaxial({-1, 1, 0}, {0, 0, 0, 0, 0, 1}));
  EXPECT_TRUE(coaxial({1, 1, 1, 0, 0, -0.5}, {0, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace grainlaw
