// Every example can be used: the readers take it, and the law runs the paths with every parameter set.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/parameters.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::tests {
namespace {

std::vector<std::filesystem::path> examples(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(GRAINLAW_DATA_DIR) / folder))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Path load_path(const std::filesystem::path& file) {
  return Path::read(Reader(load_json(file), file.string()));
}

TEST(Examples, PathsHaveAStartAndCanBeWalked) {
  ASSERT_GE(examples("paths").size(), 4U);
  for (const auto& file : examples("paths")) {
    const Path path = load_path(file);
    ASSERT_TRUE(path.start.nu) << file;
    EXPECT_EQ(path.nominal_legs(*path.start.nu).size(), path.segments.size()) << file;
  }
}

TEST(Examples, ScenesCanBeRunInMinutes) {
  ASSERT_GE(examples("scenes").size(), 3U);
  for (const auto& file : examples("scenes")) {
    const dem::Scene scene = dem::Scene::load(file);
    ASSERT_TRUE(std::holds_alternative<dem::NewPacking>(scene.preparation)) << file;
    const auto count = static_cast<double>(std::get<dem::NewPacking>(scene.preparation).count);
    double duration = 0;
    for (const Leg& leg : scene.legs(*scene.start_nu())) duration += leg.duration;
    const double step = scene.measure.time_step * scene.material.contact_duration(scene.material.r_min());
    EXPECT_LT(count * duration / step, 3e9) << file;  // a few minutes at 1e7 particle-steps per second
  }
}

/// But the one campaign that what a reversal does is fitted to.
TEST(Examples, CampaignsKeepUniAndReversalsForPredictions) {
  for (const auto& file : examples("campaigns")) {
    const auto campaign = calibrate::Campaign::load(file);
    for (const auto& test : campaign.tests) {
      const auto& segments = test.path.segments;
      const bool uni = segments.front().mode == Mode::uni;
      std::set<bool> ways;  // of shear
      for (const Leg& leg : test.path.nominal_legs(0.7, false))
        if (leg.eps_dev[1] != leg.eps_dev[0]) ways.insert(leg.eps_dev[1] > leg.eps_dev[0]);
      const bool reversed = segments.front().mode == Mode::d2 && ways.size() > 1;
      if ((uni || reversed) && test.role != calibrate::Role::memory) {
        const bool fitted = reversed && campaign.name == "small-cycles";
        EXPECT_EQ(test.role, fitted ? calibrate::Role::fit : calibrate::Role::predict)
            << file << ": " << test.name;
      }
    }
  }
}

TEST(Examples, ParameterSetsSurviveWritingAndReading) {
  ASSERT_EQ(examples("thesis").size(), 13U);
  for (const auto& file : examples("thesis")) {
    const Json written = model::ParameterSet::load(file).to_json();
    EXPECT_EQ(written, model::ParameterSet::read(Reader(written, "again")).to_json()) << file;
    EXPECT_EQ(nlohmann::json(written), nlohmann::json(load_json(file)))
        << file << ": a key was lost or added";
  }
}

constexpr model::Form forms[] = {model::Form::reduced_closed, model::Form::reduced, model::Form::coupled};

model::Prediction predict(const model::ParameterSet& set, const std::filesystem::path& path,
                          model::Form form) {
  model::PredictOptions options;
  options.form = form;
  return model::predict(set, load_path(path), options);
}

TEST(Examples, TheLawRunsEveryPathWithEverySet) {
  for (const auto& file : examples("thesis")) {
    if (file.stem() == "w-1.0") continue;
    const auto set = model::ParameterSet::load(file);
    for (const auto& path : examples("paths"))
      for (const auto form : forms) {
        const auto prediction = predict(set, path, form);
        EXPECT_GT(prediction.record.rows(), 10U) << file << path;
        EXPECT_FALSE(prediction.status.failed()) << file << path << ": " << prediction.status.message;
      }
  }
}

TEST(Examples, TheLawSaysThatW1HasNoGrowthRates) {
  const std::filesystem::path data = GRAINLAW_DATA_DIR;
  const auto set = model::ParameterSet::load(data / "thesis" / "w-1.0.json");
  for (const auto form : forms) {
    try {
      predict(set, data / "paths" / "d2-cycle.json", form);
      ADD_FAILURE() << "predicted without a growth rate";
    } catch (const Error& error) {
      EXPECT_TRUE(error.key() == "shear.beta_s" || error.key() == "shear.beta_F") << error.what();
    }
  }
}

}  // namespace
}  // namespace grainlaw::tests
