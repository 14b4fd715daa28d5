// A1 and A2 from one energy in place of Eqs. 4.12 and 4.13: an independent integration, symmetry, Jacobian.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/model/forms/law.hpp"
#include "walks.hpp"
#include "written.hpp"

namespace grainlaw::model {
namespace {

constexpr double a_F = 3.6, a_s = 0.15;

ParameterSet with_energy() {
  ParameterSet set = thesis();
  set.moduli->a_F.emplace().value = a_F;
  set.moduli->a_s.emplace().value = a_s;
  return set;
}

/// Eq. 4.16 with A1 and A2 of the energy.
struct WrittenEnergy : Written {
  void operator()(const Vector& y, Vector& dy, double t) const {
    const double n = nu(t), B = bulk(n), B0 = B - 2 * y[0] / 3;
    const double A = B0 * (a_F * y[2] / fabric(n) + a_s * y[1] / y[0]);
    const double S = (1 - q() * y[1] / y[0] / s_max(n)) / S_I;
    const double S_F = (1 - q() * y[2] / F_max(n)) / S_F_I;
    dy[0] = B * v + (A - 2 * y[1] / 9) * S * e;
    dy[1] = (3 * A / 2 + 2 * y[1] / 3) * v + B * shear_ratio(n, y[1], y[2]) * S * e;
    dy[2] = beta_F(n) * q() * F_max(n) * S_F * std::abs(e);
  }
};

TEST(Energy, AgainstAnIndependentIntegrationOfUniaxialLoadingAndUnloading) {
  const Prediction p =
      walk(R"({"start": {"nu": 0.69, "P": 0.012, "sigma_dev": -0.001, "F_dev": 0.03}, "segments": [
      {"mode": "uni", "amount": 0.12}, {"mode": "uni", "amount": -0.08}]})",
           choice_of("coupled+energy"), 20, with_energy());
  expect_agreement<WrittenEnergy>(0.69, {0.012, -0.001, 0.03}, {{0.12, 0.12}, {-0.08, -0.08}}, p, 20);
}

TEST(Energy, VolumeChangesStressWithoutShearToo) {
  const Prediction p = walk(R"({"start": {"nu": 0.7, "P": 0.02, "sigma_dev": 0.002, "F_dev": 0.1},
      "segments": [{"mode": "iso", "amount": 0.1}]})",
                            choice_of("coupled+energy"), 20, with_energy());
  expect_agreement<WrittenEnergy>(0.7, {0.02, 0.002, 0.1}, {{0.1, 0}}, p, 20);
}

/// With the prestress out the second derivative of the energy is symmetric: A2 = (3/2) A1.
TEST(Energy, IsSymmetricWithoutPrestress) {
  const Moduli m = laws_of(with_energy(), choice_of("coupled+energy")).moduli;
  const double P = 0.03, sigma = 0.004;
  const auto [A1, A2] = anisotropy_moduli_of_energy(m, 0.5, 7.0, P, sigma, 0.1);
  EXPECT_DOUBLE_EQ(A2 - 2 * sigma / 3, 1.5 * (A1 + 2 * sigma / 9));
  EXPECT_DOUBLE_EQ(A1 + 2 * sigma / 9, (0.5 - 2 * P / 3) * (a_F * 0.1 / 7 + a_s * sigma / P));
}

TEST(Energy, Jacobian) {
  const Coupled law{laws_of(with_energy(), choice_of("coupled+energy"))};
  const Stretch stretch{0.7, 0.1, -0.3};
  const Direction direction{.q = -1, .S_I = 1.7, .S_F_I = 1.9};
  const std::array<double, 3> y{0.02, 0.0012, 0.07}, size{0.01, 0.001, 0.05};
  std::array<double, 9> J{};
  ASSERT_TRUE(jacobian_of(law, stretch, direction, 0.4, y.data(), J.data()));
  for (std::size_t j = 0; j < 2; ++j)  // stress by stress; F_dev enters as before
    for (std::size_t i = 0; i < 2; ++i) {
      const auto f = rate_by(law, stretch, direction, 0.4, y, i, j);
      expect_v_shape(f, y[j], J[i + 3 * j], size[j]);
    }
}

TEST(Energy, WithoutPressureTheRateIsNotDefined) {
  const Coupled law{laws_of(with_energy(), choice_of("coupled+energy"))};
  const std::array<double, 3> y{0, 0.0012, 0.07};
  std::array<double, 3> dy{};
  EXPECT_FALSE(rate_at(law, Stretch{0.7, -0.1, 0}, Direction{}, 0.4, y.data(), dy.data()));
}

TEST(Energy, IsChosenByNameAndNeedsItsNumbers) {
  EXPECT_EQ(name_of(choice_of("coupled+energy")), "coupled+energy");
  EXPECT_FALSE(choice_of("coupled").terms.energy);
  EXPECT_EQ(refusal([] { choice_of("coupled+enrgy"); }),
            "form: coupled takes the terms axial, energy, volumetric, constant_F_v, moduli_table, got "
            "\"coupled+enrgy\"");
  EXPECT_EQ(refusal([] { choice_of("reduced_closed+energy"); }),
            "form: reduced_closed takes the terms axial, got \"reduced_closed+energy\"");
  EXPECT_THAT(refusal([] { laws_of(thesis(), choice_of("coupled+energy")); }),
              testing::HasSubstr("moduli.a_F: is missing; the coupled+energy form needs it"));
}

}  // namespace
}  // namespace grainlaw::model
