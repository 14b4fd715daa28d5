// The coupled form, Eq. 4.16, with signed deviatoric quantities, q = sgn(d eps_dev) and d ln nu = 3 d eps_v:
//   dP*         = B d ln nu  + A1 S_sigma d eps_dev
//   dsigma*_dev = A2 d ln nu + G  S_sigma d eps_dev
//   dF_dev      = beta_F (q F_max) S_F |d eps_dev|
//   S_sigma = (1 - q s/s_max)/|S_I|,  S_F = (1 - q F_dev/F_max)/|S_F,I|
// The thesis's sign(d eps_dev) F_max S_F d eps_dev would not let F reverse. The magnitude of S_I makes s
// return to s_max from beyond it, where the quotient of the thesis would run away.
#include <algorithm>

#include "grainlaw/model/law.hpp"

namespace grainlaw::model {

namespace {

/// Everything in the rates that depends on nu alone.
struct Coefficients {
  double B, ratio_ini, s_max, F_sat, beta;  // beta: beta_F/|S_F,I|; F_sat = q F_max
};

Coefficients coefficients(const Laws& laws, const Stretch& stretch, const Direction& direction, double t) {
  const double nu = stretch.nu(t);
  return {bulk_modulus(laws.moduli, laws.contacts, nu),
          initial_shear_ratio(laws.moduli, isotropic_fabric(laws.contacts, laws.g3, nu)),
          saturation(laws.s_max, nu), stretch.q() * saturation(laws.F_max, nu),
          saturation(laws.beta_F, nu) / direction.S_F_I};
}

}  // namespace

Variables Coupled::variables(const State& begin) const { return {begin.P, begin.sigma_dev, begin.F_dev}; }

bool Coupled::rate(const Stretch& stretch, const Direction& direction, double t, const double* y,
                   double* dydt) const {
  const auto [P, sigma, F] = std::array{y[0], y[1], y[2]};
  const double v = stretch.eps_vol, e = stretch.eps_dev;
  const Coefficients c = coefficients(laws, stretch, direction, t);
  const double A1 = anisotropy_modulus_1(laws.moduli, c.B, F), A2 = anisotropy_modulus_2(laws.moduli, c.B, F);
  dydt[0] = c.B * v;
  dydt[1] = A2 * v;
  dydt[2] = 0;
  if (e == 0) return true;
  if (!(P > 0)) return false;  // s = sigma/P; the event at smallest_pressure comes first
  const double G = shear_modulus(laws.moduli, c.B, c.ratio_ini, sigma, F);
  const double S = (1 - stretch.q() * sigma / (P * c.s_max)) / direction.S_I;
  dydt[0] += A1 * S * e;
  dydt[1] += G * S * e;
  dydt[2] = approach_rate(c.F_sat, F, c.beta) * std::abs(e);
  return true;
}

bool Coupled::jacobian(const Stretch& stretch, const Direction& direction, double t, const double* y,
                       double* J) const {
  const auto [P, sigma, F] = std::array{y[0], y[1], y[2]};
  const double v = stretch.eps_vol, e = stretch.eps_dev;
  const Moduli& m = laws.moduli;
  const Coefficients c = coefficients(laws, stretch, direction, t);
  std::fill_n(J, 9, 0.0);
  J[1 + 3 * 2] = m.a_II * c.B * v;
  if (e == 0) return true;
  if (!(P > 0)) return false;
  const double A1 = anisotropy_modulus_1(m, c.B, F);
  const double G = shear_modulus(m, c.B, c.ratio_ini, sigma, F);
  const double S = (1 - stretch.q() * sigma / (P * c.s_max)) / direction.S_I;
  const double dS_dsigma = -stretch.q() / (P * c.s_max * direction.S_I), dS_dP = -dS_dsigma * sigma / P;
  J[0 + 3 * 0] = A1 * dS_dP * e;
  J[0 + 3 * 1] = A1 * dS_dsigma * e;
  J[0 + 3 * 2] = m.a_I * c.B * S * e;
  J[1 + 3 * 0] = G * dS_dP * e;
  J[1 + 3 * 1] = (G * dS_dsigma - c.B * m.g_I * F * S) * e;
  J[1 + 3 * 2] += -c.B * m.g_I * sigma * S * e;
  J[2 + 3 * 2] = -c.beta * std::abs(e);
  return true;
}

State Coupled::state(const State& begin, const Stretch& stretch, double t, const double* y) const {
  State state = begin;
  state.nu = stretch.nu(t);
  state.eps_vol += stretch.eps_vol * t;
  state.eps_dev += stretch.eps_dev * t;
  state.P = y[0];
  state.sigma_dev = y[1];
  state.F_dev = y[2];
  return state;
}

}  // namespace grainlaw::model
