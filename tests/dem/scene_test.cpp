// Scenes: defaults as documented, a round trip that changes nothing, and one clear line for each kind of bad
// input.
#include "grainlaw/dem/scene/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;

Scene scene_of(const std::string& text, const fs::path& dir = "scenes") {
  const Json json = parse_json(text, "scene.json");
  return Scene::read(Reader(json, "scene.json"), dir);
}

std::string refusal(const std::string& text) {
  try {
    scene_of(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

const std::string iso = R"({"segments": [{"mode": "iso", "controls": {"nu": 0.7}}]})";
const std::string iso_and_back =
    R"({"segments": [{"mode": "iso", "controls": {"nu": 0.82}}, {"mode": "iso", "controls": {"nu": 0.64}}]})";

std::string with(const std::string& key, const std::string& value, const std::string& path = iso) {
  return R"({")" + key + R"(": )" + value + R"(, "path": )" + path + "}";
}

TEST(Scene, DefaultsAreThoseOfTheDocumentation) {
  const Json json = scene_of(R"({"path": )" + iso + "}").to_json();
  EXPECT_EQ(json["material"].dump(),
            R"({"w":3.0,"k":100000.0,"r_mean":1.0,"rho":2000.0,"gamma":1000.0,"gamma_b":100.0})");
  EXPECT_EQ(
      json["preparation"].dump(),
      R"({"count":1000,"seed":1,"nu_gas":0.3,"speed":0.02,"nu":0.64,"rate":0.0002,"relax":{"tolerance":1e-06,"duration":2000.0}})");
  EXPECT_EQ(json["measure"].dump(),
            R"({"rows":100,"snapshots":[],"moduli":[],"time_step":0.2,"time_step_gas":0.05,)"
            R"("standard":["stress","fabric","coordination","energy_ratio"],"observe":[]})");
  EXPECT_EQ(json["path"]["segments"].size(), 1u);
}

TEST(Scene, AStepMayBeChosenByItsError) {
  const Scene scene = scene_of(with("measure", R"({"time_step": {"error": 1e-3}})"));
  EXPECT_EQ(scene.measure.time_step, step_of_contact_error(1e-3));
  EXPECT_NEAR(scene.measure.time_step, 0.0493, 1e-4);
  EXPECT_EQ(scene.to_json()["measure"]["time_step"], scene.measure.time_step);
  EXPECT_THAT(refusal(with("measure", R"({"time_step": {"error": 0.02}})")),
              testing::HasSubstr("measure.time_step.error: must be >= 1e-12 and <= 0.0169, got 0.02"));
  EXPECT_THAT(refusal(with("measure", R"({"time_step_gas": {"error": 0}})")),
              testing::HasSubstr("measure.time_step_gas.error: must be >= 1e-12"));
  EXPECT_THAT(refusal(with("measure", R"({"time_step": {"wanted": 1e-3}})")),
              testing::HasSubstr("measure.time_step"));
}

TEST(Scene, RoundTripOfANewPacking) {
  const std::string text = R"({
    "material": {"w": 2, "k": 5e4, "r_mean": 0.5, "rho": 2500, "gamma": 10, "gamma_b": 1},
    "preparation": {"count": 8, "seed": 9007199254740992, "nu_gas": 0.45, "speed": 0.1, "nu": 0.62, "rate": 1e-3,
                    "relax": {"tolerance": 1e-5, "duration": 100}},
    "path": {"start": {"nu": 0.62}, "segments": [
      {"mode": "iso", "controls": {"nu": 0.7}, "duration": 500},
      {"mode": "relax"},
      {"mode": "d2", "controls": {"eps_dev": 0.2}},
      {"repeat": 2, "segments": [{"mode": "uni", "amount": 0.01}]}]},
    "measure": {"rows": 7, "time_step": 0.2, "time_step_gas": 0.01, "snapshots": [
      {"segment": 0, "nu": 0.65}, {"segment": 1}, {"segment": 2, "eps_dev": 0.1}, {"segment": 4}]}})";
  const Scene scene = scene_of(text);
  const Json json = scene.to_json();
  EXPECT_EQ(scene_of(json.dump()).to_json().dump(), json.dump());
  EXPECT_EQ(json["preparation"]["seed"], 9007199254740992);
  EXPECT_EQ(json["preparation"]["relax"].dump(), R"({"tolerance":1e-05,"duration":100.0})");
  EXPECT_EQ(json["path"]["segments"].size(), 5u);
  EXPECT_EQ(json["measure"]["snapshots"].dump(),
            R"([{"segment":0,"nu":0.65},{"segment":1},{"segment":2,"eps_dev":0.1},{"segment":4}])");
  const auto& packing = std::get<NewPacking>(scene.preparation);
  EXPECT_EQ(packing.count, 8);
  EXPECT_EQ(packing.speed, 0.1);
  EXPECT_EQ(packing.relax.duration, 100);
  EXPECT_EQ(scene.material.w, 2);
  EXPECT_EQ(scene.measure.snapshots[2].eps_dev, 0.1);
  EXPECT_EQ(scene.start_nu(), 0.62);
}

TEST(Scene, RoundTripOfASnapshot) {
  for (const std::string choice :
       {R"(, "nu": 0.7, "segment": 1)", R"(, "frame": 3)", R"(, "segment": 2)", ""}) {
    const Scene scene = scene_of(with("preparation", R"({"snapshot": "../iso/snapshots.h5")" + choice + "}",
                                      R"({"segments": [{"mode": "d2", "amount": 0.3}]})"));
    const Json json = scene.to_json();
    EXPECT_EQ(scene_of(json.dump()).to_json().dump(), json.dump());
    EXPECT_EQ(json["preparation"].dump(),
              Json::parse(R"({"snapshot": "../iso/snapshots.h5")" + choice + "}").dump());
    EXPECT_EQ(std::get<FromSnapshot>(scene.preparation).file, fs::path("scenes/../iso/snapshots.h5"));
  }
}

TEST(Scene, SnapshotPathIsWrittenAsSeenFromTheRecord) {
  const Scene scene = scene_of(with("preparation", R"({"snapshot": "old/snapshots.h5"})"), "/data/scenes");
  EXPECT_EQ(scene.to_json("/data/out/d2")["preparation"]["snapshot"], "../../scenes/old/snapshots.h5");
  EXPECT_EQ(scene.to_json()["preparation"]["snapshot"], "old/snapshots.h5");
  const Scene absolute =
      scene_of(with("preparation", R"({"snapshot": "/old/snapshots.h5"})"), "/data/scenes");
  EXPECT_EQ(absolute.to_json("/data/out/d2")["preparation"]["snapshot"], "/old/snapshots.h5");
  EXPECT_EQ(std::get<FromSnapshot>(absolute.preparation).file, fs::path("/old/snapshots.h5"));
}

TEST(Scene, StartOfThePathChoosesTheFrame) {
  const std::string path = R"({"start": {"nu": 0.7}, "segments": [{"mode": "d2", "amount": 0.3}]})";
  const Scene scene = scene_of(with("preparation", R"({"snapshot": "a.h5", "segment": 1})", path));
  EXPECT_EQ(std::get<FromSnapshot>(scene.preparation).choice,
            (FrameChoice{.nu = 0.7, .frame = {}, .segment = 1}));
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "nu": 0.7})", path)), "accepted");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "nu": 0.69})", path)),
            "scene.json: path.start.nu: must be preparation.nu = 0.69, got 0.7");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "frame": 2})", path)),
            "scene.json: path.start.nu: redundant: preparation.frame already chooses the state; give one");
  EXPECT_EQ(refusal(with("preparation", R"({"nu": 0.64})", path)),
            "scene.json: path.start.nu: must be preparation.nu = 0.64, got 0.7");
  EXPECT_EQ(refusal(with("preparation", R"({"nu": 0.7})", path)), "accepted");
}

TEST(Scene, LegsStartWhereTheGrainsAre) {
  const Scene scene = scene_of(with("preparation", R"({"snapshot": "a.h5"})"));
  EXPECT_FALSE(scene.start_nu().has_value());
  EXPECT_NEAR(scene.legs(0.66).at(0).eps_vol[1], std::log(0.7 / 0.66), 1e-14);
  EXPECT_THROW(scene.legs(0.7), Error);  // nothing to do
}

TEST(Scene, SnapshotPathIsRightFromAFolderYetToBeMade) {
  const Scene scene = scene_of(with("preparation", R"({"snapshot": "old/snapshots.h5"})"), "scenes");
  EXPECT_EQ(scene.to_json("not-yet/out")["preparation"]["snapshot"], "../../scenes/old/snapshots.h5");
}

TEST(Scene, GrainsOfASnapshotMustBeOfTheMaterial) {
  State state;
  for (int i = 0; i < 100; ++i) state.radius.push_back(0.5 + (i + 0.5) / 100);  // w = 3, mean 1 mm
  const auto refusal_of = [&](const std::string& material) -> std::string {
    const Scene scene = scene_of(R"({"material": )" + material +
                                 R"(, "preparation": {"snapshot": "/a.h5"}, "path": )" + iso + "}");
    try {
      scene.check_grains(state);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of("{}"), "accepted");
  EXPECT_EQ(refusal_of(R"({"k": 2e5, "rho": 1000})"), "accepted");
  EXPECT_EQ(refusal_of(R"({"r_mean": 2})"),
            "scene.json: material.r_mean: must be that of the grains in /a.h5, 1 mm, got 2");
  EXPECT_EQ(
      refusal_of(R"({"w": 2})"),
      "scene.json: material.w: must be that of the grains in /a.h5, whose radii deviate by 0.2887 mm from "
      "their mean; got 2, with which they would by 0.1925 mm");
  EXPECT_NO_THROW(
      scene_of(with("material", R"({"r_mean": 2})")).check_grains(state));  // makes its own grains
}

TEST(Scene, ModuliAreAskedForLikeSnapshots) {
  const Scene scene =
      scene_of(with("measure", R"({"moduli": [{"segment": 1, "nu": 0.7}, {"segment": 1}]})", iso_and_back));
  ASSERT_EQ(scene.measure.moduli.size(), 2u);
  EXPECT_EQ(scene.measure.moduli[0].nu, 0.7);
  EXPECT_EQ(scene.to_json()["measure"]["moduli"].dump(), R"([{"segment":1,"nu":0.7},{"segment":1}])");
}

// ---- bad input, key by key

TEST(SceneRefuses, UnknownKeys) {
  EXPECT_EQ(refusal(with("materail", "{}")), "scene.json: materail: unknown key, did you mean material?");
  EXPECT_EQ(refusal(with("preparation", R"({"cont": 100})")),
            "scene.json: preparation.cont: unknown key, did you mean count?");
  EXPECT_EQ(refusal(with("preparation", R"({"relax": {"tol": 1}})")),
            "scene.json: preparation.relax.tol: unknown key, known are duration, tolerance");
  EXPECT_EQ(refusal(with("measure", R"({"row": 10})")),
            "scene.json: measure.row: unknown key, did you mean rows?");
  EXPECT_EQ(refusal(with("measure", R"({"snapshots": [{"segment": 0}, {"segment": 0, "v": 0.7}]})")),
            "scene.json: measure.snapshots[1].v: unknown key, known are eps_dev, nu, segment");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "count": 100})")),
            "scene.json: preparation.count: unknown key, known are frame, nu, segment, snapshot");
}

TEST(SceneRefuses, WrongTypes) {
  EXPECT_EQ(refusal(with("material", R"({"k": "hard"})")),
            "scene.json: material.k: must be a number >= 1e-15 and <= 1e+15, got \"hard\"");
  EXPECT_EQ(refusal(with("preparation", R"({"count": 10.5})")),
            "scene.json: preparation.count: must be a whole number from 8 to 10000000, got 10.5");
  EXPECT_EQ(refusal(with("preparation", "[]")), "scene.json: preparation: must be an object {...}, got []");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": 3})")),
            "scene.json: preparation.snapshot: must be a text, got 3");
  EXPECT_EQ(refusal(with("measure", R"({"snapshots": {}})")),
            "scene.json: measure.snapshots: must be a list of objects, got {}");
  EXPECT_EQ(refusal("[]"), "scene.json: must be an object {...}, got []");
}

TEST(SceneRefuses, NumbersOutOfRange) {
  const auto key_value_and_right = [](const std::string& group, const std::string& key,
                                      const std::string& value, const std::string& right) {
    EXPECT_EQ(refusal(with(group, R"({")" + key + R"(": )" + value + "}")),
              "scene.json: " + group + "." + key + ": must be " + right + ", got " + value);
  };
  key_value_and_right("material", "w", "0.5", ">= 1 and <= 100");
  key_value_and_right("material", "w", "101", ">= 1 and <= 100");
  key_value_and_right("material", "k", "-100000.0", ">= 1e-15 and <= 1e+15");
  key_value_and_right("material", "r_mean", "0", ">= 1e-15 and <= 1e+15");
  key_value_and_right("material", "rho", "-1", ">= 1e-15 and <= 1e+15");
  key_value_and_right("material", "gamma", "-1", ">= 0 and <= 1e+15");
  key_value_and_right("material", "gamma_b", "-0.5", ">= 0 and <= 1e+15");
  key_value_and_right("preparation", "count", "7", "a whole number from 8 to 10000000");
  key_value_and_right("preparation", "count", "10000001", "a whole number from 8 to 10000000");
  key_value_and_right("preparation", "seed", "-1", "a whole number from 0 to 9007199254740992");
  key_value_and_right("preparation", "seed", "9007199254740994", "a whole number from 0 to 9007199254740992");
  key_value_and_right("preparation", "nu_gas", "0", "> 0 and <= 0.45");
  key_value_and_right("preparation", "nu_gas", "0.46", "> 0 and <= 0.45");
  key_value_and_right("preparation", "speed", "0", "> 0 and <= 1e+06");
  key_value_and_right("preparation", "nu", "0", "> 0.3 and < 1");
  key_value_and_right("preparation", "nu", "0.3", "> 0.3 and < 1");
  key_value_and_right("preparation", "nu", "1", "> 0.3 and < 1");
  key_value_and_right("preparation", "rate", "-1e-06", "> 0 and <= 1e+06");
  key_value_and_right("measure", "rows", "0", "a whole number from 1 to 100000");
  key_value_and_right("measure", "rows", "100001", "a whole number from 1 to 100000");
  key_value_and_right("measure", "time_step", "0", "> 0 and <= 0.2");
  key_value_and_right("measure", "time_step", "0.21", "> 0 and <= 0.2");
  key_value_and_right("measure", "time_step_gas", "0.21", "> 0 and <= 0.2");
  EXPECT_EQ(refusal(with("preparation", R"({"relax": {"tolerance": 1}})")),
            "scene.json: preparation.relax.tolerance: must be > 0 and < 1, got 1");
  EXPECT_EQ(refusal(with("preparation", R"({"relax": {"duration": 0}})")),
            "scene.json: preparation.relax.duration: must be > 0, got 0");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "nu": 1})")),
            "scene.json: preparation.nu: must be > 0 and < 1, got 1");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "frame": -1})")),
            "scene.json: preparation.frame: must be a whole number from 0 to 1000000000, got -1");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": ""})")),
            "scene.json: preparation.snapshot: must be the path of a snapshots.h5, got \"\"");
}

TEST(SceneRefuses, TargetsOutsideZeroToOne) {
  const auto to = [](const std::string& nu) {
    return R"({"path": {"segments": [{"mode": "iso", "controls": {"nu": )" + nu + "}}]}}";
  };
  EXPECT_EQ(refusal(to("0")), "scene.json: path.segments[0].controls.nu: must be > 0 and < 1, got 0");
  EXPECT_EQ(refusal(to("1")), "scene.json: path.segments[0].controls.nu: must be > 0 and < 1, got 1");
  EXPECT_EQ(refusal(R"({"path": {"segments": [{"mode": "uni", "amount": 0.5}]}})").substr(0, 64),
            "scene.json: path.segments[0]: takes the volume fraction to 1.055");
}

TEST(SceneRefuses, MissingPath) { EXPECT_EQ(refusal("{}"), "scene.json: path: is missing"); }

TEST(SceneRefuses, StartValuesThatGrainsMeasure) {
  for (const std::string key : {"P", "sigma_dev", "F_dev", "phi_J", "phi_max"})
    EXPECT_EQ(
        refusal(R"({"path": {"start": {")" + key +
                R"(": 0.5}, "segments": [{"mode": "iso", "amount": 0.1}]}})"),
        "scene.json: path.start." + key +
            ": must be left out: grains measure it, they cannot be given it (only nu may be given), got 0.5");
}

TEST(SceneRefuses, TwoWaysToChooseAFrame) {
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "nu": 0.7, "frame": 1})")),
            "scene.json: preparation.frame: redundant: nu already chooses the state; give one");
  EXPECT_EQ(refusal(with("preparation", R"({"snapshot": "a.h5", "segment": 1, "frame": 1})")),
            "scene.json: preparation.segment: redundant: frame already chooses the state; give one");
}

TEST(SceneRefuses, ModuliThatThePathDoesNotMeet) {
  const auto at = [](const std::string& requests) {
    return refusal(with("measure", R"({"moduli": [)" + requests + "]}", iso_and_back));
  };
  EXPECT_EQ(at(R"({"segment": 2})"),
            "scene.json: measure.moduli[0].segment: must be a segment of the path, 0 to 1, got 2");
  EXPECT_EQ(at(R"({"segment": 0, "nu": 0.5})").substr(0, 70),
            "scene.json: measure.moduli[0].nu: must lie in segment 0 (iso), nu from");
  EXPECT_EQ(at(R"({"segment": 1}, {"segment": 0}, {"segment": 1})"),
            "scene.json: measure.moduli[2]: asks for the same state as an earlier one");
}

TEST(SceneRefuses, SnapshotsThatThePathDoesNotMeet) {
  const auto at = [](const std::string& request, const std::string& path = iso_and_back) {
    return refusal(with("measure", R"({"snapshots": [{"segment": 0}, )" + request + "]}", path));
  };
  EXPECT_EQ(at(R"({"segment": 1, "nu": 0.7})"), "accepted");
  EXPECT_EQ(at(R"({"segment": 1, "nu": 0.82})"), "accepted");
  EXPECT_EQ(at(R"({"segment": 1, "nu": 0.64})"), "accepted");
  EXPECT_EQ(at(R"({"segment": 2})"),
            "scene.json: measure.snapshots[1].segment: must be a segment of the path, 0 to 1, got 2");
  EXPECT_EQ(at(R"({"nu": 0.7})"), "scene.json: measure.snapshots[1].segment: is missing");
  EXPECT_EQ(
      at(R"({"segment": 0, "nu": 0.7, "eps_dev": 0.1})"),
      "scene.json: measure.snapshots[1].eps_dev: redundant: nu already says where in the segment; give one");
  EXPECT_EQ(at(R"({"segment": 0, "nu": 0.5})").substr(0, 73),
            "scene.json: measure.snapshots[1].nu: must lie in segment 0 (iso), nu from");
  EXPECT_TRUE(at(R"({"segment": 0, "nu": 0.5})").ends_with(", got 0.5"));
  EXPECT_EQ(
      at(R"({"segment": 0, "eps_dev": 0.1})"),
      "scene.json: measure.snapshots[1].eps_dev: segment 0 (iso) does not change eps_dev, so it has no such "
      "place, got 0.1");
  const std::string shear = R"({"segments": [{"mode": "iso", "controls": {"nu": 0.7}},
    {"mode": "d2", "controls": {"eps_dev": 0.4}}, {"mode": "d2", "controls": {"eps_dev": -0.4}}]})";
  EXPECT_EQ(at(R"({"segment": 2, "eps_dev": -0.1})", shear), "accepted");
  EXPECT_EQ(at(R"({"segment": 1, "eps_dev": -0.1})", shear),
            "scene.json: measure.snapshots[1].eps_dev: must lie in segment 1 (d2), eps_dev from 0 to 0.4, "
            "got -0.1");
  EXPECT_EQ(
      at(R"({"segment": 1, "nu": 0.7})", shear),
      "scene.json: measure.snapshots[1].nu: segment 1 (d2) does not change nu, so it has no such place, got "
      "0.7");
}

TEST(SceneRefuses, SnapshotsOutsideOnceTheStartIsKnown) {
  const Scene scene = scene_of(R"({"preparation": {"snapshot": "a.h5"}, "path": )" + iso +
                               R"(, "measure": {"snapshots": [{"segment": 0, "nu": 0.66}]}})");
  EXPECT_NO_THROW(scene.legs(0.65));
  EXPECT_THROW(scene.legs(0.67), Error);
}

TEST(SceneRefuses, MissingFiles) {
  const auto dir = fs::temp_directory_path() / ("grainlaw-scene-" + std::to_string(getpid()));
  fs::create_directories(dir);
  const auto load_error = [&](const fs::path& file) -> std::string {
    try {
      Scene::load(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string name = (dir / "scene.json").string();
  EXPECT_EQ(load_error(name), name + ": no such file");
  std::ofstream(name) << with("preparation", R"({"snapshot": "a.h5"})");
  EXPECT_EQ(load_error(name), name +
                                  ": preparation.snapshot: must be a file, seen from the directory of the "
                                  "scene, got \"a.h5\" (there is no " +
                                  (dir / "a.h5").string() + ")");
  std::ofstream(dir / "a.h5") << "x";
  EXPECT_EQ(load_error(name), "accepted");
  fs::remove_all(dir);
}

// ---- what campaigns use

TEST(NewPackingRead, CampaignRefusesSeed) {
  const Json json = parse_json(R"({"count": 100, "seed": 3})", "campaign.json");
  const Reader reader(json, "campaign.json", "preparation");
  try {
    NewPacking::read(reader, NewPacking::SeedKey::refused);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "campaign.json: preparation.seed: must be left out: the campaign's seeds are used");
  }
  EXPECT_EQ(NewPacking::read(reader).seed, 3u);
}

TEST(MeasureRead, FallsBackToAnother) {
  const Json all = parse_json(R"({"rows": 20, "time_step": 0.15, "snapshots": [{"segment": 3}]})", "a.json");
  const Measure fallback = Measure::read(Reader(all, "a.json"));
  const Json one = parse_json(R"({"rows": 5})", "a.json");
  const Measure measure = Measure::read(Reader(one, "a.json"), fallback);
  EXPECT_EQ(measure.rows, 5);
  EXPECT_EQ(measure.time_step, 0.15);
  ASSERT_EQ(measure.snapshots.size(), 1u);
  const Json none = parse_json(R"({"snapshots": []})", "a.json");
  EXPECT_TRUE(Measure::read(Reader(none, "a.json"), fallback).snapshots.empty());
}

TEST(Scene, ObserversAreKeptInTheOrderOfTheirColumns) {
  const auto with = [](const std::string& names) {
    const std::string json =
        R"({"path": {"segments": [{"mode": "iso", "amount": 0.1}]}, "measure": {"observe": )" + names + "}}";
    return Scene::read(Reader(parse_json(json, "s.json"), "s.json"), "").to_json()["measure"]["observe"];
  };
  EXPECT_EQ(with(R"(["nonaffine", "contacts"])"), Json::parse(R"(["contacts", "nonaffine"])"));
  EXPECT_EQ(with("[]"), Json::array());
  try {
    with(R"(["contacts", "percolaton"])");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.key(), "measure.observe[1]");
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean percolation?"));
  }
}

TEST(Scene, GroupsOfColumnsAreKeptInTheOrderOfTheirColumns) {
  const auto written = [](const std::string& names) {
    return scene_of(with("measure", R"({"standard": )" + names + "}")).to_json()["measure"]["standard"];
  };
  EXPECT_EQ(written(R"(["energy_ratio", "stress"])"), Json::parse(R"(["stress", "energy_ratio"])"));
  EXPECT_EQ(written("[]"), Json::array());
  const auto refused = [](const std::string& names) {
    return refusal(with("measure", R"({"standard": )" + names + "}"));
  };
  EXPECT_THAT(refused(R"(["fabric", "stres"])"),
              testing::HasSubstr("measure.standard[1]: must be one of stress, fabric, coordination, "
                                 "energy_ratio, got \"stres\"; did you mean stress?"));
  EXPECT_THAT(refused(R"(["fabric", "P"])"),
              testing::HasSubstr("measure.standard[1]: must be one of stress, fabric, coordination, "
                                 "energy_ratio, got \"P\", a column of stress in measure.standard"));
  EXPECT_THAT(refused(R"(["E_k"])"),
              testing::HasSubstr("got \"E_k\", a column of energy in measure.observe"));
  EXPECT_THAT(refusal(with("measure", R"({"observe": ["xi_x"]})")),
              testing::HasSubstr("got \"xi_x\", a column of percolation in measure.observe"));
  EXPECT_THAT(refused(R"(["nu"])"), testing::HasSubstr("measure.standard[0]: must be one of stress, fabric"));
  EXPECT_THAT(refused(R"(["fabric", "stress", "fabric"])"),
              testing::HasSubstr("measure.standard[2]: is given twice, got fabric"));
  EXPECT_THAT(refused(R"("stress")"), testing::HasSubstr("measure.standard: must be a list of words"));
}

}  // namespace
}  // namespace grainlaw::dem
