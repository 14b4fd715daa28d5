#include "grainlaw/element/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/jacobi.hpp"
#include "grainlaw/element/path_limits.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw {

namespace {

constexpr StrainTensor axis_d2{-1, 1, 0};
constexpr StrainTensor axis_uni{-0.5, -0.5, 1};
constexpr StrainTensor axis_simple_shear{0, 0, 0, 0, 0, -1};  // of a small gamma > 0: that of its rate always

/// a : b
double dot(const StrainTensor& a, const StrainTensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

StrainTensor deviator(const StrainTensor& e) {
  const double mean = (e[0] + e[1] + e[2]) / 3;
  return {e[0] - mean, e[1] - mean, e[2] - mean, e[3], e[4], e[5]};
}

double magnitude(const StrainTensor& e) { return deviator_magnitude(e); }

bool has_deviator(const StrainTensor& e) {
  double sum = 0;
  for (const double component : e) sum += std::abs(component);
  return magnitude(e) > 1e-12 * sum;
}

/// The axis of a strain (see SignConvention); `before` is the axis in force, if any.
StrainTensor axis_of(Mode mode, const StrainTensor& strain, const std::optional<StrainTensor>& before) {
  if (mode == Mode::d2 || mode == Mode::biaxial) return axis_d2;
  if (mode == Mode::uni || mode == Mode::d3 || mode == Mode::triaxial) return axis_uni;
  if (mode == Mode::simple_shear) return axis_simple_shear;
  if (coaxial(strain, axis_d2)) return axis_d2;
  if (coaxial(strain, axis_uni)) return axis_uni;
  if (before && coaxial(strain, *before)) return *before;
  return deviator(strain);
}

/// The shear stresses that are asked for as numbers: the axis of a leg whose strain does not say one.
StrainTensor shear_asked_for(const Control& control) {
  StrainTensor shear{};
  for (std::size_t c = 3; c < 6; ++c)
    if (const auto* target = std::get_if<StressTarget>(&control.component[c]))
      shear[c] = target->stress.value_or(0);
  return shear;
}

StrainTensor d2_strain(double eps_dev) {
  const double e = eps_dev / std::numbers::sqrt3;
  return {-e, e, 0};
}

StrainTensor d3_strain(double eps_dev) {
  const double e = eps_dev / 1.5;
  return {-0.5 * e, -0.5 * e, e};
}

/// Logarithmic strain of a segment, given volume fraction and accumulated strains where it begins.
StrainTensor strain_of(const Segment& segment, const Waypoint& at) {
  double amount = 0;
  if (segment.amount) amount = *segment.amount;
  if (segment.to_nu) amount = std::log(*segment.to_nu / at.nu);
  if (segment.to_eps_vol) amount = *segment.to_eps_vol - at.eps_vol;
  if (segment.to_eps_dev) amount = *segment.to_eps_dev - at.eps_dev;
  // A side that may give way makes eps_dev larger than the axial strain; twice as much is certainly enough.
  const double axial = segment.to_eps_dev ? 2 * amount : amount;
  switch (segment.mode) {
    case Mode::components:
    case Mode::control:
      return segment.strain;
    case Mode::iso:
      return {amount / 3, amount / 3, amount / 3};
    case Mode::uni:
      return {0, 0, amount};
    case Mode::d2:
      return d2_strain(amount);
    case Mode::d3:
      return d3_strain(amount);
    case Mode::constant_p:
      return segment.shear == Mode::d2 ? d2_strain(amount) : d3_strain(amount);
    case Mode::biaxial:
      return {0, axial, 0};
    case Mode::triaxial:
      return {0, 0, axial};
    case Mode::simple_shear:
      return simple_shear_strain(amount);
    case Mode::relax:
    case Mode::isotropic_stress:
      break;
  }
  return {};
}

/// sqrt(3 J2) of the strain of a whole simple shear, with the sign of gamma.
double eps_dev_of_simple_shear(double gamma) { return std::numbers::sqrt3 * std::asinh(0.5 * gamma); }

/// By how much the principal values differ.
double spread(const StrainTensor& e) {
  std::array<std::array<double, 3>, 3> m{{{e[0], e[5], e[4]}, {e[5], e[1], e[3]}, {e[4], e[3], e[2]}}};
  for (int sweep = 0; sweep < 10; ++sweep)
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = p + 1; q < 3; ++q) jacobi_rotation(m, p, q);
  const auto [least, most] = std::minmax({m[0][0], m[1][1], m[2][2]});
  return most - least;
}

}  // namespace

bool Segment::only_waits() const {
  return mode == Mode::relax || mode == Mode::isotropic_stress ||
         (mode == Mode::control && strain == StrainTensor{});
}

bool coaxial(const StrainTensor& a, const StrainTensor& b) {
  const StrainTensor u = deviator(a), v = deviator(b);
  if (!has_deviator(a) || !has_deviator(b)) return true;
  return std::abs(dot(u, v)) >= (1 - 1e-12) * std::sqrt(dot(u, u) * dot(v, v));
}

double Leg::progress(double t) const {
  const double s = duration > 0 ? std::clamp(t / duration, 0.0, 1.0) : 1.0;
  if (profile != Profile::cosine) return s;
  // sin^2 instead of (1 - cos)/2: no cancellation at the start.
  const double half = std::sin(0.5 * std::numbers::pi * s);
  return half * half;
}

double Leg::time_at(double f) const {
  f = std::clamp(f, 0.0, 1.0);
  if (profile != Profile::cosine) return f * duration;
  return duration * 2 / std::numbers::pi * std::asin(std::sqrt(f));
}

double Leg::eps_dev_at(double f) const {
  if (!gamma) return eps_dev[0] + f * (eps_dev[1] - eps_dev[0]);
  return eps_dev[0] + eps_dev_of_simple_shear(gamma_before + f * *gamma) -
         eps_dev_of_simple_shear(gamma_before);
}

double Leg::fraction_at(double value) const {
  if (!gamma) return std::clamp((value - eps_dev[0]) / (eps_dev[1] - eps_dev[0]), 0.0, 1.0);
  const double whole = value - eps_dev[0] + eps_dev_of_simple_shear(gamma_before);
  const double gamma_there = 2 * std::sinh(whole / std::numbers::sqrt3);
  return std::clamp((gamma_there - gamma_before) / *gamma, 0.0, 1.0);
}

void Waypoint::move(const StrainTensor& strain, const std::optional<StrainTensor>& leg_axis) {
  if (leg_axis) axis = leg_axis;
  if (has_deviator(strain)) {
    eps_dev += signed_deviator(strain, axis.value_or(axis_uni));
    gamma = 0;
  }
  eps_vol += strain[0] + strain[1] + strain[2];
  nu = nu_start * std::exp(eps_vol);
}

void Waypoint::move(const Leg& leg) {
  if (!leg.gamma) return move(leg.strain, leg.axis);
  axis = leg.axis;
  eps_dev -= eps_dev_of_simple_shear(gamma);
  gamma += *leg.gamma;
  eps_dev += eps_dev_of_simple_shear(gamma);
}

namespace {

/// The axis of a mode whose direction is known although its amount is not.
std::optional<StrainTensor> axis_of_mode(const Segment& segment) {
  const Mode mode = segment.mode == Mode::constant_p ? segment.shear : segment.mode;
  if (mode == Mode::d2 || mode == Mode::biaxial) return axis_d2;
  if (mode == Mode::uni || mode == Mode::d3 || mode == Mode::triaxial) return axis_uni;
  if (mode == Mode::simple_shear) return axis_simple_shear;
  return std::nullopt;
}

}  // namespace

Leg Path::leg(std::size_t i, const Waypoint& from, bool certain) const {
  const Segment& segment = segments.at(i);
  Leg leg{};
  leg.mode = segment.mode;
  leg.strain = strain_of(segment, from);
  leg.profile = segment.profile;
  leg.tolerance = segment.tolerance;
  leg.control = segment.control;
  leg.wanted_ratio = segment.wanted_ratio;
  leg.increment = segment.increment;
  leg.residual = segment.residual;
  if (segment.mode == Mode::simple_shear) {
    leg.gamma = segment.amount;
    leg.gamma_before = from.gamma;
  }
  if (segment.mode == Mode::biaxial || segment.mode == Mode::triaxial) leg.to_eps_dev = segment.to_eps_dev;
  const double size = leg.gamma ? std::abs(*leg.gamma) : largest_component(leg.strain);
  const bool waits = !leg.drives() && segment.by_stress();
  if (certain && segment.mode != Mode::relax && !waits && !(size > 1e-14))
    throw Error(file, segment.key, "has nothing to do: its target is the state already reached");
  leg.duration = segment.duration ? *segment.duration : waits ? leg.control.servo.wait : size / *segment.rate;
  if (!(leg.duration <= longest_duration))
    throw Error(file, segment.key,
                "takes " + to_text(leg.duration) + " us; must be at most " + to_text(longest_duration) +
                    ": its rate is too low");
  if (has_deviator(leg.strain))
    leg.axis = axis_of(leg.mode, leg.strain, from.axis);
  else if (const StrainTensor shear = shear_asked_for(leg.control); has_deviator(shear))
    leg.axis = axis_of(leg.mode, shear, from.axis);
  else if (leg.control.by_stress())
    leg.axis = from.axis;  // what its servo shears counts along the axis before it
  if (!certain && !leg.axis) leg.axis = axis_of_mode(segment);
  Waypoint to = from;
  to.move(leg);
  if (certain && !(to.nu > 0 && to.nu < 1) && !leg.control.by_stress())
    throw Error(file, segment.key,
                "takes the volume fraction to " + to_text(to.nu) + "; it must stay > 0 and < 1");
  leg.eps_vol[0] = from.eps_vol;
  leg.eps_vol[1] = to.eps_vol;
  leg.eps_dev[0] = from.eps_dev;
  leg.eps_dev[1] = to.eps_dev;
  return leg;
}

std::vector<Leg> Path::legs(double nu) const {
  for (const Segment& segment : segments) {
    if (segment.control.by_stress())
      throw Error(file, segment.key,
                  "is under stress control (mode " + name_of(segment.mode) +
                      "): its strain is known only when the grains have run");
    if (segment.law_only())
      throw Error(file, segment.key,
                  "has two targets or a stop: its strain is known only when it was walked");
  }
  return nominal_legs(nu);
}

std::vector<Leg> Path::nominal_legs(double nu, bool certain) const {
  std::vector<Leg> legs;
  legs.reserve(segments.size());
  Waypoint at(nu);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    certain = certain && !segments[i].by_stress() && !(i > 0 && segments[i - 1].stop);
    Leg leg = this->leg(i, at, certain);
    at.move(leg);
    legs.push_back(std::move(leg));
  }
  return legs;
}

bool Path::strain_is_known() const {
  return std::none_of(segments.begin(), segments.end(),
                      [](const Segment& segment) { return segment.by_stress() || segment.stop; });
}

namespace {

/// The largest component that a segment prescribes: its key in the segment, and the number there.
std::pair<std::string, double> largest_prescribed(const Segment& segment) {
  if (segment.amount) return {"amount", *segment.amount};
  const auto size = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto c =
      std::max_element(segment.strain.begin(), segment.strain.end(), size) - segment.strain.begin();
  const auto at = static_cast<std::size_t>(c);
  return {segment.mode == Mode::control ? std::string(control_keys.at(at)) + ".strain"
                                        : "strain[" + std::to_string(at) + "]",
          segment.strain.at(at)};
}

/// As far as the strain does not depend on where the segment begins; of targets the box tells.
void need_a_box_can_follow(const std::string& file, const Segment& segment) {
  const double by = spread(strain_of(segment, Waypoint(0.5)));
  if (segment.to_nu || segment.to_eps_vol || segment.to_eps_dev || by <= largest_spread) return;
  const auto [key, value] = largest_prescribed(segment);
  throw Error(file, segment.key + "." + key,
              "strains the box of grains beyond what its edges can hold in double precision: principal "
              "strains of one "
              "segment may differ by at most " +
                  to_text(largest_spread) + ", so this must be, the others in proportion, at most " +
                  short_text(std::abs(value) * largest_spread / by, 4) + " in size, got " + to_text(value));
}

}  // namespace

void Path::need_grains_can_follow() const {
  for (const Segment& segment : segments) {
    if (!segment.law_controls.empty())
      throw Error(file, segment.key + ".controls",
                  "has two targets, which only the law can follow (predict); for grains give one, or a mode "
                  "under stress control");
    if (segment.stop)
      throw Error(file, segment.key + ".stop",
                  "ends a segment of the law (predict); grains go on to the segment's end");
    need_a_box_can_follow(file, segment);
  }
}

namespace {

/// The first segment whose axes turn, or the end.
auto first_that_spins(const std::vector<Segment>& segments) {
  return std::find_if(segments.begin(), segments.end(),
                      [](const Segment& segment) { return segment.mode == Mode::simple_shear; });
}

}  // namespace

bool Path::spins() const { return first_that_spins(segments) != segments.end(); }

void Path::need_law_can_follow() const {
  const auto spinning = first_that_spins(segments);
  if (spinning == segments.end()) return;
  throw Error(
      file, spinning->key + ".mode",
      "must not be simple_shear: its axes of strain turn, and the law carries stress and fabric along "
      "one direction of shear; without spin it is d2; grains follow simple_shear, too (simulate)");
}

bool Path::by_stress() const {
  return std::any_of(segments.begin(), segments.end(),
                     [](const Segment& segment) { return segment.control.by_stress(); });
}

StrainTensor simple_shear_strain(double gamma) {
  // ln V = asinh(gamma/2) (cos 2a, sin 2a; sin 2a, -cos 2a) in x and y, with tan 2a = 2/gamma
  const double size = std::asinh(0.5 * gamma), hypotenuse = std::hypot(gamma, 2);
  const double along = size * gamma / hypotenuse;
  return {-along, along, 0, 0, 0, -size * 2 / hypotenuse};
}

double signed_deviator(const StrainTensor& strain, const StrainTensor& axis) {
  return std::copysign(magnitude(strain), dot(strain, axis));
}

SignConvention::SignConvention(const std::vector<Leg>& legs) : axes_(legs.size(), axis_uni) {
  std::optional<StrainTensor> axis;
  std::size_t leading = 0;  // legs before the first axis is known
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (legs[i].axis || has_deviator(legs[i].strain)) {
      const bool first = !axis;
      axis = legs[i].axis ? legs[i].axis : axis_of(legs[i].mode, legs[i].strain, axis);
      if (first) std::fill_n(axes_.begin(), leading, *axis);
    }
    if (axis)
      axes_[i] = *axis;
    else
      ++leading;
  }
}

double SignConvention::signed_deviator(const Sym6& q, std::size_t leg) const {
  const StrainTensor& axis = axes_.at(leg);
  return std::copysign(deviator_magnitude(q), dot(q, axis));
}

}  // namespace grainlaw
