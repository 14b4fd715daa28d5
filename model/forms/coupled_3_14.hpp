// The thesis's earlier coupled form, Eq. 3.14, for comparison: one anisotropy modulus A, which is itself the
// state, and no memory of where a direction began. With q = sgn(d eps_dev) and d ln nu = 3 d eps_v (its
// factor D is the dimension, 3):
//   dP*         = B d ln nu + A S d eps_dev        S = 1 - q s/s_max
//   dsigma*_dev = A d ln nu + G S d eps_dev
//   dA          = beta_F (q A_max - A) |d eps_dev|
// The thesis's sign(d eps_dev) (A_max - A) d eps_dev would not let A reverse. A and A_max stand for F_dev and
// F_max by Eq. 4.12, A = a_I B F_dev, so that F_dev falls where B rises: A does not change with volume.
#pragma once

#include <array>

#include "grainlaw/model/forms/coupled.hpp"

namespace grainlaw::model {

/// Eq. 3.14; variables P*, sigma*_dev, A.
template <class P>
struct BasicCoupled314 : BasicCoupled<P> {
  static constexpr Form form = Form::coupled_3_14;
  using Base = BasicCoupled<P>;
  using Base::laws;
  using Base::size;

  template <class T>
  std::array<T, size> variables(const BasicState<T>& begin) const {
    return {begin.P, begin.sigma_dev, begin.F_dev * A_over_fabric(begin.nu)};
  }

  template <class C>
  using Coefficients = typename Base::template Coefficients<C>;

  /// dy/dt along a stretch where the coefficients are `c`. False where it is not defined: P* <= 0, or
  /// saturation values that are not > 0.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>&, const Y* y,
            Y* dydt) const {
    using std::abs;
    const Y &pressure = y[0], &sigma = y[1], &A = y[2];
    const S &v = stretch.eps_vol, &e = stretch.eps_dev;
    dydt[0] = c.B * v;
    dydt[1] = A * v;
    dydt[2] = 0.0;
    if (vanishes(e)) return true;
    // s = sigma/P; the event at smallest_pressure comes first
    if (!(pressure > 0 && c.s_max > 0 && c.F_max > 0 && c.beta_F >= 0)) return false;
    const auto q = stretch.q();
    const auto per_fabric = laws.moduli.a_I * c.B;
    const auto G = shear_modulus(laws.moduli, c.B, c.ratio_ini, sigma, A / per_fabric);
    const auto S_e = (1 - q * sigma / (pressure * c.s_max)) * e;
    dydt[0] = dydt[0] + A * S_e;
    dydt[1] = dydt[1] + G * S_e;
    dydt[2] = approach_rate(q * c.F_max * per_fabric, A, c.beta_F * abs(e));
    return true;
  }
  /// The fastest rate at which s_dev or A approach saturation, per unit t.
  template <class C, class S>
  double relaxation(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>&,
                    const S* y) const {
    const double e = std::abs(value(stretch.eps_dev));
    if (e == 0) return 0;
    const auto G = shear_modulus(laws.moduli, c.B, c.ratio_ini, y[1], y[2] / (laws.moduli.a_I * c.B));
    return e * std::max(std::abs(value(G)) / (value(y[0]) * value(c.s_max)), value(c.beta_F));
  }
  /// What errors of the variables are relative to: P*, and what saturation allows of the others.
  template <class C, class S>
  std::array<double, size> scales(const Coefficients<C>& c, const S* y) const {
    const double pressure = std::abs(value(y[0])),
                 A_max = value(laws.moduli.a_I) * value(c.B) * value(c.F_max);
    return {pressure, std::max(value(c.s_max) * pressure, std::abs(value(y[1]))),
            std::max(std::abs(A_max), std::abs(value(y[2])))};
  }

  template <class T>
  BasicState<T> state(const BasicState<T>& begin, const BasicStretch<T>& stretch, const T& t,
                      const T* y) const {
    BasicState<T> state = Base::state(begin, stretch, t, y);
    state.F_dev = y[2] / A_over_fabric(state.nu);
    return state;
  }

 private:
  template <class T>
  Meet<P, T> A_over_fabric(const T& nu) const {
    return laws.moduli.a_I * this->bulk_modulus_at(nu);
  }
};
using Coupled314 = BasicCoupled314<double>;

}  // namespace grainlaw::model
