// Laws written once, as a template over the number type, and differentiated automatically (Ceres Jets).
// Internal to the fits: the only header here that needs Ceres.
#pragma once

#include <ceres/jet.h>

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "grainlaw/calibrate/fit_problem.hpp"

namespace grainlaw::calibrate {

/// Makes a LawFunction of `law(const T* p, const FitPoint&) -> T` with M parameters.
template <int M, class Law>
LawFunction differentiable(Law law) {
  return [law = std::move(law)](std::span<const double> p, const FitPoint& at, std::span<double> gradient) {
    if (gradient.empty()) return static_cast<double>(law(p.data(), at));
    using Jet = ceres::Jet<double, M>;
    std::array<Jet, M> jets;
    for (int i = 0; i < M; ++i) jets[static_cast<std::size_t>(i)] = Jet(p[static_cast<std::size_t>(i)], i);
    const Jet y = law(static_cast<const Jet*>(jets.data()), at);
    for (int i = 0; i < M; ++i) gradient[static_cast<std::size_t>(i)] = y.v[i];
    return y.a;
  };
}

}  // namespace grainlaw::calibrate
