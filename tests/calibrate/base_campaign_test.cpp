// The records of the base campaign that stand in data/records: 9261 grains, three packings. Tables 2.1
// and 2.2 of the thesis, refitted cell by cell.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grainlaw/calibrate/fit_records.hpp"

namespace grainlaw::calibrate {
namespace {

const FitOutput& fitted() {
  static const FitOutput out =
      fit_records(GRAINLAW_DATA_DIR "/records/base", GRAINLAW_DATA_DIR "/thesis/parameters.json");
  return out;
}

/// Compares every parameter of this fit that it determined; returns how many. The thesis has one packing, we
/// have the mean of n = 3: their difference scatters by sqrt(1 + n) standard errors of ours, and Student's t
/// of two degrees of freedom exceeds 9.9 in one of a hundred cases.
int compare_with_thesis(const std::string& name) {
  int compared = 0;
  for (const Json& fit : fitted().fits.at("fits")) {
    if (fit.at("name") != name) continue;
    for (const Json& p : fit.at("parameters")) {
      if (p.at("held") == true || p.at("thesis").is_null()) continue;
      EXPECT_EQ(p.at("determined"), true) << name << " " << p.dump();
      EXPECT_LT(std::abs(p.at("value").get<double>() - p.at("thesis").get<double>()),
                9.9 * 2 * p.at("stderr").get<double>())
          << name << " " << p.dump();
      ++compared;
    }
  }
  return compared;
}

TEST(BaseCampaign, EveryCheckHolds) {
  const Json& checks = fitted().fits.at("checks");
  EXPECT_EQ(checks.size(), 5u);
  for (const Json& check : checks) EXPECT_EQ(check.at("holds"), true) << check.dump();
}

TEST(BaseCampaign, Table2_1CellByCell) {
  for (const std::string mode : {"iso", "uni", "d2", "d3"}) {
    EXPECT_EQ(compare_with_thesis("isotropic." + mode + ".C_star"), 3) << mode;
    EXPECT_EQ(compare_with_thesis("isotropic." + mode + ".phi_r"), 2) << mode;
    EXPECT_EQ(compare_with_thesis("isotropic." + mode + ".P"), 3) << mode;
  }
}

TEST(BaseCampaign, Table2_2CellByCell) {
  EXPECT_EQ(compare_with_thesis("shear.s_max"), 3);
  EXPECT_EQ(compare_with_thesis("shear.beta_s"), 3);
  EXPECT_EQ(compare_with_thesis("shear.F_max"), 2);
  EXPECT_EQ(compare_with_thesis("shear.beta_F"), 2);
}

}  // namespace
}  // namespace grainlaw::calibrate
