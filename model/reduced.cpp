// The reduced forms: pressure from the packing law (Eq. 2.14), stress ratio and fabric from their approach to
// saturation.
#include "grainlaw/model/law.hpp"

namespace grainlaw::model {

namespace {

/// A jammed state of the reduced forms at t of a stretch.
State reduced_state(const Laws& laws, const State& begin, const Stretch& stretch, double t, double s_dev,
                    double F_dev) {
  State state = begin;
  state.nu = stretch.nu(t);
  state.eps_vol += stretch.eps_vol * t;
  state.eps_dev += stretch.eps_dev * t;
  state.P = pressure(laws.pressure, state.nu);
  state.sigma_dev = s_dev * state.P;
  state.F_dev = F_dev;
  return state;
}

}  // namespace

State ReducedClosed::at(const State& begin, const Stretch& stretch, double t) const {
  // Without shear nothing approaches anything: s_dev and F_dev stay.
  if (stretch.eps_dev == 0) return reduced_state(laws, begin, stretch, t, begin.s_dev(), begin.F_dev);
  const Direction& d = begin.direction;
  const double nu = stretch.nu(t);
  const double e = std::abs(begin.eps_dev + stretch.eps_dev * t - d.eps_dev_0);
  const double s = approach(d.q * saturation(laws.s_max, nu), d.s_0, saturation(laws.beta_s, nu), e);
  const double F = approach(d.q * saturation(laws.F_max, nu), d.F_0, saturation(laws.beta_F, nu), e);
  return reduced_state(laws, begin, stretch, t, s, F);
}

Variables Reduced::variables(const State& begin) const { return {begin.s_dev(), begin.F_dev, 0}; }

bool Reduced::rate(const Stretch& stretch, const Direction&, double t, const double* y, double* dydt) const {
  const double nu = stretch.nu(t), q = stretch.q(), e = std::abs(stretch.eps_dev);
  dydt[0] = e * approach_rate(q * saturation(laws.s_max, nu), y[0], saturation(laws.beta_s, nu));
  dydt[1] = e * approach_rate(q * saturation(laws.F_max, nu), y[1], saturation(laws.beta_F, nu));
  return true;
}

bool Reduced::jacobian(const Stretch& stretch, const Direction&, double t, const double*, double* J) const {
  const double nu = stretch.nu(t), e = std::abs(stretch.eps_dev);
  J[0] = -e * saturation(laws.beta_s, nu);
  J[1] = J[2] = 0;
  J[3] = -e * saturation(laws.beta_F, nu);
  return true;
}

State Reduced::state(const State& begin, const Stretch& stretch, double t, const double* y) const {
  return reduced_state(laws, begin, stretch, t, y[0], y[1]);
}

}  // namespace grainlaw::model
