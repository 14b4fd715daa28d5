#include "grainlaw/model/walk/path_control.hpp"

#include <cmath>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

constexpr double same = 1e-9;  // relative: stresses or strains given as the same number

bool close(double x, double y) { return std::abs(x - y) <= same * (std::abs(x) + std::abs(y)); }

Prescribed quantity_of(Quantity quantity) {
  const std::string name = name_of(quantity);
  switch (quantity) {
    case Quantity::nu:
      return {Prescribed::Kind::nu, name};
    case Quantity::eps_vol:
      return Prescribed::strain(name, 1, 0);
    case Quantity::eps_dev:
      return Prescribed::strain(name, 0, 1);
    case Quantity::P:
      return Prescribed::stress(name, 1, 0);
    case Quantity::sigma_dev:
      return Prescribed::stress(name, 0, 1);
    case Quantity::s_dev:
      break;
  }
  return {Prescribed::Kind::s_dev, name};
}

const std::optional<double>& target_of(const Control& control, std::size_t c) {
  return std::get<StressTarget>(control.component[c]).stress;
}

}  // namespace

Prescribed PathControl::Aim::from(const State& state, const State& begin) const {
  if (amount) {
    const double end = quantity.value(begin) + *amount;
    return quantity.from(state, &end);
  }
  return quantity.from(state, target ? &*target : nullptr);
}

PathControl::PathControl(const Path& path, std::size_t i, const StrainTensor& axis)
    : path_(path), segment_(path.segments.at(i)) {
  const double size = signed_deviator(axis, axis);
  for (std::size_t c = 0; c < 6; ++c) m_[c] = axis[c] / size;
  refuse_shear();
  const bool sheared_axes = axis[3] != 0 || axis[4] != 0 || axis[5] != 0;
  if (sheared_axes && segment_.control.by_stress() && !segment_.control.mean)
    cannot("the axes of the path are not x, y and z");
  find_aims();
}

void PathControl::find_aims() {
  switch (segment_.mode) {
    case Mode::constant_p:
      return constant_p();
    case Mode::biaxial:
    case Mode::triaxial:
      return sides();
    case Mode::isotropic_stress:
      return isotropic_stress();
    case Mode::control:
      return axes();
    default:
      return two_quantities();
  }
}

void PathControl::cannot(const std::string& why, const std::string& field) const {
  throw Error(path_.file, segment_.key + (field.empty() ? "" : "." + field),
              "cannot be followed by the law, which has one direction of shear: " + why);
}

PathControl::Aim PathControl::stress_on(std::size_t c, const std::string& name) const {
  return {Prescribed::stress("the stress on " + name, 1, m(c)), target_of(segment_.control, c), std::nullopt};
}

/// eps_dev by the segment's amount or to its target.
PathControl::Aim PathControl::shear_aim() const {
  return {Prescribed::strain("eps_dev", 0, 1), segment_.to_eps_dev, segment_.amount};
}

void PathControl::two_quantities() {
  for (std::size_t i = 0; i < 2; ++i) {
    const LawControl& control = segment_.law_controls.at(i);
    aims_[i] = {quantity_of(control.quantity), control.target, std::nullopt};
  }
}

void PathControl::constant_p() {
  aims_ = {Aim{Prescribed::stress("P", 1, 0), segment_.control.mean->stress, std::nullopt}, shear_aim()};
  approaches_ = true;
}

/// biaxial: plane strain, eps_yy = eps_vol/2 + eps_dev/sqrt(3) by projection with z at rest, and sigma_xx = P
/// - sigma_dev/sqrt(3). triaxial: eps_zz = eps_vol/3 + (2/3) eps_dev and sigma_xx = sigma_yy = P -
/// sigma_dev/3.
void PathControl::sides() {
  const bool plane = segment_.mode == Mode::biaxial;
  aims_[0] = stress_on(0, plane ? "x" : "x and y");
  if (segment_.to_eps_dev)
    aims_[1] = shear_aim();
  else
    aims_[1] = {plane ? Prescribed::strain("the strain of y", 0.5, m(1))
                      : Prescribed::strain("the strain of z", 1.0 / 3, m(2)),
                std::nullopt, segment_.amount};
  approaches_ = true;
  if (plane)
    remark_ = "plane strain is not along the axis of D2: the law takes its volume and its projection";
}

void PathControl::isotropic_stress() {
  aims_ = {Aim{Prescribed::stress("P", 1, 0), target_of(segment_.control, 0), std::nullopt},
           Aim{Prescribed::stress("sigma_dev", 0, 1), 0.0, std::nullopt}};
}

/// A shear strain beside P alone is along the axis of the path, or has been refused before.
void PathControl::refuse_shear() const {
  const Control& control = segment_.control;
  for (std::size_t c = 3; c < 6; ++c) {
    if (control.by_stress(c)) cannot("it has no shear stress as a target", control_keys[c]);
    if (control.axis_by_stress() && segment_.strain[c] != 0)
      cannot("stresses on axes do not go with a shear strain", control_keys[c]);
  }
}

void PathControl::axes() {
  std::size_t stresses = 0, loaded = 0, strained = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    if (segment_.control.by_stress(c)) {
      ++stresses;
      loaded = c;
    } else {
      strained = c;
    }
  }
  switch (stresses) {
    case 0:
      return mean_and_strains();
    case 1:
      return one_stress(loaded);
    case 2:
      return two_stresses(strained);
    default:
      return three_stresses();
  }
}

void PathControl::mean_and_strains() {
  const StrainTensor& strain = segment_.strain;
  double shear = 0;
  for (std::size_t c = 0; c < 3; ++c) shear += a(c) * strain[c];
  for (std::size_t c = 3; c < 6; ++c) shear += 2 * a(c) * strain[c];
  aims_ = {Aim{Prescribed::stress("P", 1, 0), segment_.control.mean->stress, std::nullopt},
           Aim{Prescribed::strain("eps_dev", 0, 1), std::nullopt, shear}};
  approaches_ = true;
}

/// P and sigma_dev follow from two axes of different m; the third must agree.
void PathControl::three_stresses() {
  StrainTensor given{};
  for (std::size_t c = 0; c < 3; ++c) given[c] = target_of(segment_.control, c) ? 1 : 0;
  start_mix_ = given;
  aims_ = {Aim{Prescribed::stress("P", 1, 0), std::nullopt, std::nullopt},
           Aim{Prescribed::stress("sigma_dev", 0, 1), std::nullopt, std::nullopt}};
}

void PathControl::two_stresses(std::size_t strained) {
  const std::size_t i = (strained + 1) % 3, j = (strained + 2) % 3;
  const auto &at_i = target_of(segment_.control, i), &at_j = target_of(segment_.control, j);
  const std::string sides = std::string(control_keys[i]) + " and " + control_keys[j];
  if (!close(m(i), m(j)))
    cannot("stresses on " + sides + " and a strain of " + control_keys[strained] +
           " are no two quantities along the axis of the path");
  if (at_i.has_value() != at_j.has_value() || (at_i && !close(*at_i, *at_j)))
    cannot("the stresses on " + sides + " must be the same");
  aims_ = {stress_on(i, sides), Aim{Prescribed::strain(std::string("the strain of ") + control_keys[strained],
                                                       1.0 / 3, m(strained)),
                                    std::nullopt, segment_.strain[strained]}};
  approaches_ = true;
}

/// The strain of the axis under stress is what is left of volume and shear: eps_dev - a_k eps_vol holds the
/// other two.
void PathControl::one_stress(std::size_t loaded) {
  const std::size_t i = (loaded + 1) % 3, j = (loaded + 2) % 3;
  const double e_i = segment_.strain[i], e_j = segment_.strain[j];
  const bool coaxial = close(m(i), m(j)) && close(e_i, e_j);
  const bool plane = (m(i) == 0 && e_i == 0) || (m(j) == 0 && e_j == 0);
  if (!coaxial && !plane)
    cannot(std::string("a stress on ") + control_keys[loaded] + " and these strains of " + control_keys[i] +
           " and " + control_keys[j] + " are not along the axis of the path");
  if (plane)
    remark_ = "plane strain is not along the axis of D2: the law takes its volume and its projection";
  aims_ = {stress_on(loaded, control_keys[loaded]),
           Aim{Prescribed::strain(std::string("the strain of ") + control_keys[i] + " and " + control_keys[j],
                                  -a(loaded), 1),
               std::nullopt, (a(i) - a(loaded)) * e_i + (a(j) - a(loaded)) * e_j}};
  approaches_ = true;
}

std::optional<PathControl::Controls> PathControl::approach(const State& state) const {
  if (!approaches_ || !aims_[0].target || close(*aims_[0].target, aims_[0].quantity.value(state)))
    return std::nullopt;
  // What a target in eps_dev alone strains rests in its own axis on the way.
  Prescribed rests = aims_[1].quantity;
  if (segment_.mode == Mode::biaxial) rests = Prescribed::strain("the strain of y", 0.5, m(1));
  if (segment_.mode == Mode::triaxial) rests = Prescribed::strain("the strain of z", 1.0 / 3, m(2));
  return Controls{aims_[0].from(state, state), rests.from(state)};
}

bool PathControl::passed_by_approach(const State& state, const State& begin) const {
  const double before = aims_[1].from(begin, begin).change(), after = aims_[1].from(state, begin).change();
  return approaches_ && before != 0 && before * after < 0;
}

PathControl::Controls PathControl::controls(const State& state, const State& begin) const {
  if (!start_mix_) return {aims_[0].from(state, begin), aims_[1].from(state, begin)};
  std::array<double, 3> stress{};
  for (std::size_t c = 0; c < 3; ++c)
    stress[c] = target_of(segment_.control, c).value_or(state.P + m(c) * state.sigma_dev);
  const double P = (stress[0] + stress[1] + stress[2]) / 3;
  double sigma = 0;
  for (std::size_t c = 0; c < 3; ++c) sigma += a(c) * (stress[c] - P);
  for (std::size_t c = 0; c < 3; ++c)
    if (!close(P + m(c) * sigma, stress[c])) cannot("the three stresses are not along the axis of the path");
  return {aims_[0].quantity.from(state, &P), aims_[1].quantity.from(state, &sigma)};
}

}  // namespace grainlaw::model
