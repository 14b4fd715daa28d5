// The thesis's minimal model (section 5.H): phi_J(H) by the running maximum of compression (Eqs. 5.1, 5.5)
// and by shear strain (Eqs. 5.3, 5.13), everything else algebraic in nu/phi_J (Eqs. 5.7 to 5.12). Nothing is
// integrated: a straight stretch of any length is one evaluation.
//
// Shear takes phi_J from what over-compression has left down to phi_SJ. Where a reversal comes at or below
// phi_cr it goes back to phi_cr at once, and Eq. 5.13 takes it down again; above phi_cr a reversal leaves it
// alone. At and below phi_J all stresses, F_dev and the contacts are 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "grainlaw/model/closure.hpp"
#include "grainlaw/model/forms/memory.hpp"
#include "grainlaw/model/laws/shear_jamming.hpp"
#include "grainlaw/model/state.hpp"

namespace grainlaw::model {

/// Numbers of section 5.H.
struct MinimalLaws {
  PressureCurve isotropic, sheared;         ///< before shear and where its memory has faded (Table 5.1)
  double g3 = 1;                            ///< F_v = g3 nu C
  Saturation s_max, beta_s, F_max, beta_F;  ///< Eq. 5.12
  OverCompression over;                     ///< Eqs. 5.1, 5.5
  ShearMemory<> first, again;               ///< Eq. 5.3; Eq. 5.13
  double phi_cr = 1;                        ///< at and below it a reversal unjams
};

/// What a point of the minimal form carries on.
struct MinimalState {
  State point;              ///< as far as it is seen from outside; its history is that of over-compression
  double q = 0;             ///< direction of shear; 0: the next shear begins a new one
  double last_q = 0;        ///< that of the last shear, if any
  double eps = 0;           ///< deviatoric strain in this direction
  double s_0 = 0, F_0 = 0;  ///< s_dev and F_dev where it began
  double forgetting = 0;    ///< deviatoric strain that phi_J counts from (eps_d of Eq. 5.3 or 5.13)
  bool reversed = false;    ///< Eq. 5.13 holds
  double lost = 0;          ///< what the last reversal has taken from the phi_J of over-compression
  double s_dev = 0;         ///< sigma_dev/P; goes on without contacts
};

/// Eqs. 5.7 to 5.12.
struct Minimal {
  MinimalLaws laws;

  const ShearMemory<>& fading(const MinimalState& state) const {
    return state.reversed ? laws.again : laws.first;
  }
  double jamming_density(const MinimalState& state) const {
    return sheared_jamming_density(fading(state), state.point.history.phi_H - state.lost, state.forgetting);
  }
  /// Part of the way from the isotropic numbers to those of shear: what Eq. 5.3 has forgotten.
  double sheared_part(const MinimalState& state) const {
    if (state.reversed) return 1;
    return -std::expm1(-std::pow(state.forgetting / laws.first.eps0, laws.first.alpha));
  }
  /// Eqs. 5.7 to 5.9 at the present phi_J.
  PressureCurve curve(const MinimalState& state) const {
    const double m = sheared_part(state), phi_J = state.point.phi_J;
    const auto mix = [&](double a, double b) { return a + m * (b - a); };
    const auto &a = laws.isotropic, &b = laws.sheared;
    return {{mix(a.contacts.C0, b.contacts.C0), mix(a.contacts.C1, b.contacts.C1),
             mix(a.contacts.alpha, b.contacts.alpha),
             phi_J * mix(a.contacts.nu_c / a.nu_c, b.contacts.nu_c / b.nu_c),
             mix(a.contacts.phi_c, b.contacts.phi_c), mix(a.contacts.phi_v, b.contacts.phi_v)},
            mix(a.p0, b.p0),
            mix(a.gamma_p, b.gamma_p),
            phi_J};
  }
  /// Eq. 5.12: Q_a + Q_c exp[-Psi (nu/phi_J - 1)].
  double saturated(Saturation law, const MinimalState& state) const {
    law.nu_c = state.point.phi_J;
    return saturation(law, state.point.nu);
  }

  /// The state after a straight stretch of strain.
  MinimalState after(MinimalState state, double eps_vol, double eps_dev) const {
    begin_direction(state, sign(eps_dev));
    State& point = state.point;
    point.nu *= std::exp(eps_vol);
    point.eps_vol += eps_vol;
    point.eps_dev += eps_dev;
    point.history = compressed<double, double>(laws.over, point.history, point.nu);
    state.eps += std::abs(eps_dev);
    state.forgetting += std::abs(eps_dev);
    settle(state);
    return state;
  }

  /// The state where a stretch with this shear begins: beyond a reversal, where it is one.
  MinimalState turned(MinimalState state, double eps_dev) const {
    begin_direction(state, sign(eps_dev));
    settle(state);
    return state;
  }

  /// phi_J, contacts, stress and fabric that follow from strain and history.
  void settle(MinimalState& state) const {
    State& point = state.point;
    point.phi_J = jamming_density(state);
    point.jammed = point.nu > point.phi_J;
    if (state.q != 0 && point.jammed) {
      state.s_dev = approach(state.q * saturated(laws.s_max, state), state.s_0, saturated(laws.beta_s, state),
                             state.eps);
      point.F_dev = approach(state.q * saturated(laws.F_max, state), state.F_0, saturated(laws.beta_F, state),
                             state.eps);
    }
    point.P = point.jammed ? pressure(curve(state), point.nu) : 0;
    point.sigma_dev = point.P * state.s_dev;
  }

 private:
  void begin_direction(MinimalState& state, double q) const {
    if (q == state.q) return;
    state.q = q;
    if (q == 0) return;
    state.eps = 0;
    state.s_0 = state.s_dev;
    state.F_0 = state.point.F_dev;
    if (q == -state.last_q && state.point.nu <= laws.phi_cr) {
      state.reversed = true;
      state.forgetting = 0;
      state.lost = state.point.history.phi_H - std::min(laws.phi_cr, state.point.history.phi_H);
    }
    state.last_q = q;
  }
};

}  // namespace grainlaw::model
