// Eqs. 5.2, 5.3 and 5.13 against numbers worked out by hand from the thesis's parameters, and against each
// other.
#include "grainlaw/model/laws/shear_jamming.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw::model {
namespace {

const ShearMemory<> thesis{0.6567, 1.37, 0.102};
constexpr double phi_J0 = 0.6652;

TEST(ShearJamming, StrainsOfTheThesisExample) {
  // ln[(0.6652 - 0.6567)/(phi - 0.6567)] to the power 1/1.37, times 0.102, by calculator.
  EXPECT_NEAR(shear_jamming_strain(thesis, phi_J0, 0.6584), 0.1444, 5e-5);
  EXPECT_NEAR(shear_jamming_strain(thesis, phi_J0, 0.6593), 0.1154, 5e-5);
  EXPECT_NEAR(shear_jamming_strain(thesis, phi_J0, 0.66), 0.0980, 5e-5);
}

TEST(ShearJamming, OutsideTheSegmentItJamsAtOnceOrNever) {
  EXPECT_EQ(shear_jamming_strain(thesis, phi_J0, phi_J0), 0);
  EXPECT_EQ(shear_jamming_strain(thesis, phi_J0, 0.7), 0);
  EXPECT_TRUE(std::isinf(shear_jamming_strain(thesis, phi_J0, thesis.phi_SJ)));
  EXPECT_TRUE(std::isinf(shear_jamming_strain(thesis, phi_J0, 0.65)));
}

TEST(ShearJamming, DensityFallsFromTheInitialOneToTheLimit) {
  EXPECT_EQ(sheared_jamming_density(thesis, phi_J0, 0.0), phi_J0);
  EXPECT_NEAR(sheared_jamming_density(thesis, phi_J0, 0.102), 0.6567 + 0.0085 * std::exp(-1.0), 1e-15);
  EXPECT_NEAR(sheared_jamming_density(thesis, phi_J0, 10.0), thesis.phi_SJ, 1e-15);
}

TEST(ShearJamming, TheStrainIsWhereTheDensityMeetsPhi) {
  for (const double phi : {0.6568, 0.658, 0.661, 0.6651}) {
    const double strain = shear_jamming_strain(thesis, phi_J0, phi);
    // pow and its inverse, each to rounding, amplified by the slope of ln near phi_SJ.
    EXPECT_NEAR(sheared_jamming_density(thesis, phi_J0, strain), phi, 1e-14) << phi;
  }
}

TEST(ShearJamming, TheShearedDensityDoesNotNeedPhiBelowTheInitialOne) {
  EXPECT_LT(sheared_jamming_density(thesis, 0.66, 0.05), 0.66);
  EXPECT_EQ(sheared_jamming_density(thesis, thesis.phi_SJ, 0.05), thesis.phi_SJ);
}

}  // namespace
}  // namespace grainlaw::model
