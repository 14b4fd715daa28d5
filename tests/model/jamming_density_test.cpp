// Eqs. 5.1 and 5.5 against their check numbers, and the inversion of the pressure law.
#include "grainlaw/model/jamming_density.hpp"

#include <gtest/gtest.h>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

const OverCompression memory{0.6567, 1, 0.3, 0.02, 0.3};

TEST(JammingDensity, AfterOverCompression) {
  const double phi_max[] = {0.68, 0.73, 0.82};
  const double once[] = {0.66134, 0.66325, 0.66503}, hundred[] = {0.66391, 0.66687, 0.66963},
               forever[] = {0.66405, 0.66706, 0.66987};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(jamming_density_after(memory, phi_max[i], 1), once[i], 5e-6);
    EXPECT_NEAR(jamming_density_after(memory, phi_max[i], 100), hundred[i], 5e-6);
    EXPECT_NEAR(jamming_density_limit(memory, phi_max[i]), forever[i], 5e-6);
  }
}

TEST(JammingDensity, OneCompressionGoesTheSameShareOfTheWay) {
  // Eq. 5.6: phi_inf - phi_SJ = (phi_1 - phi_SJ)/(1 - 1/e).
  const double limit = jamming_density_limit(memory, 0.75), once = jamming_density_after(memory, 0.75, 1);
  EXPECT_NEAR((once - 0.6567) / (limit - 0.6567), 1 - std::exp(-1.0), 1e-12);
}

TEST(JammingDensity, WithoutOverCompressionItIsTheLowest) {
  EXPECT_EQ(jamming_density_after(memory, 0.65, 1), 0.6567);
  EXPECT_EQ(jamming_density_after(memory, 0.8, 0), 0.6567);
}

TEST(JammingDensity, FromPressure) {
  const PressureCurve law{{6, 8.2720, 0.5814, 0.6646, 0.1216, 15.8950}, 0.04172, 0.06228, 0.6649};
  for (const double phi_J : {0.6567, 0.6649, 0.6701})
    for (const double nu : {0.6702, 0.711, 0.82}) {
      const double P = pressure(with_jamming_density(law, phi_J), nu);
      EXPECT_NEAR(jamming_density_from_pressure(law, nu, P).value(), phi_J, 1e-12);
    }
  EXPECT_EQ(jamming_density_from_pressure(law, 0.66, 0), 0.66);
  EXPECT_FALSE(jamming_density_from_pressure(law, 0.7, 3.0).has_value());
}

}  // namespace
}  // namespace grainlaw::model
