// The deviatoric fabric under change of volume: its closed form without shear, an independent integration,
// and that it is off unless asked for.
#include "grainlaw/model/laws/volumetric.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/model/forms/law.hpp"
#include "walks.hpp"
#include "written.hpp"

namespace grainlaw::model {
namespace {

constexpr double k_up = 6, k_down = -2;

ParameterSet with_volumetric() {
  ParameterSet set = thesis();
  set.volumetric.emplace();
  set.volumetric->compression.value = k_up;
  set.volumetric->decompression.value = k_down;
  return set;
}

/// Eq. 4.16 with the term.
struct WrittenVolumetric : Written {
  void operator()(const Vector& y, Vector& dy, double t) const {
    Written::operator()(y, dy, t);
    dy[2] -= (v > 0 ? k_up : k_down) * y[2] * v;
  }
};

constexpr const char* there_and_back =
    R"({"start": {"nu": 0.69, "P": 0.012, "sigma_dev": -0.001, "F_dev": 0.03}, "segments": [
    {"mode": "uni", "amount": 0.12}, {"mode": "uni", "amount": -0.08}]})";

TEST(Volumetric, AgainstAnIndependentIntegration) {
  const Prediction p = walk(there_and_back, choice_of("coupled+volumetric"), 20, with_volumetric());
  expect_agreement<WrittenVolumetric>(0.69, {0.012, -0.001, 0.03}, {{0.12, 0.12}, {-0.08, -0.08}}, p, 20);
}

/// F_dev = F_dev,0 (nu/nu_0)^-k, whatever the stress does.
TEST(Volumetric, WithoutShearFabricIsAPowerOfVolume) {
  for (const char* form : {"coupled+volumetric", "reduced+volumetric"}) {
    const Prediction p = walk(R"({"start": {"nu": 0.7, "F_dev": -0.1}, "segments": [
        {"mode": "iso", "amount": 0.1}, {"mode": "iso", "amount": -0.05}]})",
                              choice_of(form), 10, with_volumetric());
    for (std::size_t i = 0; i <= 10; ++i)
      EXPECT_NEAR(p.record["F_dev"][i], -0.1 * std::exp(-k_up * p.record["eps_vol"][i]), 1e-10) << form;
    EXPECT_NEAR(last(p, "F_dev"), -0.1 * std::exp(-k_up * 0.1 + k_down * 0.05), 1e-10) << form;
  }
}

TEST(Volumetric, IsOffUnlessAskedFor) {
  const Prediction off = walk(there_and_back, Form::coupled),
                   on = walk(there_and_back, Form::coupled, 20, with_volumetric());
  for (const char* column : {"P", "sigma_dev", "F_dev"}) EXPECT_EQ(difference(off, on, column), 0) << column;
}

TEST(Volumetric, DoesNothingAtConstantVolume) {
  const char* path = R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.2}]})";
  const Prediction off = walk(path, Form::reduced),
                   on = walk(path, choice_of("reduced+volumetric"), 20, with_volumetric());
  EXPECT_EQ(difference(off, on, "F_dev"), 0);
}

TEST(Volumetric, TermsGoTogetherInAnyOrderAndNeedTheirNumbers) {
  EXPECT_EQ(name_of(choice_of("coupled+volumetric+energy")), "coupled+energy+volumetric");
  EXPECT_THAT(refusal([] { choice_of("reduced_closed+volumetric"); }),
              testing::HasSubstr("reduced_closed takes the terms axial"));
  EXPECT_THAT(refusal([] { laws_of(thesis(), choice_of("reduced+volumetric")); }),
              testing::HasSubstr("volumetric: is missing; the reduced+volumetric form needs it"));
}

/// Rows of group shear_axial stand in for those of shear, all four of them.
TEST(Axial, TakesTheRowsOfAxisymmetricStrain) {
  ParameterSet set = thesis();
  set.shear_axial = set.shear;
  for (auto* row :
       {&set.shear_axial->s_max, &set.shear_axial->beta_s, &set.shear_axial->F_max, &set.shear_axial->beta_F})
    for (Parameter* p : {&(*row)->Q_max, &(*row)->Q_v}) p->value *= 0.9;
  const Laws d2 = laws_of(set, Form::reduced), axial = laws_of(set, choice_of("reduced+axial"));
  for (const auto quantity : {&Laws::s_max, &Laws::beta_s, &Laws::F_max, &Laws::beta_F})
    EXPECT_DOUBLE_EQ(saturation(axial.*quantity, 0.72), 0.9 * saturation(d2.*quantity, 0.72));
  EXPECT_THAT(refusal([] { laws_of(thesis(), choice_of("coupled+axial")); }),
              testing::HasSubstr("shear_axial: is missing; the coupled+axial form needs it"));
  set.shear_axial->F_max.reset();
  EXPECT_THAT(refusal([&] { laws_of(set, choice_of("coupled+axial")); }),
              testing::HasSubstr("shear_axial.F_max: is missing"));
}

}  // namespace
}  // namespace grainlaw::model
