// Eq. 2.20 against Table 2.2 and Fig. 4.14; Eqs. 2.17, 2.18 against their rate forms.
#include "grainlaw/model/laws/saturation.hpp"

#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

// Table 2.2: Q_max, Q_v, alpha; nu_c = 0.6653.
const Saturation s_max{0.1137, 0.09166, 7.916, 0.6653};
const Saturation beta_s{30.76, 57.00, 16.86, 0.6653};
const Saturation F_max{0, 0.1694, 4.562, 0.6653};
const Saturation beta_F{0, 57.89, 5.366, 0.6653};

TEST(Saturation, ValuesOverVolumeFraction) {
  const double nu[] = {0.671, 0.695, 0.711, 0.728, 0.75};
  const double s[] = {0.19935, 0.17807, 0.16691, 0.15717, 0.14716};
  const double bs[] = {80.093, 57.613, 48.662, 42.396, 37.423};
  const double F[] = {0.16291, 0.13819, 0.12383, 0.11020, 0.09477};
  const double bF[] = {55.289, 45.559, 40.043, 34.912, 29.236};
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(saturation(s_max, nu[i]), s[i], 5e-6);
    EXPECT_NEAR(saturation(beta_s, nu[i]), bs[i], 5e-4);
    EXPECT_NEAR(saturation(F_max, nu[i]), F[i], 6e-6);
    EXPECT_NEAR(saturation(beta_F, nu[i]), bF[i], 5e-4);
  }
}

TEST(Saturation, AgreesWithTheCaptionOfFigure4_14) {
  EXPECT_NEAR(saturation(s_max, 0.711), 0.167, 5e-4);
  EXPECT_NEAR(saturation(F_max, 0.711), 0.124, 5e-4);
  EXPECT_NEAR(saturation(beta_F, 0.711), 40.04, 5e-3);
}

TEST(Saturation, Slope) {
  for (const Saturation& q : {s_max, beta_s, F_max, beta_F})
    expect_v_shape([&](double nu) { return saturation(q, nu); }, 0.7, saturation_slope(q, 0.7), 0.1);
}

TEST(Saturation, ClosedFormStartsAtItsStartAndEndsAtSaturation) {
  EXPECT_EQ(approach(0.167, 0.03, 40, 0), 0.03);
  EXPECT_NEAR(approach(0.167, 0.03, 40, 0.1), 0.167 - (0.167 - 0.03) * std::exp(-4.0), 1e-16);
  EXPECT_DOUBLE_EQ(approach(0.167, 0.03, 40, 10), 0.167);
  EXPECT_DOUBLE_EQ(approach(-0.167, 0.167, 40, 10), -0.167);  // after a reversal
}

TEST(Saturation, RateFormIsTheDerivativeOfTheClosedForm) {
  for (const double e : {0.0, 0.02, 0.1}) {
    const double x = approach(-0.12, 0.1, 40, e);
    expect_v_shape([](double strain) { return approach(-0.12, 0.1, 40, strain); }, e,
                   approach_rate(-0.12, x, 40), 0.05);
  }
}

}  // namespace
}  // namespace grainlaw::model
