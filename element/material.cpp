#include "grainlaw/element/material.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "grainlaw/element/error.hpp"

namespace grainlaw {

namespace {
// So wide that no product of them overflows.
const Range positive = between(1e-15, 1e15), not_negative = between(0, 1e15);

#include "grainlaw/element/contact_law-inl.hpp"

/// Of two grains of radius r, ug.
double reduced_mass(const Material& m, double r) {
  return 0.5 * m.rho * 4.0 / 3.0 * std::numbers::pi * r * r * r;
}
}  // namespace

double Material::damping_scale() const {
  const Material thesis;
  return std::sqrt(k / thesis.k * rho / thesis.rho * std::pow(r_mean / thesis.r_mean, 3));
}

double Material::contact_duration(double r) const {
  return ContactLaw::of(*this).duration(reduced_mass(*this, r));
}

Material Material::read(Reader reader) {
  Material m;
  m.w = reader.number("w", between(1, 100), m.w);
  m.k = reader.number("k", positive, m.k);
  m.r_mean = reader.number("r_mean", positive, m.r_mean);
  m.rho = reader.number("rho", positive, m.rho);
  const double likeness = m.damping_scale();
  m.gamma = reader.number("gamma", not_negative, m.gamma * likeness);
  m.gamma_b = reader.number("gamma_b", not_negative, m.gamma_b * likeness);
  reader.finish();
  if (!std::isfinite(m.contact_duration(m.r_min())))
    reader.fail("gamma",
                "overdamps the contact of the two smallest grains (no finite contact duration); must be < " +
                    to_text(ContactLaw::of(m).critical_damping(reduced_mass(m, m.r_min()))) + ", got " +
                    to_text(m.gamma));
  return m;
}

Json Material::to_json() const {
  return {{"w", w}, {"k", k}, {"r_mean", r_mean}, {"rho", rho}, {"gamma", gamma}, {"gamma_b", gamma_b}};
}

double fabric_size_factor(double w) {
  constexpr double B2 = 1.077, C2 = 0.2629;  // Eq. 3.8
  // Moments <r^n>/<r>^n of the uniform distribution: r = 1 + h u, u uniform on [-1, 1], h = (w-1)/(w+1).
  const double h2 = std::pow((w - 1) / (w + 1), 2);
  const double m2 = 1 + h2 / 3, m3 = 1 + h2, m4 = 1 + 2 * h2 + h2 * h2 / 5, m5 = 1 + 10 * h2 / 3 + h2 * h2;
  return (1 - B2 + C2 + (B2 - 2 * C2) * m4 / m3 + C2 * m5 / m3) / (1 + C2 * (m2 - 1));
}

}  // namespace grainlaw
