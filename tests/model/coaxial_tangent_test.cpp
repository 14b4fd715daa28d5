// The tangent between tensors, against differences, and off the axis.
#include <gtest/gtest.h>

#include "coaxial_fixture.hpp"

namespace grainlaw::model {
namespace {

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

TEST(CoaxialTangent, TangentIsTheSlopeAlongTheAxisAndOfVolume) {
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

TEST(CoaxialTangent, TheProjectedTangentIsTheSlopeInEveryDirection) {
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

TEST(CoaxialTangent, OffTheAxisTheTangentIsIsotropicShear) {
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

TEST(CoaxialTangent, IsotropicShearIsHowAnIsotropicPointBegins) {
  for (const Form form : forms) {
    Host host(settings_of(d2, form));
    const double K = isotropic_shear_stiffness(make_law(thesis(), form), host.state.point);
    ASSERT_FALSE(host.take(strain_along(d2, 0, 1e-9)).failed());
    EXPECT_NEAR(host.state.point.sigma_dev, 1e-9 * K, 1e-6 * 1e-9 * K) << name_of(form);
  }
}

TEST(CoaxialTangent, IsotropicShearOfAPointWithMemory) {
  const ParameterSet set = thesis_with_memory();
  const CoaxialLaw law(set, settings_of(d2, Form::memory));
  CoaxialState state = law.start(Start{0.711, {}, {}, {}, {}, {}}).state;
  const double K = isotropic_shear_stiffness(make_law(set, {Form::memory, {}}), state.point);
  EXPECT_GT(K, 0.01);
  CoaxialLaw::Workspace workspace;
  Sym6 stress;
  Matrix6 tangent;
  ASSERT_FALSE(law.update(state, strain_along(d2, 0, 1e-9), workspace, stress, &tangent).failed());
  EXPECT_NEAR(state.point.sigma_dev, 1e-9 * K, 1e-6 * 1e-9 * K);
  EXPECT_NEAR(tangent[35], K, 1e-6 * K);
}

}  // namespace
}  // namespace grainlaw::model
