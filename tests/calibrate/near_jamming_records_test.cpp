// Group near_jamming and the minimal form in the stages of calibrate: our own parameter set with memory
// (data/grains/w-3-memory.json), and predictions of tests of role memory.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"
#include "same_parameters.hpp"

namespace grainlaw::calibrate {
namespace {

const std::filesystem::path data_dir = GRAINLAW_DATA_DIR;

const MemorySources& sources() {
  static const MemorySources both{data_dir / "thesis" / "near-jamming.json", data_dir / "memory",
                                  data_dir / "records" / "small-cycles"};
  return both;
}

const FitOutput& fitted() {
  static const FitOutput out = fit_records(data_dir / "records" / "base", thesis_file(), {}, sources());
  return out;
}

model::ParameterSet shipped() { return model::ParameterSet::load(data_dir / "grains" / "w-3-memory.json"); }

/// data/grains/w-3-memory.json is what `fit data/records/base --memory data/memory --reversals
/// data/records/small-cycles` writes.
TEST(NearJammingRecords, TheSetInTheTreeIsTheirs) {
  test::expect_same_parameters(fitted().parameters, shipped());
}

/// Of the groups that the minimal form takes nothing comes from the thesis, and what is assumed are limits.
TEST(NearJammingRecords, TheMinimalFormTakesOurOwnNumbers) {
  int fits = 0;
  const model::ParameterSet set = shipped();
  for (const model::NamedParameter& entry : set.named()) {
    if (!entry.name.starts_with("near_jamming.") && !entry.name.starts_with("memory.")) continue;
    EXPECT_NE(entry.parameter->source, "thesis") << entry.name;
    if (entry.parameter->source == "fit") {
      EXPECT_TRUE(entry.parameter->stderr_.has_value()) << entry.name;
      ++fits;
    } else {
      const bool limit = entry.name.ends_with(".C0") || entry.name.ends_with("F_max.Q_max") ||
                         entry.name.ends_with("beta_F.Q_max");
      // The form with memory has it alone, and phi_pack cannot be told from it.
      EXPECT_TRUE(limit || entry.name == "memory.pack_rate") << entry.name;
    }
  }
  EXPECT_EQ(fits, 15 + 16 + 14);
}

/// docs/fits.md has these numbers, and tests/calibrate/fit_near_jamming_test.cpp their errors.
TEST(NearJammingRecords, TheyAreThoseOfTheTables) {
  const model::NearJammingLaws near = *fitted().parameters.near_jamming;
  EXPECT_NEAR(near.iso.C1.value, 8.14, 0.01);
  EXPECT_NEAR(near.iso.p0.value, 0.0422, 1e-4);
  EXPECT_NEAR(near.d2.C1.value, 8.10, 0.01);
  EXPECT_NEAR(near.d2.p0.value, 0.0370, 1e-4);
  EXPECT_NEAR(near.s_max.Q_max.value, 0.156, 1e-3);
  EXPECT_NEAR(near.beta_F.Q_v.value, 71, 1);
  EXPECT_EQ(near.s_max.nu_c.value, fitted().parameters.memory->phi_SJ.value);
  EXPECT_EQ(*near.iso.C1.thesis, 8.5);
}

/// Without tests of memory nothing says where near is.
TEST(NearJammingRecords, NoneWithoutMemory) {
  const FitOutput out =
      fit_records(data_dir / "records" / "base", thesis_file(), {}, {sources().near_jamming, {}});
  EXPECT_FALSE(out.parameters.near_jamming.has_value());
}

TEST(NearJammingRecords, TablesThatAreNotThereAreNamed) {
  const Scratch scratch;
  try {
    fit_records(data_dir / "records" / "base", thesis_file(), {}, {{}, scratch.dir()});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("over_compression.csv"), std::string::npos) << error.what();
  }
}

/// A packing compressed once to 0.73 and taken up at 0.66 on the way back, and sheared there.
void write_small_campaign(const std::filesystem::path& dir, const ThesisRecords& thesis) {
  write_file(dir / "campaign.json", R"({"name": "small", "material": {"w": 3}, "preparation": {"count": 1000},
    "seeds": [1], "tests": [
      {"name": "oc", "role": "memory", "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.82}},
                                                             {"mode": "iso", "controls": {"nu": 0.64}}]}},
      {"name": "sj", "role": "memory", "from": {"test": "oc", "segment": 1, "nu": 0.66},
       "path": {"segments": [{"mode": "d2", "controls": {"eps_dev": 0.4}}]}}]})");
  write_record(dir / "records/oc-s1", path_json("iso"), thesis.cycle("iso"));
  write_record(dir / "records/sj-s1", path_json("d2"), thesis.shear("d2", 0.66));
  Json scene = load_json(dir / "records/sj-s1/scene.json");
  scene["preparation"] = {{"snapshot", "../oc-s1/snapshots.h5"}, {"nu", 0.66}, {"segment", 1}};
  write_file(dir / "records/sj-s1/scene.json", scene.dump());
}

TEST(NearJammingRecords, TestsOfMemoryArePredictedFromWhatTheirPackingsHaveSeen) {
  const Scratch scratch;
  write_small_campaign(scratch.dir(), ThesisRecords());
  const model::ParameterSet set = shipped();
  const Json out = predict_records(scratch.dir(), set);
  EXPECT_TRUE(out.at("predictions").empty());  // no test has that role
  ASSERT_EQ(out.at("memory").size(), 2u);
  const Json &oc = out.at("memory")[0], &sj = out.at("memory")[1];
  EXPECT_EQ(oc.at("test"), "oc-s1");
  EXPECT_EQ(oc.at("form"), "minimal");
  EXPECT_EQ(oc.at("start").at("phi_J").at("value"), set.memory->phi_SJ.value);
  EXPECT_EQ(sj.at("test"), "sj-s1");
  EXPECT_EQ(sj.at("status"), "ok");
  EXPECT_NEAR(sj.at("start").at("phi_J").at("value").get<double>(),
              model::jamming_density_after(set.memory->over_compression(), 0.82, 1.0), 1e-9);
  const Record record = Record::read_csv(scratch.dir() / sj.at("file").get<std::string>());
  EXPECT_EQ(record["P"].front(), 0);  // below phi_J
  EXPECT_GT(record["P"].back(), 0);   // jammed by shear
}

/// A set without numbers near jamming predicts none.
TEST(NearJammingRecords, NoneByASetWithout) {
  const Scratch scratch;
  write_small_campaign(scratch.dir(), ThesisRecords());
  model::ParameterSet set = shipped();
  set.near_jamming.reset();
  EXPECT_TRUE(predict_records(scratch.dir(), set).at("memory").empty());
}

}  // namespace
}  // namespace grainlaw::calibrate
