// Eqs. 5.1 and 5.5 against their check numbers, and the inversion of the pressure law.
#include "grainlaw/model/laws/jamming_density.hpp"

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

TEST(JammingDensity, OfAParameterSetsOwnPressureIsItsOwn) {
  const PressureCurve d2{{6, 7.9219, 0.5769, 0.6601, 0.1363, 15.0010}, 0.03886, 0.03219, 0.6581};
  for (const double nu : {0.6582, 0.6595, 0.6601, 0.6605, 0.711})
    EXPECT_NEAR(jamming_density_from_pressure(d2, nu, pressure(d2, nu)).value(), 0.6581, 1e-12) << nu;
}

TEST(JammingDensity, FromPressureUpToTheMaximumOfTheLaw) {
  // Above gamma_p = 0.5 P* has a maximum at ln(nu/phi_J) between 1/(2 gamma_p) and 1/gamma_p.
  for (const double gamma_p : {0.6, 1.0, 2.0, 5.0}) {
    SCOPED_TRACE(gamma_p);
    const PressureCurve law{{6, 8.2720, 0.5814, 0.6646, 0.1216, 15.8950}, 0.04172, gamma_p, 0.6649};
    const auto P_at = [&](double e) { return pressure(law, 0.6649 * std::exp(e)); };
    double most = 0, e_most = 0;
    for (double e = 0; e < std::min(1.0, 1 / gamma_p); e += 1e-4)
      if (P_at(e) > most) most = P_at(e), e_most = e;
    EXPECT_GE(e_most, std::min(0.999, 1 / (2 * gamma_p)));
    EXPECT_NEAR(range_of_inversion(law), e_most, 2e-4);
    for (const double part : {0.01, 0.5, 0.9, 0.99}) {
      const double e = part * e_most;
      EXPECT_NEAR(jamming_density_from_pressure(law, 0.75, P_at(e)).value(), 0.75 * std::exp(-e), 1e-9) << e;
    }
    EXPECT_FALSE(jamming_density_from_pressure(law, 0.75, 1.001 * most).has_value());
  }
}

}  // namespace
}  // namespace grainlaw::model
