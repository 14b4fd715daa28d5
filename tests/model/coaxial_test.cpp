// The law between tensors: stress along the axis, permuted and rotated frames, shear components, notations,
// and what is refused.
#include "grainlaw/model/c/coaxial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coaxial_fixture.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

TEST(Coaxial, StressAlongTheAxis) {
  for (const Sym6& axis : {d2, uni, shear_xy, general}) {
    Host host(settings_of(axis));
    for (const Sym6& increment : path_along(axis)) {
      ASSERT_EQ(host.take(increment).code, Status::Code::ok);
      const State& s = host.state.point;
      EXPECT_NEAR(trace(host.stress) / 3, s.P, 1e-15);
      EXPECT_NEAR(signed_deviator(host.stress, strain_along(axis, 0, 1)), s.sigma_dev, 1e-15);
      EXPECT_TRUE(coaxial(host.stress, axis));
    }
    EXPECT_LT(host.state.point.sigma_dev, 0);
  }
}

TEST(Coaxial, WalksAsTheLawDoes) {
  for (const Form form : forms) {
    const CoaxialSettings settings = settings_of(uni, form);
    Host host(settings);
    const LightLaw light(make_law(thesis(), form), settings.tolerance);
    State alone = host.state.point;
    for (const auto& [v, e] : {std::pair{0.0, 0.01}, {0.01, 0.01}, {0.02, 0.0}, {0.0, -0.02}, {-0.1, 0.03}}) {
      host.take(strain_along(uni, v, e));
      ASSERT_FALSE(light.update(alone, v, e).failed());
    }
    EXPECT_NEAR(host.state.point.nu, alone.nu, 1e-14);
    EXPECT_NEAR(host.state.point.P, alone.P, 1e-9 * alone.P);
    EXPECT_NEAR(host.state.point.F_dev, alone.F_dev, 1e-9);
    EXPECT_FALSE(alone.jammed);
  }
  Host host(settings_of(uni));  // uniaxial: all of the strain is one number
  ASSERT_FALSE(host.take({0, 0, 0.01, 0, 0, 0}).failed());
  EXPECT_NEAR(host.state.point.eps_vol, 0.01, 1e-16);
  EXPECT_NEAR(host.state.point.eps_dev, 0.01, 1e-16);
}

/// Where xx, yy, zz, yz, xz, xy go when x, y, z become y, z, x.
constexpr std::array<std::size_t, 6> places{1, 2, 0, 4, 5, 3};
Sym6 permuted(const Sym6& q) {
  Sym6 result;
  for (std::size_t i = 0; i < 6; ++i) result[places[i]] = q[i];
  return result;
}

TEST(Coaxial, PermutedAxesPermuteStressAndTangent) {
  for (const Sym6& axis : {d2, uni, general}) {
    Host host(settings_of(axis)), other(settings_of(permuted(axis)));
    for (const Sym6& increment : path_along(axis)) {
      ASSERT_FALSE(host.take(increment).failed());
      ASSERT_FALSE(other.take(permuted(increment)).failed());
      expect_near(other.stress, permuted(host.stress), 1e-14);
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
          EXPECT_NEAR(other.tangent[6 * places[i] + places[j]], host.tangent[6 * i + j], 1e-10) << i << j;
    }
  }
}

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 full(const Sym6& q) { return {{{q[0], q[5], q[4]}, {q[5], q[1], q[3]}, {q[4], q[3], q[2]}}}; }
Sym6 rotated(const Matrix3& R, const Sym6& q) {
  const Matrix3 Q = full(q);
  const auto at = [&](std::size_t i, std::size_t j) {
    double value = 0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l) value += R[i][k] * Q[k][l] * R[j][l];
    return value;
  };
  return {at(0, 0), at(1, 1), at(2, 2), at(1, 2), at(0, 2), at(0, 1)};
}
/// About z, then about x.
Matrix3 rotation(double a, double b) {
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
  return {{{ca, -sa, 0}, {cb * sa, cb * ca, -sb}, {sb * sa, sb * ca, cb}}};
}

TEST(Coaxial, ARotatedFrameRotatesStressAndTangent) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  const Matrix3 R = rotation(0.7, -1.1);
  for (const Sym6& axis : {d2, uni, shear_xy}) {
    Host host(settings_of(axis)), other(settings_of(rotated(R, axis)));
    for (const Sym6& increment : path_along(axis)) {
      ASSERT_FALSE(host.take(increment).failed());
      ASSERT_FALSE(other.take(rotated(R, increment)).failed());
      expect_near(other.stress, rotated(R, host.stress), 1e-13);
      const Sym6 x{any(random), any(random), any(random), any(random), any(random), any(random)};
      expect_near(product(other.tangent, rotated(R, x)), rotated(R, product(host.tangent, x)), 1e-10);
    }
  }
}

TEST(Coaxial, SimpleShear) {
  Host host(settings_of(shear_xy));
  ASSERT_FALSE(host.take({}).failed());
  const double K = isotropic_shear_stiffness(make_law(thesis(), Form::coupled), host.state.point);
  // From an isotropic state every shear is elastic: d sigma_xy = G_oct d eps_xy = 2 mu d eps_xy.
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(host.tangent[7 * i], K, 1e-14);
  ASSERT_FALSE(host.take({0, 0, 0, 0, 0, 1e-3}).failed());
  const State& s = host.state.point;
  EXPECT_NEAR(s.eps_dev, std::sqrt(3) * 1e-3, 1e-17);
  EXPECT_NEAR(host.stress[5], s.sigma_dev / std::sqrt(3), 1e-16);
  EXPECT_NEAR(host.stress[0], s.P, 1e-16);
  EXPECT_EQ(host.stress[3], 0);
}

TEST(Coaxial, AnotherAxisIsRefused) {
  Host host(settings_of(d2));
  ASSERT_FALSE(host.take(strain_along(d2, 0, 0.01)).failed());
  const Host before = host;
  for (const Sym6& increment :
       {strain_along(uni, 0, 1e-4), shear_xy, Sym6{-1e-4, 1e-4, 0, 0, 0, 1e-11}, Sym6{0, 0, 1e-4, 0, 0, 0}}) {
    const Status status = host.take(increment);
    EXPECT_EQ(status.code, Status::Code::not_coaxial);
    EXPECT_TRUE(status.failed());
    EXPECT_THAT(status.message, HasSubstr("is not coaxial with the axis"));
    EXPECT_EQ(host.state.point.P, before.state.point.P);
    EXPECT_EQ(host.state.point.eps_dev, before.state.point.eps_dev);
    EXPECT_EQ(host.stress, before.stress);
    EXPECT_EQ(host.tangent, before.tangent);
  }
}

TEST(Coaxial, RoundingIsNoOtherAxis) {
  Host host(settings_of(d2));
  EXPECT_FALSE(host.take({-1e-4, 1e-4, 0, 0, 0, 1e-13}).failed());
  EXPECT_FALSE(host.take({1e-4, 1e-4, 1e-4 * (1 + 1e-15), 0, 1e-19, 0}).failed());
  EXPECT_EQ(host.state.point.direction.q, 0);  // isotropic, and no reversal
  EXPECT_FALSE(host.take({}).failed());
  CoaxialSettings settings = settings_of(d2);
  settings.coaxial_tolerance = 1;
  Host projecting(settings);
  ASSERT_FALSE(projecting.take({-1e-3, 2e-3, 0, 0, 0, 1e-2}).failed());
  EXPECT_NEAR(projecting.state.point.eps_dev, 1.5 * std::sqrt(3) * 1e-3, 1e-17);
}

TEST(Coaxial, Notations) {
  CoaxialSettings settings = settings_of(general);
  Host host(settings);
  settings.notation = {.tension_positive = true, .engineering_shear = true};
  Host other(settings);
  const auto written = [](const Sym6& e) {
    return Sym6{-e[0], -e[1], -e[2], -2 * e[3], -2 * e[4], -2 * e[5]};
  };
  for (const Sym6& increment : path_along(general)) {
    ASSERT_FALSE(host.take(increment).failed());
    ASSERT_FALSE(other.take(written(increment)).failed());
    expect_near(other.stress, times(-1, host.stress), 1e-15);
    EXPECT_NEAR(other.state.point.sigma_dev, host.state.point.sigma_dev, 1e-15);
    for (std::size_t i = 0; i < 36; ++i)
      EXPECT_NEAR(other.tangent[i], (i % 6 < 3 ? 1 : 0.5) * host.tangent[i], 1e-12) << i;
  }
}

TEST(Coaxial, EachPointHasTheLawsOfItsHistory) {
  Host host(settings_of(d2));
  const CoaxialState dense = host.law.start(Start{0.711, {}, {}, {}, 0.65, {}}).state;
  EXPECT_EQ(dense.phi_J_laws, 0.65);
  EXPECT_GT(dense.point.P, 1.2 * host.state.point.P);
  Law moved = make_law(thesis(), Form::coupled);
  laws_of(moved) = with_jamming_density(laws_of(moved), 0.65);
  const LightLaw light(moved, host.law.settings().tolerance);
  CoaxialState one = host.state, two = dense;
  State alone = dense.point;
  for (int i = 0; i < 20; ++i) {  // in turn, by one workspace
    const Sym6 increment = strain_along(d2, 1e-4, 1e-3);
    ASSERT_FALSE(host.law.update(one, increment, host.workspace, host.stress, nullptr).failed());
    ASSERT_FALSE(host.law.update(two, increment, host.workspace, host.stress, nullptr).failed());
    ASSERT_FALSE(light.update(alone, 1e-4, 1e-3).failed());
    ASSERT_FALSE(host.take(increment).failed());
  }
  EXPECT_NEAR(two.point.P, alone.P, 1e-12);
  EXPECT_NEAR(two.point.sigma_dev, alone.sigma_dev, 1e-12);
  EXPECT_NEAR(one.point.sigma_dev, host.state.point.sigma_dev, 1e-9);
}

TEST(Coaxial, Unjammed) {
  Host host(settings_of(d2));
  const Status status = host.take(strain_along(d2, -0.2, 0.01));
  EXPECT_EQ(status.code, Status::Code::unjammed);
  EXPECT_FALSE(status.failed());
  EXPECT_EQ(host.stress, Sym6{});
  EXPECT_EQ(host.tangent, Matrix6{});
  EXPECT_EQ(host.take(strain_along(d2, 0.25, 0.01)).code, Status::Code::ok);
  EXPECT_GT(host.stress[1], host.stress[0]);
}

TEST(Coaxial, RefusesSettingsThatMeanNothing) {
  const auto said = [](const Sym6& axis, double tolerance, Tolerance errors = {}) {
    CoaxialSettings settings = settings_of(axis);
    settings.coaxial_tolerance = tolerance;
    settings.tolerance = errors;
    return refusal([&] { CoaxialLaw(thesis(), settings); });
  };
  EXPECT_THAT(said({}, 0), HasSubstr("axis: must have a deviator"));
  EXPECT_THAT(said({2, 2, 2, 0, 0, 0}, 0), HasSubstr("axis: must have a deviator"));
  EXPECT_THAT(said({NAN, 0, 0, 0, 0, 0}, 0), HasSubstr("axis: must have finite components"));
  EXPECT_THAT(said(d2, 1.5), HasSubstr("coaxial_tolerance: must be >= 0 and <= 1, got 1.5"));
  EXPECT_THAT(said(d2, NAN), HasSubstr("coaxial_tolerance"));
  EXPECT_THAT(said(d2, 0, {0, 1}), HasSubstr("rtol: must be > 0"));
  Host host(settings_of(d2));
  EXPECT_THAT(refusal([&] {
                host.take({0, 0, 0, NAN, 0, 0});
              }),
              HasSubstr("strain_increment[3]: must be finite"));
  EXPECT_THAT(refusal([&] { host.take({1e308, 1e308, 0, 0, 0, 0}); }), HasSubstr("is too large"));
}

}  // namespace
}  // namespace grainlaw::model
