#include "grainlaw/model/c/coaxial.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "grainlaw/element/error.hpp"
#include "grainlaw/model/start.hpp"

namespace grainlaw::model {

namespace {

constexpr Sym6 identity{1, 1, 1, 0, 0, 0};

Sym6 deviator_of(const Sym6& q) {
  const double mean = trace(q) / 3;
  return {q[0] - mean, q[1] - mean, q[2] - mean, q[3], q[4], q[5]};
}

/// The deviator of the axis with sqrt(3 J2) = 1.
Sym6 unit_deviator(const Sym6& axis) {
  double size = 0;
  for (const double component : axis) size += std::abs(component);
  if (!std::isfinite(size)) throw Error("", "axis", "must have finite components");
  Sym6 n = deviator_of(axis);
  const double magnitude = deviator_magnitude(n);
  if (!(magnitude > 1e-12 * size)) throw Error("", "axis", "must have a deviator, got an isotropic tensor");
  for (double& component : n) component /= magnitude;
  return n;
}

/// Derivative of deviator_along(strain, n) by number j of the strain, for n with sqrt(3 J2) = 1.
double slope_along(const Sym6& n, std::size_t j) { return (j < 3 ? 1.5 : 3.0) * n[j]; }

}  // namespace

double isotropic_shear_stiffness(const Law& law, const State& point) {
  if (!point.jammed) return 0;
  return std::visit(
      [&]<class F>(const F& form) {
        if constexpr (std::is_base_of_v<Coupled, F>) {
          const auto c = form.coefficients(point.nu);
          return std::max(0.0, c.B * c.ratio_ini);  // (G/B)_ini is below 0 where F_v < F_v,min
        } else if constexpr (F::form == Form::memory) {
          const auto stiffness = form.stiffness_of(point);
          return stiffness.B * stiffness.ratio_ini;
        } else {
          return point.P * saturation(form.laws.beta_s, point.nu) * saturation(form.laws.s_max, point.nu);
        }
      },
      law);
}

void check(const CoaxialSettings& settings) {
  check(settings.tolerance);
  unit_deviator(settings.axis);
  const Range allowed = between(0, 1);
  if (!allowed.contains(settings.coaxial_tolerance))
    throw Error("", "coaxial_tolerance",
                "must be " + allowed.text() + ", got " + to_text(settings.coaxial_tolerance));
}

CoaxialLaw::CoaxialLaw(ParameterSet parameters, const CoaxialSettings& settings)
    : parameters_(std::move(parameters)),
      settings_(settings),
      law_(make_law(parameters_, settings.choice), settings.tolerance),
      axis_(unit_deviator(settings.axis)) {
  check(settings);
}

CoaxialLaw::Begin CoaxialLaw::start(const Start& start) const {
  Path path;
  path.start = start;
  const StartState begin = start_of(parameters_, path, settings_.choice);
  return {{begin.state, laws_of(begin.law).pressure.nu_c}, begin.warnings};
}

Sym6 CoaxialLaw::stress(const State& point) const {
  const double sign = settings_.notation.tension_positive ? -1 : 1;
  Sym6 stress;
  for (std::size_t i = 0; i < 6; ++i) stress[i] = sign * (point.P * identity[i] + point.sigma_dev * axis_[i]);
  return stress;
}

/// Compression positive, components of the tensor.
Sym6 CoaxialLaw::read_strain(const Sym6& written) const {
  const double sign = settings_.notation.tension_positive ? -1 : 1,
               shear = settings_.notation.engineering_shear ? 0.5 : 1;
  Sym6 strain;
  for (std::size_t i = 0; i < 6; ++i) {
    if (!std::isfinite(written[i]))
      throw Error("", "strain_increment[" + std::to_string(i) + "]",
                  "must be finite, got " + to_text(written[i]));
    strain[i] = sign * (i < 3 ? 1 : shear) * written[i];
  }
  return strain;
}

struct CoaxialLaw::Parts {
  double eps_vol, eps_dev;
  double off_axis;  ///< sqrt(3 J2) of the rest
  double size;      ///< of the whole: |eps_vol| + sqrt(3 J2)
};

CoaxialLaw::Parts CoaxialLaw::split(const Sym6& strain) const {
  const double eps_vol = trace(strain), eps_dev = deviator_along(strain, axis_),
               size = std::abs(eps_vol) + deviator_magnitude(strain);
  Sym6 rest = strain;
  for (std::size_t i = 0; i < 6; ++i) rest[i] -= eps_dev * axis_[i];
  // Isotropic strain with a rounding error in its deviator is no reversal.
  const auto rounded = [&](double x) { return std::abs(x) > coaxial_rounding * size ? x : 0; };
  return {rounded(eps_vol), rounded(eps_dev), deviator_magnitude(rest), size};
}

/// The laws of a point's history. Those that were moved last are kept.
const LightLaw& CoaxialLaw::law_at(double phi_J_laws, Workspace& workspace) const {
  if (workspace.phi_J_laws != phi_J_laws) {
    workspace.cache = {};
    workspace.block.reset();
    workspace.moved.reset();
    if (phi_J_laws != laws_of(law_.law()).pressure.nu_c) {
      Law moved = law_.law();
      laws_of(moved) = with_jamming_density(laws_of(moved), phi_J_laws);
      workspace.moved = std::make_unique<const LightLaw>(std::move(moved), settings_.tolerance);
    }
    workspace.phi_J_laws = phi_J_laws;
  }
  return workspace.moved ? *workspace.moved : law_;
}

/// d sigma = (P_v I + s_v n) tr d eps + (P_e I + s_e n) d eps_dev + K (what is left of the deviator).
Matrix6 CoaxialLaw::matrix_of(const Tangent& t, double off_axis) const {
  Matrix6 matrix;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      const double along = slope_along(axis_, j),
                   rest = (i == j ? 1 : 0) - identity[i] * identity[j] / 3 - axis_[i] * along;
      const double slope = (t.P[0] * identity[i] + t.sigma_dev[0] * axis_[i]) * identity[j] +
                           (t.P[1] * identity[i] + t.sigma_dev[1] * axis_[i]) * along + off_axis * rest;
      matrix[6 * i + j] = slope * (j >= 3 && settings_.notation.engineering_shear ? 0.5 : 1);
    }
  return matrix;
}

Status CoaxialLaw::update(CoaxialState& state, const Sym6& increment, Workspace& workspace, Sym6& stress_out,
                          Matrix6* tangent) const {
  const Parts parts = split(read_strain(increment));
  if (!std::isfinite(parts.size)) throw Error("", "strain_increment", "is too large");
  if (parts.off_axis > settings_.coaxial_tolerance * parts.size)
    return {Status::Code::not_coaxial,
            "the strain increment is not coaxial with the axis: " + shown(parts.off_axis) +
                " of its deviator lies off it, allowed is " + shown(settings_.coaxial_tolerance) +
                " of the increment, " + shown(settings_.coaxial_tolerance * parts.size)};
  const LightLaw& law = law_at(state.phi_J_laws, workspace);
  State moved = state.point;
  Tangent slopes;
  Status status = tangent ? law.update(moved, parts.eps_vol, parts.eps_dev, slopes)
                          : law.update(moved, parts.eps_vol, parts.eps_dev, &workspace.cache);
  if (status.failed()) return status;
  state.point = moved;
  stress_out = stress(moved);
  if (tangent) {
    const double off_axis = settings_.projected_tangent ? 0 : isotropic_shear_stiffness(law.law(), moved);
    *tangent = matrix_of(slopes, off_axis);
  }
  return moved.jammed ? Status{} : Status{Status::Code::unjammed, ""};
}

bool CoaxialLaw::update_block(std::span<CoaxialState> states, const double* increments, Workspace& workspace,
                              double* stresses) const {
  if (states.size() > block || !LightBatch::runs_in_lanes(law_.law())) return false;
  std::array<double, block> eps_vol{}, eps_dev{};
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].phi_J_laws != states[0].phi_J_laws) return false;
    Sym6 increment;
    std::copy_n(increments + 6 * i, 6, increment.begin());
    const Parts parts = split(read_strain(increment));
    if (!(parts.off_axis <= settings_.coaxial_tolerance * parts.size)) return false;
    eps_vol[i] = parts.eps_vol;
    eps_dev[i] = parts.eps_dev;
  }
  const LightLaw& law = law_at(states[0].phi_J_laws, workspace);
  if (!workspace.block) workspace.block = std::make_unique<LightBatch>(law, block, states[0].point);
  LightBatch& batch = *workspace.block;
  for (std::size_t i = 0; i < block; ++i) {
    const std::size_t of = std::min(i, states.size() - 1);  // copies of the last point fill the block
    batch.set_state(i, states[of].point);
    eps_vol[i] = eps_vol[of];
    eps_dev[i] = eps_dev[of];
  }
  if (batch.update(eps_vol, eps_dev).failed > 0) return false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].point = batch.state(i);
    const Sym6 there = stress(states[i].point);
    std::copy(there.begin(), there.end(), stresses + 6 * i);
  }
  return true;
}

}  // namespace grainlaw::model
