// Eqs. 5.1 and 5.5 against their check numbers, their inverse and their rate, and the inversion of the
// pressure law.
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

/// Numbers of which Eq. 5.1 has others than exp(-1) at M = 1.
const OverCompression measured{0.65723, 1.6269, 0.38273, 0.019929, 0.39902};

TEST(JammingDensity, FirstCompressionToIsTheInverseOfOneCompression) {
  for (const OverCompression& o : {memory, measured}) {
    for (const double phi_max : {0.658, 0.68, 0.73, 0.82, 0.99})
      EXPECT_NEAR(first_compression_to(o, jamming_density_after(o, phi_max, 1)), phi_max, 1e-11);
    EXPECT_EQ(first_compression_to(o, o.phi_SJ), o.phi_SJ);
    EXPECT_EQ(first_compression_to(o, o.phi_SJ - 0.01), o.phi_SJ);
  }
}

TEST(JammingDensity, BeyondWhatHasLeftItGrowsAsFirstCompressionsDo) {
  for (const OverCompression& o : {memory, measured})
    for (const double nu : {0.67, 0.7, 0.82})
      for (const double behind : {0.0, 1e-4, 2e-3}) {  // of a packing that shear has brought down
        const double h = 1e-6, phi = jamming_density_after(o, nu, 1) - behind;
        const double slope =
            (jamming_density_after(o, nu * std::exp(h), 1) - jamming_density_after(o, nu * std::exp(-h), 1)) /
            (2 * h);
        EXPECT_NEAR(growth_by_compression(o, phi, nu, nu), slope, 1e-7 * slope) << nu;
      }
}

TEST(JammingDensity, BelowThatItGrowsAsWithinACycle) {
  // M counts up by 1 from phi to the largest density that is still part of the cycles.
  for (const OverCompression& o : {memory, measured})
    for (const auto& [phi_max, M] : {std::pair{0.73, 1.0}, {0.73, 1.7}, {0.73, 40.0}, {0.82, 3.0}}) {
      const double phi = jamming_density_after(o, phi_max, M), h = 1e-5 * M;
      const double by_M =
          (jamming_density_after(o, phi_max, M + h) - jamming_density_after(o, phi_max, M - h)) / (2 * h);
      const double expected = by_M / std::log(phi_max / phi);
      for (const double nu : {1.0021 * phi, 0.5 * (phi + 0.97 * phi_max)})
        EXPECT_NEAR(growth_by_compression(o, phi, nu, phi_max), expected, 1e-7 * expected) << M;
    }
  // One that has seen more than what leaves phi by one compression has been brought down: its cycle is that
  // of this compression.
  const double phi = jamming_density_after(memory, 0.70, 1);
  EXPECT_EQ(growth_by_compression(memory, phi, 0.67, 0.82), growth_by_compression(memory, phi, 0.67, 0.70));
}

TEST(JammingDensity, GrowthWhereThereIsNone) {
  const double phi = jamming_density_after(memory, 0.73, 1);
  for (const double nu : {0.64, std::nextafter(phi, 0.0), phi})
    EXPECT_EQ(growth_by_compression(memory, phi, nu, 0.73), 0) << "without contacts";
  EXPECT_EQ(growth_by_compression(memory, 0.6567, 0.7, 0.73), 0) << "from phi_SJ: an infinite slope";
  EXPECT_EQ(growth_by_compression(memory, jamming_density_limit(memory, 0.73), 0.69, 0.73), 0)
      << "as cycles for ever have left it";
}

TEST(JammingDensity, GrowthPassesWithoutAJump) {
  for (const OverCompression& o : {memory, measured})
    for (const double at : {0.69, 0.73, 0.82}) {
      const double phi = jamming_density_after(o, at, 1);
      const auto growth = [&](double nu) { return growth_by_compression(o, phi, nu, at); };
      const double from = at * std::exp(-0.02), whole = growth(at * 1.001) - growth(0.97 * at);
      for (const double edge : {from, at})
        EXPECT_NEAR(growth(edge * (1 + 1e-9)), growth(edge * (1 - 1e-9)), 1e-6 * growth(edge));
      double before = growth(from);
      for (int i = 1; i <= 200; ++i) {
        const double next = growth(from * std::exp(0.02 * i / 200));
        EXPECT_LE(std::abs(next - before), 0.02 * std::abs(whole)) << i;
        before = next;
      }
      // Where the blend begins and ends it has no corner.
      const double h = 1e-6, inside = (growth(from * (1 + h)) - growth(from)) / h,
                   outside = (growth(from) - growth(from * (1 - h))) / h;
      EXPECT_NEAR(inside, outside, 1e-2 * std::abs(whole) / 0.02);
    }
}

TEST(JammingDensity, DerivativesOfGrowth) {
  using D = Dual<1>;
  const double phi = jamming_density_after(measured, 0.73, 1);
  for (const double nu : {0.68, 0.725, 0.76}) {  // within a cycle, in between, beyond
    SCOPED_TRACE(nu);
    if (nu != 0.76)
      expect_v_shape([&](double x) { return growth_by_compression(measured, x, nu, 0.82); }, phi,
                     growth_by_compression(measured, D(phi, 0), D(nu), D(0.82)).slope[0], 0.02);
    if (nu != 0.68)
      expect_v_shape([&](double x) { return growth_by_compression(measured, phi, x, 0.82); }, nu,
                     growth_by_compression(measured, D(phi), D(nu, 0), D(0.82)).slope[0], 0.02);
    for (double OverCompression::*number :
         {&OverCompression::mu, &OverCompression::beta, &OverCompression::alpha_phi}) {
      const auto moved = [&](double x) {
        OverCompression o = measured;
        o.*number = x;
        return growth_by_compression(o, phi, nu, 0.82);
      };
      BasicOverCompression<D> o{measured.phi_SJ, measured.mu, measured.beta, measured.alpha_max,
                                measured.alpha_phi};
      if (number == &OverCompression::mu) o.mu.slope[0] = 1;
      if (number == &OverCompression::beta) o.beta.slope[0] = 1;
      if (number == &OverCompression::alpha_phi) o.alpha_phi.slope[0] = 1;
      expect_v_shape(moved, measured.*number, growth_by_compression(o, D(phi), D(nu), D(0.82)).slope[0],
                     1e-2 * measured.*number);
    }
  }
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
