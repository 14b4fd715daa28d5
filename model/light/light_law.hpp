// The law for a host that comes with increments, one point at a time: state in, state out, and on request the
// consistent tangent of the increment. Const and without allocation, so one object serves any number of
// threads.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/light/light.hpp"

namespace grainlaw::model {

/// Derivatives of what an increment leaves by the increment itself: rows P*, sigma*_dev, F_dev; columns
/// eps_vol, eps_dev. Exact to rounding for the steps that were taken, through loss of contact, jamming and
/// reversals as well.
struct Tangent {
  double P[2] = {0, 0}, sigma_dev[2] = {0, 0}, F_dev[2] = {0, 0};
};

/// What the coupled form computed from nu last, or the form with memory where its last increment ended. Give
/// the same one again and again to a point, or in the former to a row of points of one volume fraction, and
/// increments cost less, those of the coupled form at constant volume by a third.
struct LightCache {
  const void* law = nullptr;  ///< whose they are
  double nu = -1;
  Coupled::Coefficients<double> coefficients{};
  Memory::Here<double, double> memory{};
  std::array<double, Memory::size> y{};  ///< the variables there
  bool jammed = false;
};

class LightLaw {
 public:
  /// Throws Error for a tolerance that is not > 0.
  LightLaw(Law law, Tolerance tolerance, LightMethod method = LightMethod::automatic);

  const Law& law() const { return law_; }
  Tolerance tolerance() const { return light_.tolerance; }

  /// Walks the state over an increment of logarithmic strain (compression positive; either may be 0), through
  /// any loss of contact. On failure the state is as before and the status says why; a point that carries
  /// nothing in the end is ok.
  Status update(State& state, double eps_vol, double eps_dev, LightCache* cache = nullptr) const;
  /// The same with the tangent.
  Status update(State& state, double eps_vol, double eps_dev, Tangent& tangent) const;

  /// As MaterialPoint::walk: a long stretch in steps of the light path's own, with the states at the
  /// fractions `samples` (ascending, in [0, 1]) on the way.
  using Visit = std::function<void(std::size_t, const State&)>;
  Status walk(State& state, double eps_vol, double eps_dev, std::span<const double> samples,
              const Visit& visit) const;

 private:
  template <class T, class Visitor>
  Status walk_along(BasicState<T>& state, const BasicStretch<T>& stretch, std::span<const double> samples,
                    const Visitor& visit) const;
  bool quick(State& state, const Stretch& stretch, LightCache* cache) const;
  bool quick(const Coupled& form, State& state, const Stretch& stretch, LightCache& known) const;
  bool quick(const Memory& form, State& state, const Stretch& stretch, LightCache& known) const;
  /// Whether x may be a memory of shear.
  bool is_part(double x) const;
  Status admits(const State& state, const Stretch& stretch) const;

  Law law_;
  Light light_;
};

}  // namespace grainlaw::model
