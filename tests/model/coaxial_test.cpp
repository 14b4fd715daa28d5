// The law between tensors: stress along the axis, permuted and rotated frames, shear components, notations,
// and the tangent against differences.
#include "grainlaw/model/coaxial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "checks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr Sym6 d2{-1, 1, 0, 0, 0, 0}, uni{-0.5, -0.5, 1, 0, 0, 0}, shear_xy{0, 0, 0, 0, 0, 1},
    general{0.3, -1, 0.2, 0.5, -0.4, 0.8};
constexpr std::array forms{Form::reduced_closed, Form::reduced, Form::coupled, Form::coupled_3_14};

CoaxialSettings settings_of(const Sym6& axis, Form form = Form::coupled) {
  CoaxialSettings settings;
  settings.choice.form = form;
  settings.tolerance = {1e-10, 1e-14};
  settings.axis = axis;
  return settings;
}

Sym6 times(double a, const Sym6& x) {
  Sym6 result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = a * x[i];
  return result;
}
Sym6 sum(const Sym6& x, const Sym6& y) {
  Sym6 result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = x[i] + y[i];
  return result;
}
/// So much strain along the deviator of an axis, and so much of volume.
Sym6 strain_along(const Sym6& axis, double eps_vol, double eps_dev) {
  const double mean = trace(axis) / 3;
  Sym6 deviator = axis;
  for (std::size_t i = 0; i < 3; ++i) deviator[i] -= mean;
  return sum(times(eps_vol / 3, {1, 1, 1, 0, 0, 0}), times(eps_dev / deviator_magnitude(deviator), deviator));
}
Sym6 product(const Matrix6& matrix, const Sym6& x) {
  Sym6 result{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) result[i] += matrix[6 * i + j] * x[j];
  return result;
}
void expect_near(const Sym6& a, const Sym6& b, double tolerance) {
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

/// A point with its law, from nu = 0.711.
struct Host {
  CoaxialLaw law;
  CoaxialState state;
  CoaxialLaw::Workspace workspace;
  Sym6 stress{};
  Matrix6 tangent{};

  explicit Host(const CoaxialSettings& settings)
      : law(thesis(), settings), state(law.start(Start{0.711, {}, {}, {}, {}, {}}).state) {}
  Status take(const Sym6& increment) { return law.update(state, increment, workspace, stress, &tangent); }
};

/// A path that reverses, compresses and releases, along an axis.
std::vector<Sym6> path_along(const Sym6& axis) {
  std::vector<Sym6> path;
  for (const auto& [v, e] :
       {std::pair{0.0, 0.004}, {0.0, 0.01}, {0.001, 0.002}, {0.0, -0.003}, {-0.002, 0.0}, {0.001, -0.02}})
    path.push_back(strain_along(axis, v, e));
  return path;
}

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

/// Every number of the tangent along `direction` against the forward difference of the stress.
void expect_slopes(const Host& begin, const Sym6& increment, const Sym6& direction, double size) {
  Host host = begin;
  ASSERT_FALSE(host.take(increment).failed());
  const Sym6 slopes = product(host.tangent, direction);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto f = [&](double x) {
      Host moved = begin;
      EXPECT_FALSE(moved.take(sum(increment, times(x, direction))).failed());
      return moved.stress[i];
    };
    if (std::abs(slopes[i]) > 1e-12)
      expect_v_shape(f, 0, slopes[i], size);
    else
      EXPECT_NEAR(f(size), f(0), 1e-12);
  }
}

TEST(Coaxial, TangentIsTheSlopeAlongTheAxisAndOfVolume) {
  for (const Form form : {Form::reduced, Form::coupled})
    for (const Sym6& axis : {d2, general}) {
      SCOPED_TRACE(name_of(form));
      CoaxialSettings settings = settings_of(axis, form);
      settings.tolerance = {1e-6, 1e-9};  // one step: what the tangent differentiates
      Host host(settings);
      for (const Sym6& increment : path_along(axis)) {
        if (deviator_magnitude(increment) > 1e-6) {  // at 0 shear begins either way
          expect_slopes(host, increment, strain_along(axis, 1, 0), 1e-3);
          expect_slopes(host, increment, strain_along(axis, 0, 1), 1e-3);
          expect_slopes(host, increment, strain_along(axis, 1, -0.5), 1e-3);
        }
        ASSERT_FALSE(host.take(increment).failed());
      }
    }
}

TEST(Coaxial, TheProjectedTangentIsTheSlopeInEveryDirection) {
  for (const bool engineering : {false, true}) {
    CoaxialSettings settings = settings_of(general);
    settings.tolerance = {1e-6, 1e-9};
    settings.coaxial_tolerance = 1;
    settings.projected_tangent = true;
    settings.notation.engineering_shear = engineering;
    Host host(settings);
    ASSERT_FALSE(host.take({0.002, -0.003, 0.001, 0.002, 0.001, 0.003}).failed());
    const Sym6 increment{0.002, -0.003, 0.0015, 0.002, 0.001, 0.003};
    for (std::size_t j = 0; j < 6; ++j) {
      Sym6 unit{};
      unit[j] = 1;
      expect_slopes(host, increment, unit, 1e-3);
    }
  }
}

TEST(Coaxial, OffTheAxisTheTangentIsIsotropicShear) {
  constexpr Sym6 off_d2{0.1, 0.1, -0.2, 0.4, -0.7, 0.5};  // no projection on (-1, 1, 0)
  for (const Form form : forms) {
    Host host(settings_of(d2, form));
    for (const Sym6& increment : path_along(d2)) ASSERT_FALSE(host.take(increment).failed());
    const Law law = make_law(thesis(), form);
    const double K = isotropic_shear_stiffness(law, host.state.point);
    EXPECT_GT(K, 0.01);
    expect_near(product(host.tangent, off_d2), times(K, off_d2), 1e-14);
    CoaxialSettings settings = settings_of(d2, form);
    settings.projected_tangent = true;
    Host projected(settings);
    projected.state = host.state;
    ASSERT_FALSE(projected.take({}).failed());
    expect_near(product(projected.tangent, off_d2), {}, 1e-15);
  }
}

TEST(Coaxial, IsotropicShearIsHowAnIsotropicPointBegins) {
  for (const Form form : forms) {
    Host host(settings_of(d2, form));
    const double K = isotropic_shear_stiffness(make_law(thesis(), form), host.state.point);
    ASSERT_FALSE(host.take(strain_along(d2, 0, 1e-9)).failed());
    EXPECT_NEAR(host.state.point.sigma_dev, 1e-9 * K, 1e-6 * 1e-9 * K) << name_of(form);
  }
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
