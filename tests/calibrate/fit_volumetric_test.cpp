// Sheared packings that change their volume alone: records that obey the law give its numbers back.
#include "grainlaw/calibrate/fit_volumetric.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_records.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double k_up = 6.5, k_down = -1.5, F_0 = 0.12;

class FitVolumetric : public testing::Test {
 protected:
  FitVolumetric() {
    write_campaign(dir(), thesis_);
    add("up", 0.06, k_up);
    add("down", -0.05, k_down);
  }
  const std::filesystem::path& dir() const { return scratch_.dir(); }
  std::filesystem::path record(const std::string& name) const { return dir() / "records" / name; }
  FitOutput fitted() const { return fit_records(dir(), thesis_file()); }

  /// A rest, in which the fabric falls from 0.13 to F_0, and an isotropic leg from the end of d2-0.71.
  void add(const std::string& name, double amount, double k) const {
    const std::string path = R"({"segments": [{"mode": "relax", "duration": 300},
        {"mode": "iso", "amount": )" +
                             to_text(amount) + "}]}";
    edit(dir() / "campaign.json", [&](const std::string& text) {
      Json campaign = Json::parse(text);
      campaign["tests"].push_back({{"name", name},
                                   {"role", "fit"},
                                   {"from", {{"test", "d2-0.71"}, {"segment", 0}}},
                                   {"path", Json::parse(path)}});
      return campaign.dump(1);
    });
    std::vector<Row> rows;
    for (int i = 0; i <= 40; ++i) {
      const double eps_vol = i < 2 ? 0 : amount * (i - 1) / 39;
      Row row = thesis_.packed("d2", 0.71 * std::exp(eps_vol));
      row.segment = i < 2 ? 0 : 1;
      row.eps_vol = eps_vol;
      row.F_dev = i == 0 ? 0.13 : F_0 * std::exp(-k * eps_vol);
      rows.push_back(row);
    }
    write_record(record(name + "-s1"), path, rows);
    const double half = 1 / std::sqrt(3.0);  // along D2
    add_components(record(name + "-s1"), {-half, half, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}, 0);
    edit(record(name + "-s1") / "scene.json", [](const std::string& text) {
      Json scene = Json::parse(text);
      scene["preparation"] = {{"snapshot", "../d2-0.71-s1/snapshots.h5"}, {"segment", 0}};
      return scene.dump(1);
    });
  }

  ThesisRecords thesis_;
  Scratch scratch_;
};

TEST_F(FitVolumetric, GivesTheNumbersBack) {
  const FitOutput out = fitted();
  ASSERT_TRUE(out.parameters.volumetric);
  EXPECT_NEAR(out.parameters.volumetric->compression.value, k_up, 1e-6);
  EXPECT_NEAR(out.parameters.volumetric->decompression.value, k_down, 1e-6);
  EXPECT_EQ(out.parameters.volumetric->compression.source, "fit");
  const model::ParameterSet read = model::ParameterSet::read(Reader(out.parameters.to_json(), "p.json"));
  EXPECT_EQ(read.to_json(), out.parameters.to_json());
  std::vector<std::string> names;
  for (const Json& fit : out.fits.at("fits")) names.push_back(fit.at("name"));
  EXPECT_THAT(names, Contains("volumetric.compression"));
  EXPECT_THAT(names, Contains("volumetric.decompression"));
}

TEST_F(FitVolumetric, WithoutDecompressionThatIsNeglected) {
  std::filesystem::remove_all(record("down-s1"));
  const auto volumetric = fitted().parameters.volumetric;
  ASSERT_TRUE(volumetric);
  EXPECT_NEAR(volumetric->compression.value, k_up, 1e-6);
  EXPECT_EQ(volumetric->decompression.value, 0);
  EXPECT_EQ(volumetric->decompression.source, "assumed");
  EXPECT_EQ(volumetric->decompression.note, "neglected, as in the thesis: no data");
}

TEST_F(FitVolumetric, WithoutCompressionTheNumbersAreAssumed) {
  std::filesystem::remove_all(record("up-s1"));
  const auto volumetric = fitted().parameters.volumetric;
  ASSERT_TRUE(volumetric);
  EXPECT_EQ(volumetric->compression.value, 9.05);  // docs/model.md, Fabric under change of volume
  EXPECT_EQ(volumetric->decompression.value, 0.86);
  for (const auto* number : {&volumetric->compression, &volumetric->decompression}) {
    EXPECT_EQ(number->source, "assumed");
    EXPECT_THAT(number->note, HasSubstr("data/records/volumetric"));
  }
}

TEST_F(FitVolumetric, RowsFromTheFirstThatCarriesNothingAreNotRead) {
  Record rows = Record::read_csv(record("down-s1") / "record.csv");
  rows["P"].back() = 1e-5;
  rows.write_csv(record("down-s1") / "record.csv");
  const auto out = fitted();
  EXPECT_NEAR(out.parameters.volumetric->decompression.value, k_down, 1e-6);
  for (const Json& fit : out.fits.at("fits"))
    if (fit.at("name") == "volumetric.decompression") {
      EXPECT_EQ(fit.at("n"), 38);
    }
}

TEST_F(FitVolumetric, WithoutComponentsARecordIsLeftOut) {
  std::filesystem::remove_all(record("up-s1"));
  std::vector<Row> rows;
  for (int i = 0; i < 3; ++i) rows.push_back(thesis_.packed("d2", 0.71));
  const std::string path = R"({"segments": [{"mode": "relax"}, {"mode": "iso", "amount": 0.06}]})";
  write_record(record("up-s1"), path, rows);
  edit(record("up-s1") / "scene.json", [](const std::string& text) {
    Json scene = Json::parse(text);
    scene["preparation"] = {{"snapshot", "../d2-0.71-s1/snapshots.h5"}, {"segment", 0}};
    return scene.dump(1);
  });
  const FitOutput out = fitted();
  std::vector<std::string> reasons;
  for (const Json& left : out.fits.at("left_out"))
    if (left.at("test") == "up-s1") reasons.push_back(left.at("reason"));
  EXPECT_THAT(reasons, Contains("volumetric: its record has no components of the fabric"));
}

TEST(VolumetricCurves, AreSharesOfTheFabricAtTheStartOfTheLeg) {
  std::vector<VolumetricCurve> curves;
  curves.push_back({"up-s1", "1", true, {0, 0.02, 0.04}, {1, std::exp(-0.1), std::exp(-0.2)}});
  const FitProblem problem = volumetric_problem(curves, "compression");
  ASSERT_EQ(problem.series.size(), 1u);
  EXPECT_EQ(problem.series[0].points.size(), 2u);  // the first is 1 by definition
  EXPECT_TRUE(volumetric_problem(curves, "decompression").series.empty());
  EXPECT_NEAR(fit(problem).value("compression"), 5, 1e-6);
}

}  // namespace
}  // namespace grainlaw::calibrate
