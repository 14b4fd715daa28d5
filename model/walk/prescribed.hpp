// A quantity that a segment of a path prescribes: from where it stands to a target, linear in the path
// variable t from 0 to 1. A linear combination of strains and stresses, or nu, or s_dev.
#pragma once

#include <array>
#include <string>

#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// How the stress of a form changes at a state, per d ln nu (index v) and per d eps_dev (index e) in one
/// direction of shear. Stresses over k*.
template <class T>
struct StressRates {
  T P, sigma;
  T P_v, P_e, sigma_v, sigma_e;
  T s, s_v, s_e;  ///< s_dev = sigma_dev/P
};

struct Prescribed {
  enum class Kind { linear, nu, s_dev };
  Kind kind = Kind::linear;
  std::string name;                ///< as the path says it: "P", "s_dev", "the stress on x"
  std::array<double, 4> weight{};  ///< linear: of eps_vol, eps_dev (from the path's start), P* and sigma*_dev
  double begin = 0, end = 0;       ///< at t = 0 and 1

  bool by_stress() const { return kind == Kind::s_dev || weight[2] != 0 || weight[3] != 0; }
  /// Whether it is eps_dev itself, so that the sign of shear is prescribed.
  bool is_shear() const { return kind == Kind::linear && weight[0] == 0 && weight[1] != 0 && !by_stress(); }
  double change() const { return end - begin; }
  double wanted(double t) const { return begin + change() * t; }

  /// Its value where the state is so.
  double value(const State& state) const {
    if (kind == Kind::nu) return state.nu;
    if (kind == Kind::s_dev) return state.s_dev();
    return weight[0] * state.eps_vol + weight[1] * state.eps_dev + weight[2] * state.P +
           weight[3] * state.sigma_dev;
  }
  template <class T>
  T value(const T& nu, const T& eps_vol, const T& eps_dev, const StressRates<T>& stress) const {
    if (kind == Kind::nu) return nu;
    if (kind == Kind::s_dev) return stress.s;
    return weight[0] * eps_vol + weight[1] * eps_dev + weight[2] * stress.P + weight[3] * stress.sigma;
  }
  /// Its change per d ln nu and per d eps_dev.
  template <class T>
  std::array<T, 2> slopes(const T& nu, const StressRates<T>& stress) const {
    if (kind == Kind::nu) return {nu, T(0.0)};
    if (kind == Kind::s_dev) return {stress.s_v, stress.s_e};
    return {weight[0] + weight[2] * stress.P_v + weight[3] * stress.sigma_v,
            weight[1] + weight[2] * stress.P_e + weight[3] * stress.sigma_e};
  }

  static Prescribed strain(std::string name, double of_eps_vol, double of_eps_dev) {
    return {Kind::linear, std::move(name), {of_eps_vol, of_eps_dev, 0, 0}};
  }
  static Prescribed stress(std::string name, double of_P, double of_sigma_dev) {
    return {Kind::linear, std::move(name), {0, 0, of_P, of_sigma_dev}};
  }
  /// Begins at the state's own value and goes to `target`; without one it stays.
  Prescribed from(const State& state, const double* target = nullptr) const {
    Prescribed result = *this;
    result.begin = value(state);
    result.end = target != nullptr ? *target : result.begin;
    return result;
  }
};

}  // namespace grainlaw::model
