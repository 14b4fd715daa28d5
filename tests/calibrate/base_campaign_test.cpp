// The records of the base campaign that stand in data/records: 9261 grains, three packings. Tables 2.1 and 2.2 of
// the thesis, refitted cell by cell.
#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/calibrate/fit_records.hpp"

namespace grainlaw::calibrate {
namespace {

const FitOutput& fitted() {
  static const FitOutput out =
      fit_records(GRAINLAW_DATA_DIR "/records/base", GRAINLAW_DATA_DIR "/thesis/parameters.json");
  return out;
}

/// The thesis has one packing, we have the mean of n = 3: their difference scatters by sqrt(1 + n) standard errors
/// of ours, and Student's t of two degrees of freedom exceeds 9.9 in one of a hundred cases.
void expect_near_thesis(const char* name, const model::Parameter& p) {
  ASSERT_TRUE(p.thesis && p.stderr_) << name;
  EXPECT_LT(std::abs(p.value - *p.thesis), 9.9 * 2 * *p.stderr_)
      << name << " " << p.value << " +- " << *p.stderr_ << ", thesis " << *p.thesis;
}

TEST(BaseCampaign, EveryCheckHolds) {
  const Json& checks = fitted().fits.at("checks");
  EXPECT_EQ(checks.size(), 5u);
  for (const Json& check : checks) EXPECT_EQ(check.at("holds"), true) << check.dump();
}

TEST(BaseCampaign, Table2_1WithinItsErrors) {
  for (const char* mode : {"iso", "d2"}) {
    SCOPED_TRACE(mode);
    const auto& row = fitted().parameters.isotropic.at(mode);
    expect_near_thesis("nu_c", row.nu_c);
    expect_near_thesis("p0", row.p0);
    expect_near_thesis("gamma_p", row.gamma_p);
    expect_near_thesis("C1", row.C1);
    expect_near_thesis("alpha", row.alpha);
    expect_near_thesis("nu_c_contacts", row.nu_c_contacts);
    expect_near_thesis("phi_c", row.phi_c);
    expect_near_thesis("phi_v", row.phi_v);
  }
}

TEST(BaseCampaign, Table2_2WithinItsErrors) {
  const model::ShearLaws& shear = *fitted().parameters.shear;
  expect_near_thesis("F_max Q_v", shear.F_max->Q_v);
  expect_near_thesis("F_max alpha", shear.F_max->alpha);
  expect_near_thesis("s_max Q_max", shear.s_max->Q_max);
  expect_near_thesis("s_max Q_v", shear.s_max->Q_v);
  expect_near_thesis("s_max alpha", shear.s_max->alpha);
  expect_near_thesis("beta_s Q_v", shear.beta_s->Q_v);
  expect_near_thesis("beta_F Q_v", shear.beta_F->Q_v);
}

}  // namespace
}  // namespace grainlaw::calibrate
