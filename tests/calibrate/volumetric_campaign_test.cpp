// The records that stand in data/records/volumetric: fabric of sheared packings of 9261 grains under change
// of volume alone, and what it does for tests of the base campaign that no fit has read.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/fit_volumetric.hpp"
#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::calibrate {
namespace {

constexpr const char* thesis = GRAINLAW_DATA_DIR "/thesis/parameters.json";

const RecordFolder& records() {
  static const RecordFolder folder = read_records(GRAINLAW_DATA_DIR "/records/volumetric");
  return folder;
}

std::vector<VolumetricCurve> curves_of(const std::string& seed) {
  std::vector<VolumetricCurve> curves;
  for (const TestRecord& test : records().tests)
    if (seed.empty() || test.seed == seed)
      for (const VolumetricCurve& curve : volumetric_curves(test, Selection{}.P_min)) curves.push_back(curve);
  return curves;
}

/// Compression rids a sheared packing of its fabric, some six times as fast as it gains density.
TEST(VolumetricCampaign, CompressionTakesAwayFabric) {
  const FitResult fit = fit_volumetric(curves_of("")).compression;
  ASSERT_TRUE(fit.determined());
  EXPECT_GT(fit.value("compression"), 5 * *fit["compression"].stderr_);
  double before = 0, after = 0;
  std::size_t n = 0;
  for (const VolumetricCurve& curve : curves_of(""))
    for (std::size_t i = 1; curve.compression && i < curve.strain.size(); ++i, ++n) {
      before += std::pow(curve.share[i] - 1, 2);
      after += std::pow(curve.share[i] - std::exp(-fit.value("compression") * curve.strain[i]), 2);
    }
  EXPECT_EQ(n, fit.n);
  EXPECT_LT(std::sqrt(after / before), 0.5);  // one number leaves less than half of what no change would
}

TEST(VolumetricCampaign, TheTwoPackingsAgree) {
  const FitResult one = fit_volumetric(curves_of("4")).compression,
                  other = fit_volumetric(curves_of("5")).compression;
  const double error = std::hypot(*one["compression"].stderr_, *other["compression"].stderr_);
  EXPECT_NEAR(one.value("compression"), other.value("compression"), 3 * error);
}

/// F_dev of a test of the base campaign, relative L2 error, mean over seeds.
double error_of(const model::ParameterSet& set, const std::string& form, const std::string& name) {
  static const RecordFolder base = read_records(GRAINLAW_DATA_DIR "/records/base");
  double sum = 0;
  int n = 0;
  for (const TestRecord& test : base.tests) {
    if (test.test != name) continue;
    Path path = test.path;
    path.start.nu = test.nu_start;
    const model::Choice choice = model::choice_of(form);
    const model::PredictOptions options{.form = choice.form, .terms = choice.terms};
    const auto samples = model::samples_of(test.rows, path, test.nu_start);
    sum += relative_distance(model::predict(set, path, samples, options).record["F_dev"], test.rows["F_dev"]);
    ++n;
  }
  EXPECT_EQ(n, 3) << name;
  return sum / n;
}

/// The thesis's way over-predicts F_dev on UNI; with F_max of axisymmetric strain and the term of volume,
/// both from other tests, the error falls at every density (docs/model.md has the numbers).
TEST(VolumetricCampaign, PredictsFabricOnUniBetterThanTheThesis) {
  model::ParameterSet set = fit_records(GRAINLAW_DATA_DIR "/records/base", thesis).parameters;
  set.volumetric = fit_records(GRAINLAW_DATA_DIR "/records/volumetric", thesis).parameters.volumetric;
  ASSERT_TRUE(set.volumetric && set.shear_axial);
  for (const char* test : {"uni-0.671", "uni-0.695", "uni-0.728"}) {
    const double closed = error_of(set, "reduced_closed", test), coupled = error_of(set, "coupled", test);
    const double axial = error_of(set, "coupled+axial", test),
                 volumetric = error_of(set, "coupled+volumetric", test);
    const double both = error_of(set, "coupled+axial+volumetric", test);
    EXPECT_LT(both, 0.9 * closed) << test;
    EXPECT_LT(both, 0.6 * coupled) << test;
    EXPECT_LT(both, axial) << test;  // each has its part
    EXPECT_LT(both, volumetric) << test;
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
