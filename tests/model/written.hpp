// The thesis's laws written down anew, with the numbers of its tables, and an independent integration of
// whatever rates are made of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <vector>

#include "walks.hpp"

namespace grainlaw::model {

inline double table_2_2(double Q_max, double Q_v, double alpha, double nu) {
  return Q_max + Q_v * std::exp(-alpha * (nu / 0.6653 - 1));
}

/// Tables 2.2 and 4.1 and the D2 row of Table 2.1 at nu_c = 0.658, along a straight stretch of strain.
struct Tables {
  using Vector = std::vector<double>;  // P*, sigma*_dev, F_dev
  double nu_0, v, e;                   // start; d ln nu and d eps_dev per unit t

  double nu(double t) const { return nu_0 * std::exp(v * t); }
  double q() const { return e > 0 ? 1 : -1; }
  static double s_max(double n) { return table_2_2(0.1137, 0.09166, 7.916, n); }
  static double F_max(double n) { return table_2_2(0, 0.1694, 4.562, n); }
  static double beta_F(double n) { return table_2_2(0, 57.89, 5.366, n); }
  static double fabric(double n) {
    const double x = n / 0.658 - 1;
    return 1.22 * n * (6 + 7.9219 * std::pow(x, 0.5769)) * (1 - 0.1363 * std::exp(-15.001 * x));
  }
  static double bulk(double n) {
    const double x = n / 0.658 - 1, eps = std::log(n / 0.658);
    const double C = 6 + 7.9219 * std::pow(x, 0.5769),
                 dC = 7.9219 * 0.5769 * std::pow(x, 0.5769 - 1) * n / 0.658;
    const double phi = 0.1363 * std::exp(-15.001 * x), dphi = -15.001 * phi * n / 0.658;
    const double dlnF = 1 + dC / C - dphi / (1 - phi);
    return 0.0425 * fabric(n) / (1.22 * 0.658) * (1 - 0.4 * eps + eps * (1 - 0.2 * eps) * dlnF);
  }
  /// (G/B)_ini - g_I sigma*_dev F_dev.
  static double shear_ratio(double n, double sigma, double F) {
    return 0.51 * (1 - std::exp(-(fabric(n) - 4.2) / 1.9)) - 86 * sigma * F;
  }
};

/// Eq. 4.16.
struct Written : Tables {
  double S_I = 1, S_F_I = 1;

  void begin(const Vector& y) {
    S_I = std::abs(1 - q() * y[1] / y[0] / s_max(nu_0));
    S_F_I = std::abs(1 - q() * y[2] / F_max(nu_0));
  }
  void operator()(const Vector& y, Vector& dy, double t) const {
    const double n = nu(t), B = bulk(n);
    const double S = (1 - q() * y[1] / y[0] / s_max(n)) / S_I;
    const double S_F = (1 - q() * y[2] / F_max(n)) / S_F_I;
    dy[0] = B * v + 0.66 * B * y[2] * S * e;
    dy[1] = B * y[2] * v + B * shear_ratio(n, y[1], y[2]) * S * e;
    dy[2] = beta_F(n) * q() * F_max(n) * S_F * std::abs(e);
  }
};

/// Walks both along the same legs (v, e) from the same start and compares every row.
template <class Law = Written>
void expect_agreement(double nu, Tables::Vector y, const std::vector<std::array<double, 2>>& legs,
                      const Prediction& p, int rows) {
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<Tables::Vector>>(1e-15, 1e-14);
  ASSERT_EQ(p.record.rows(), 1 + legs.size() * static_cast<std::size_t>(rows));
  std::size_t row = 1;
  for (const auto& [v, e] : legs) {
    Law law{{nu, v, e}};
    law.begin(y);
    for (int i = 0; i < rows; ++i, ++row) {
      odeint::integrate_adaptive(stepper, law, y, i / double(rows), (i + 1) / double(rows), 1e-5);
      EXPECT_NEAR(p.record["P"][row], y[0], 1e-9 * y[0]) << row;
      EXPECT_NEAR(p.record["sigma_dev"][row], y[1], 1e-9 * y[0]) << row;
      EXPECT_NEAR(p.record["F_dev"][row], y[2], 1e-9) << row;
    }
    nu *= std::exp(v);
  }
}

}  // namespace grainlaw::model
