// One piece of a segment in which two quantities are prescribed, in one direction of shear q: the strain
// rates (v, e) = (d ln nu/dt, d eps_dev/dt) that make both change as they should, from the 2 x 2 system
//   slope_1v v + slope_1e e = a_1,   slope_2v v + slope_2e e = a_2,
// and with them the form's own variables. a = (end - begin) + pull (wanted(t) - value): the second part
// vanishes on the solution and holds errors of integration down where a quantity is not linear in the
// variables.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "grainlaw/model/forms/stress_rates.hpp"

namespace grainlaw::model {

/// Strains of a whole segment beyond this are none that a point can take: the 2 x 2 system is singular.
inline constexpr double most_strain = 1e6;

template <class T>
struct StrainRates {
  T v = 0, e = 0;
  T determinant = 0;
  T numerator = 0, terms = 0;  ///< e = numerator/determinant; `terms` is its size before anything cancels
};

template <class Form>
class Steered {
 public:
  static constexpr std::size_t size = Form::size + 2;  ///< the form's variables, d ln nu and d eps_dev
  using Controls = std::array<Prescribed, 2>;

  Steered(const Form& form, const State& begin, const Controls& controls)
      : form_(form), begin_(begin), controls_(controls) {}

  double q() const { return q_; }
  const State& begin() const { return begin_; }
  /// Whether the sign of shear follows from the solution, so that it may change on the way.
  bool may_reverse() const { return q_ != 0 && !prescribes_shear(); }
  bool may_begin_to_shear() const { return q_ == 0 && !prescribes_shear(); }

  std::array<double, size> variables() const {
    std::array<double, size> z{};
    if constexpr (Form::size > 0) {
      const auto y = form_.variables(begin_);
      std::copy(y.begin(), y.end(), z.begin());
    }
    return z;
  }

  State state(const double* z) const {
    const Stretch whole{begin_.nu, z[Form::size], z[Form::size + 1]};
    if constexpr (Form::size == 0)
      return form_.at(begin_, whole, 1.0);
    else
      return form_.state(begin_, whole, 1.0, z);
  }

  /// False where they are not defined, or beyond a singular system.
  template <class T>
  bool solve(const T& t, const T* z, StrainRates<T>& strain, FormRates<T, Form::size>& rates) const {
    using std::exp;
    const T nu = begin_.nu * exp(z[Form::size]), eps_vol = begin_.eps_vol + z[Form::size],
            eps_dev = begin_.eps_dev + z[Form::size + 1];
    if (!form_rates(form_, begin_, begin_.direction, nu, eps_dev, z, rates)) return false;
    find_strain(t, nu, eps_vol, eps_dev, rates.stress, strain);
    if constexpr (std::is_same_v<Form, Memory>)
      if (strain.v < 0) find_strain(t, nu, eps_vol, eps_dev, rates.stress_back, strain);
    return true;
  }

  bool rate(double t, const double* z, double* dzdt) const { return rate_of(t, z, dzdt); }
  /// J[i + size j] = d rate_i/d z_j.
  bool jacobian(double t, const double* z, double* J) const {
    std::array<Dual<size>, size> variables, rates;
    for (std::size_t j = 0; j < size; ++j) variables[j] = Dual<size>(z[j], j);
    if (!rate_of(Dual<size>(t), variables.data(), rates.data())) return false;
    for (std::size_t j = 0; j < size; ++j)
      for (std::size_t i = 0; i < size; ++i) J[i + size * j] = rates[i].slope[j];
    return true;
  }

  /// v, whose sign decides what a history takes up.
  double volume_rate(double t, const double* z) const {
    const auto strain = strain_at(t, z);
    return strain ? strain->v : 0;
  }
  Stretch ahead(double t, const double* z) const {
    const auto strain = strain_at(t, z);
    return {begin_.nu * std::exp(z[Form::size]), strain ? strain->v : 0, strain ? strain->e : 0};
  }
  /// Whether the sign of v follows from the solution.
  bool may_turn() const {
    const auto is_volume = [](const Prescribed& c) {
      return c.kind == Prescribed::Kind::nu || (!c.by_stress() && c.weight[1] == 0);
    };
    return !is_volume(controls_[0]) && !is_volume(controls_[1]);
  }

  /// q e, positive while the direction of shear lasts.
  double shear_ahead(double t, const double* z) const {
    const auto strain = strain_at(t, z);
    return strain ? q_ * strain->e : 1;
  }
  /// Positive where a point without shear would begin to. Only where the sign of shear is not prescribed.
  double shear_begins(double t, const double* z) const {
    const auto strain = strain_at(t, z);
    return strain ? std::abs(strain->numerator) - 10 * negligible * strain->terms - 1e-300 : -1;
  }
  /// Positive while the system is not singular.
  double distance_to_limit(double t, const double* z) const {
    const auto strain = strain_at(t, z);
    return strain ? 1 - (strain->v * strain->v + strain->e * strain->e) / (most_strain * most_strain) : -1;
  }

  /// Takes the direction of shear that agrees with itself at t. Both may, beyond s_max, where shear on lowers
  /// the stress as unloading does: then it is the present one, and without one it is unloading. False where
  /// none does.
  bool find_direction(double t) {
    if (prescribes_shear()) {
      const Prescribed& shear = controls_[controls_[0].is_shear() ? 0 : 1];
      return take(sign(shear.change() * shear.weight[1]), t);
    }
    const double present = begin_.direction.q != 0 ? begin_.direction.q : begin_.sigma_dev > 0 ? -1 : 1;
    const State before = begin_;
    bool none = false;
    for (const double q : {present, -present}) {
      begin_ = before;
      if (!take(q, t)) continue;
      const double ahead = q * sign_of_shear(t);
      if (ahead > 0) return true;
      none = none || ahead == 0;
    }
    begin_ = before;
    return none && take(0, t);
  }

 private:
  /// Solves the 2 x 2 system of these slopes of stress.
  template <class T>
  void find_strain(const T& t, const T& nu, const T& eps_vol, const T& eps_dev, const StressRates<T>& stress,
                   StrainRates<T>& strain) const {
    using std::abs;
    std::array<std::array<T, 2>, 2> slope;
    std::array<T, 2> a, size_of_a;
    for (std::size_t i = 0; i < 2; ++i) {
      const Prescribed& control = controls_[i];
      slope[i] = control.slopes(nu, stress);
      const T value = control.value(nu, eps_vol, eps_dev, stress);
      a[i] = control.change() + pull * (control.begin + control.change() * t - value);
      size_of_a[i] = abs(a[i]) + pull * (rounding / negligible) * (abs(value) + std::abs(control.begin));
    }
    strain.determinant = slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
    strain.numerator = slope[0][0] * a[1] - slope[1][0] * a[0];
    strain.terms = abs(slope[0][0]) * size_of_a[1] + abs(slope[1][0]) * size_of_a[0];
    if (q_ == 0) {
      strain.determinant = slope[leading_][0];
      strain.v = a[leading_] / strain.determinant;
      strain.e = 0.0;
      return;
    }
    strain.v = (a[0] * slope[1][1] - a[1] * slope[0][1]) / strain.determinant;
    strain.e = strain.numerator / strain.determinant;
  }
  /// Errors of the prescribed quantities decay with exp(-pull t).
  static constexpr double pull = 100;
  /// A rate of shear this small against what cancels in it is rounding, as are differences of values this
  /// small against them.
  static constexpr double negligible = 1e-12, rounding = 1e-15;

  bool prescribes_shear() const { return controls_[0].is_shear() || controls_[1].is_shear(); }

  template <class T>
  bool rate_of(const T& t, const T* z, T* dzdt) const {
    StrainRates<T> strain;
    FormRates<T, Form::size> rates;
    // Beyond a singular system the solution would go back along another branch.
    if (!solve(t, z, strain, rates) || !(strain.determinant * side_ > 0)) return false;
    for (std::size_t i = 0; i < Form::size; ++i)
      dzdt[i] = (strain.v < 0 ? rates.back[i] : rates.v[i]) * strain.v + rates.e[i] * strain.e;
    dzdt[Form::size] = strain.v;
    dzdt[Form::size + 1] = strain.e;
    return true;
  }

  std::optional<StrainRates<double>> strain_at(double t, const double* z) const {
    StrainRates<double> strain;
    FormRates<double, Form::size> rates;
    if (!solve(t, z, strain, rates) || !std::isfinite(strain.v) || !std::isfinite(strain.e))
      return std::nullopt;
    return strain;
  }

  /// Begins in direction q. False where the system is singular.
  bool take(double q, double t) {
    q_ = q;
    if (q == 0)
      begin_.direction.q = 0;  // shear after a stretch without begins a new direction
    else if (q != begin_.direction.q)
      form_.begin_direction(begin_, q);
    if constexpr (requires { Form::goes_on_unjammed; }) form_.prepare(begin_);
    lead(t);
    const auto z = variables();
    const auto strain = strain_at(t, z.data());
    if (!strain || strain->determinant == 0 || !(distance_to_limit(t, z.data()) > 0)) return false;
    side_ = sign(strain->determinant);
    return true;
  }

  /// Which control gives v where there is no shear.
  void lead(double t) {
    leading_ = controls_[0].is_shear() ? 1 : 0;
    if (q_ != 0 || prescribes_shear()) return;
    const auto z = variables();
    StrainRates<double> strain;
    FormRates<double, Form::size> rates;
    if (!solve(t, z.data(), strain, rates)) return;
    const auto slope = [&](std::size_t i) {
      return std::abs(controls_[i].slopes(begin_.nu, rates.stress)[0]);
    };
    leading_ = slope(1) > slope(0) ? 1 : 0;
  }

  /// Sign of e at t, or, where it is 0 there (as at a reversal), just after; 0 where it stays 0.
  double sign_of_shear(double t) const {
    constexpr double ahead = 1e-6;
    auto z = variables();
    for (const bool moved : {false, true}) {
      if (moved) {
        std::array<double, size> dzdt;
        if (!rate(t, z.data(), dzdt.data())) return 0;
        for (std::size_t i = 0; i < size; ++i) z[i] += ahead * dzdt[i];
      }
      const auto strain = strain_at(moved ? t + ahead : t, z.data());
      if (!strain) return 0;
      if (std::abs(strain->numerator) > negligible * strain->terms) return sign(strain->e);
    }
    return 0;
  }

  const Form& form_;
  State begin_;
  const Controls& controls_;
  double q_ = 0;
  double side_ = 1;  // sign of the determinant
  std::size_t leading_ = 0;
};

}  // namespace grainlaw::model
