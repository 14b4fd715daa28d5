#include "grainlaw/model/light/light_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::model {

namespace {

/// The solver of one piece without samples.
constexpr auto no_sample = [] { return 2.0; };
constexpr auto no_visit = [](const auto&...) {};

bool went(const Reached<double>& reached) { return !reached.status.failed() && !reached.lost_pressure; }

template <class T>
BasicHistory<T> with_slopes(const History& h) {
  return {h.phi_H, h.phi_max, h.nu};
}
template <class T>
BasicDirection<T> with_slopes(const Direction& d) {
  return {d.q, d.S_I, d.S_F_I, d.s_0, d.F_0, d.eps_dev_0, with_slopes<T>(d.history), d.jammed};
}
template <class T>
BasicState<T> with_slopes(const State& s) {
  return {s.nu,
          s.eps_vol,
          s.eps_dev,
          s.P,
          s.sigma_dev,
          s.F_dev,
          s.phi_J,
          s.jammed,
          with_slopes<T>(s.direction),
          with_slopes<T>(s.history),
          {s.shear.plus, s.shear.minus, s.shear.packed, s.shear.steady}};
}

}  // namespace

LightLaw::LightLaw(Law law, Tolerance tolerance, LightMethod method)
    : law_(std::move(law)), light_{tolerance, method} {
  check(tolerance);
}

/// The increment of a point that goes on in its direction, without an event: no walk. False where it is not
/// one.
bool LightLaw::quick(State& state, const Stretch& stretch, LightCache* cache) const {
  if (stretch.q() != state.direction.q || stretch.eps_dev == 0) return false;
  LightCache own;
  LightCache& known = cache ? *cache : own;
  const State before = state;
  const auto* coupled = std::get_if<Coupled>(&law_);
  const auto* memory = std::get_if<Memory>(&law_);
  if ((coupled && quick(*coupled, state, stretch, known)) ||
      (memory && quick(*memory, state, stretch, known)))
    return true;
  state = before;
  return false;
}

bool LightLaw::quick(const Coupled& form, State& state, const Stretch& stretch, LightCache& known) const {
  if (!state.jammed) return false;
  if (stretch.eps_vol != 0 && !(stretch.nu(1.0) > form.unjamming_density())) return false;
  if (known.nu != state.nu || known.law != this) {
    known.law = this;
    known.nu = state.nu;
    known.coefficients = form.coefficients(state.nu);
  }
  const State begin = state;
  const StretchRate<Coupled, double> rate(form, stretch, begin.direction, known.coefficients);
  LightRun<Coupled, double> run(rate, form.variables(begin), light_.tolerance, light_.method);
  return went(light_.go(form, state, begin, stretch, rate, run, no_sample, no_visit));
}

bool LightLaw::quick(const Memory& form, State& state, const Stretch& stretch, LightCache& known) const {
  if (!is_finite(state) || !is_part(state.shear.plus) || !is_part(state.shear.minus) ||
      !is_part(state.shear.packed))
    return false;
  form.prepare(state);
  const State begin = state;
  const auto y = form.variables(begin);
  const Memory::Coefficients<double>& c = known.memory.c;
  const bool same_place = known.law == this && c.nu == state.nu && state.history.nu == state.nu &&
                          c.phi_H == state.history.phi_H && c.phi_max == state.history.phi_max;
  const bool same = same_place && known.y == y && known.jammed == state.jammed;
  const StretchRate<Memory, double> rate(form, stretch, begin.direction,
                                         same_place ? c : form.coefficients(state.nu, begin.direction));
  LightRun<Memory, double> run(rate, y, light_.tolerance, light_.method, same ? &known.memory : nullptr);
  if (!went(light_.go(form, state, begin, stretch, rate, run, no_sample, no_visit))) return false;
  known.law = nullptr;
  if (run.here() && form.variables(state) == run.y())
    known = {.law = this, .memory = *run.here(), .y = run.y(), .jammed = state.jammed};
  return true;
}

template <class T, class Visitor>
Status LightLaw::walk_along(BasicState<T>& state, const BasicStretch<T>& stretch,
                            std::span<const double> samples, const Visitor& visit) const {
  if (Status status = admits(values_of(state), values_of(stretch)); status.failed()) return status;
  BasicState<T> moved = state;
  Status status = std::visit(
      [&](const auto& form) {
        return Walk(form, moved, Course<T>(stretch, samples), light_, visit,
                    [](bool, const BasicState<T>&) {})
            .run();
      },
      law_);
  if (status.failed())
    return {status.code, status.message + " (nu = " + shown(value(moved.nu)) +
                             ", eps_dev = " + shown(value(moved.eps_dev)) + ")"};
  state = moved;
  return {};
}

bool LightLaw::is_part(double x) const {
  const double slack = std::clamp(10 * light_.tolerance.rtol, 1e-6, 0.01);  // what an integration leaves
  return x >= -slack && x <= 1 + slack;
}

Status LightLaw::admits(const State& state, const Stretch& stretch) const {
  if (!is_finite(state))
    return {Status::Code::failed,
            "the state holds what is not a number: nu, P, sigma_dev, F_dev or its memory"};
  for (const double x : {state.shear.plus, state.shear.minus, state.shear.packed})
    if (!is_part(x)) return {Status::Code::failed, "the memory of shear must be in [0, 1], got " + shown(x)};
  if (!std::isfinite(stretch.eps_vol) || !std::isfinite(stretch.eps_dev))
    return {Status::Code::failed, "the strain increment must be finite, got eps_vol = " +
                                      shown(stretch.eps_vol) + ", eps_dev = " + shown(stretch.eps_dev)};
  if (auto reason = objection(law_, stretch)) return {Status::Code::failed, *reason};
  return {};
}

Status LightLaw::update(State& state, double eps_vol, double eps_dev, LightCache* cache) const {
  const Stretch stretch{state.nu, eps_vol, eps_dev};
  if (quick(state, stretch, cache)) return {};
  if (eps_vol == 0 && eps_dev == 0) return admits(state, stretch);
  return walk_along(state, stretch, {}, no_visit);
}

Status LightLaw::walk(State& state, double eps_vol, double eps_dev, std::span<const double> samples,
                      const Visit& visit) const {
  if (eps_vol == 0 && eps_dev == 0) {
    for (std::size_t i = 0; i < samples.size(); ++i) visit(i, state);
    return {};
  }
  return walk_along(state, Stretch{state.nu, eps_vol, eps_dev}, samples, visit);
}

Status LightLaw::update(State& state, double eps_vol, double eps_dev, Tangent& tangent) const {
  using T = Dual<2>;
  auto moved = with_slopes<T>(state);
  const BasicStretch<T> stretch{state.nu, T(eps_vol, 0), T(eps_dev, 1)};
  if (Status status = walk_along(moved, stretch, {}, no_visit); status.failed()) return status;
  // At rest the tangent is that of the next, elastic, increment; nothing is forgotten.
  if (eps_vol == 0 && eps_dev == 0) moved.direction = with_slopes<T>(state.direction);
  for (std::size_t i = 0; i < 2; ++i) {
    tangent.P[i] = moved.P.slope[i];
    tangent.sigma_dev[i] = moved.sigma_dev.slope[i];
    tangent.F_dev[i] = moved.F_dev.slope[i];
  }
  state = values_of(moved);
  return {};
}

}  // namespace grainlaw::model
