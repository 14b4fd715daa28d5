// The records that stand in data/records/moduli: moduli measured by calibrate itself, of 1000 grains.
#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/calibrate/fit_records.hpp"

namespace grainlaw::calibrate {
namespace {

const FitOutput& fitted() {
  static const FitOutput out =
      fit_records(GRAINLAW_DATA_DIR "/records/moduli", GRAINLAW_DATA_DIR "/thesis/parameters.json");
  return out;
}

TEST(ModuliCampaign, NoModulusComesFromTheThesis) {
  const Json moduli = fitted().parameters.to_json().at("moduli");
  for (const auto& [name, parameter] : moduli.items()) {
    EXPECT_NE(parameter.at("source"), "thesis") << name;
    if (parameter.at("source") == "assumed") {
      EXPECT_TRUE(parameter.contains("note")) << name;
    }
    if (parameter.at("source") == "fit") {
      EXPECT_TRUE(parameter.at("stderr").is_number()) << name;
    }
  }
}

/// 3/2 without prestress, and more with it.
TEST(ModuliCampaign, PrestressSetsA2OverA1) {
  const model::ModuliLaws& m = *fitted().parameters.moduli;
  EXPECT_EQ(m.a_I.source, "fit");
  EXPECT_GT(m.a_II.value / m.a_I.value, 1.5);
}

/// Student's t of two degrees of freedom exceeds 9.9 in one of a hundred cases.
TEST(ModuliCampaign, BulkModulusIsThatOf9261Grains) {
  const model::Parameter& p0 = fitted().parameters.moduli->p0;
  EXPECT_LT(std::abs(p0.value - 0.0412), 9.9 * *p0.stderr_) << p0.value << " +- " << *p0.stderr_;
}

}  // namespace
}  // namespace grainlaw::calibrate
