// A point between tensors, the paths it is taken along, and arithmetic of six numbers.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "grainlaw/model/c/coaxial.hpp"

namespace grainlaw::model {

inline constexpr Sym6 d2{-1, 1, 0, 0, 0, 0}, uni{-0.5, -0.5, 1, 0, 0, 0}, shear_xy{0, 0, 0, 0, 0, 1},
    general{0.3, -1, 0.2, 0.5, -0.4, 0.8};
inline constexpr std::array forms{Form::reduced_closed, Form::reduced, Form::coupled, Form::coupled_3_14};

inline CoaxialSettings settings_of(const Sym6& axis, Form form = Form::coupled) {
  CoaxialSettings settings;
  settings.choice.form = form;
  settings.tolerance = {1e-10, 1e-14};
  settings.axis = axis;
  return settings;
}

inline Sym6 times(double a, const Sym6& x) {
  Sym6 result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = a * x[i];
  return result;
}
inline Sym6 sum(const Sym6& x, const Sym6& y) {
  Sym6 result;
  for (std::size_t i = 0; i < 6; ++i) result[i] = x[i] + y[i];
  return result;
}
/// So much strain along the deviator of an axis, and so much of volume.
inline Sym6 strain_along(const Sym6& axis, double eps_vol, double eps_dev) {
  const double mean = trace(axis) / 3;
  Sym6 deviator = axis;
  for (std::size_t i = 0; i < 3; ++i) deviator[i] -= mean;
  return sum(times(eps_vol / 3, {1, 1, 1, 0, 0, 0}), times(eps_dev / deviator_magnitude(deviator), deviator));
}
inline Sym6 product(const Matrix6& matrix, const Sym6& x) {
  Sym6 result{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) result[i] += matrix[6 * i + j] * x[j];
  return result;
}
inline void expect_near(const Sym6& a, const Sym6& b, double tolerance) {
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
  /// A workspace is no part of what a point is.
  Host(const Host& other)
      : law(other.law), state(other.state), stress(other.stress), tangent(other.tangent) {}
  Host& operator=(const Host&) = delete;
  Status take(const Sym6& increment) { return law.update(state, increment, workspace, stress, &tangent); }
};

/// A path that reverses, compresses and releases, along an axis.
inline std::vector<Sym6> path_along(const Sym6& axis) {
  std::vector<Sym6> path;
  for (const auto& [v, e] :
       {std::pair{0.0, 0.004}, {0.0, 0.01}, {0.001, 0.002}, {0.0, -0.003}, {-0.002, 0.0}, {0.001, -0.02}})
    path.push_back(strain_along(axis, v, e));
  return path;
}

}  // namespace grainlaw::model
