// The coupled form with moduli by a table over the volume fraction (term moduli_table): Eq. 4.16 with A1 =
// a_I B F_dev, A2 = a_II B F_dev and G = B [(G/B)_ini - g_I sigma*_dev F_dev], all five numbers by the table.
#pragma once

#include "grainlaw/model/forms/coupled.hpp"

namespace grainlaw::model {

template <class P>
struct BasicTabulated : BasicCoupled<P> {
  using Base = BasicCoupled<P>;
  using Base::laws;
  ModuliTable table;
  P nu_c = 0.5;  ///< moduli.nu_c, with which the table belongs: another history moves both

  template <class T>
  struct Coefficients : Base::template Coefficients<T> {
    T a_I, a_II, g_I;
  };
  template <class T>
  Coefficients<Meet<P, T>> coefficients(const T& nu) const {
    const auto m = table_at(nu);
    return {{m.B, isotropic_fabric(laws.contacts, laws.g3, nu), m.GB_ini, saturation(laws.s_max, nu),
             saturation(laws.F_max, nu), saturation(laws.beta_F, nu)},
            m.a_I,
            m.a_II,
            m.g_I};
  }
  template <class T, class S>
  auto coefficients(const T& nu, const BasicDirection<S>&) const {
    return coefficients(nu);
  }
  /// Coefficients at t between those of t = 0 and 1, where they are linear in t.
  template <class C, class X>
  static Coefficients<Meet<C, X>> between(const Coefficients<C>& a, const Coefficients<C>& b, const X& t) {
    return {Base::between(a, b, t), a.a_I + t * (b.a_I - a.a_I), a.a_II + t * (b.a_II - a.a_II),
            a.g_I + t * (b.g_I - a.g_I)};
  }
  bool covers(double nu) const { return table.covers(nu * factor()); }

  template <class C, class Y>
  AnisotropyModuli<Meet<C, Y>> anisotropy_moduli(const Coefficients<C>& c, const Y&, const Y&,
                                                 const Y& F) const {
    return {c.a_I * c.B * F, c.a_II * c.B * F};
  }
  template <class C, class Y>
  Meet<C, Y> shear_modulus_of(const Coefficients<C>& c, const Y& sigma, const Y& F) const {
    return c.B * (c.ratio_ini - c.g_I * sigma * F);
  }
  /// False, too, beyond the table.
  template <class C, class S, class Y>
  bool rate(const Coefficients<C>& c, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
            const Y* y, Y* dydt) const {
    return c.B > 0 && Base::rate_of(*this, c, stretch, direction, y, dydt);
  }

  template <class T>
  Meet<P, T> jamming_density(const BasicState<T>& state) const {
    return Base::jamming_density_of(state, [&](const auto& nu) { return table_at(nu).B; });
  }
  template <class T>
  void jam(BasicState<T>& state, const BasicStretch<T>& stretch) const {
    Base::jam_with(coefficients(state.nu), state, stretch);
  }

 private:
  P factor() const { return nu_c / laws.moduli.nu_c; }
  template <class T>
  auto table_at(const T& nu) const {
    return table.at(Meet<P, T>(nu * factor()));
  }
};
using Tabulated = BasicTabulated<double>;

}  // namespace grainlaw::model
