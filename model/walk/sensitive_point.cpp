#include "grainlaw/model/walk/sensitive_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "grainlaw/model/walk/pieces.hpp"
#include "grainlaw/model/walk/system_of.hpp"
#include "grainlaw/model/walk/walk.hpp"

namespace grainlaw::model {

namespace {

/// Variables of an integration: values and slopes apart, as the integrator takes them.
template <class S, std::size_t size>
struct Variables {
  std::array<double, size> y;
  std::vector<double> s;  // [i + size k]

  Variables(const std::array<S, size>& from, std::size_t count) : s(size * count) {
    for (std::size_t i = 0; i < size; ++i) y[i] = from[i].value;
    split(from.data(), s.data(), count);
  }
  static void split(const S* from, double* to, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t i = 0; i < size; ++i) to[i + size * k] = from[i].slope[k];
  }
  static std::array<S, size> joined(const double* y, const double* s, std::size_t count) {
    std::array<S, size> out;
    for (std::size_t i = 0; i < size; ++i) {
      out[i].value = y[i];
      for (std::size_t k = 0; k < count; ++k) out[i].slope[k] = s[i + size * k];
    }
    return out;
  }
};

/// From y at the number `from` to y at t, the same number with slopes.
template <class Rates, class S, std::size_t size>
bool move_to(const Rates& rates, const S& t, double from, std::array<S, size>& y) {
  std::array<S, size> dydt;
  if (!rates(from, y, dydt)) return false;
  for (std::size_t i = 0; i < size; ++i) y[i] = y[i] + dydt[i] * (t - from);
  return true;
}

/// From a state whose P* (y[0]) is about `pressure` to where it is exactly that, in value and slopes. The
/// step is taken in P*, by the midpoint rule (Henon): in t the rates may become infinite as P* vanishes.
template <class Rates, class S, std::size_t size>
bool move_to_pressure(const Rates& rates, double pressure, S& t, std::array<S, size>& y) {
  const S way = pressure - y[0], start = t;
  const std::array<S, size> begin = y;
  for (const double part : {0.5, 1.0}) {
    std::array<S, size> dydt;
    if (!rates(t, y, dydt)) return false;
    const S step = part * way / dydt[0];
    t = start + step;
    for (std::size_t i = 0; i < size; ++i) y[i] = begin[i] + dydt[i] * step;
  }
  return true;
}

/// From the state that arrived at an event of `form` at t to the event itself, by Newton's step in t; `rest`
/// is its distance, with slopes, and `plain` the same form without any.
template <class Plain, class Rates, class S, std::size_t size>
bool move_to_event(const Plain& plain, const Stretch& stretch, const Direction& direction, const Rates& rates,
                   const S& rest, S& t, std::array<S, size>& y) {
  using D = Dual<1>;
  std::array<S, size> dydt;
  if (!rates(t, y, dydt)) return false;
  std::array<D, size> moving;
  for (std::size_t i = 0; i < size; ++i) {
    moving[i] = y[i].value;
    moving[i].slope[0] = dydt[i].value;
  }
  const D nu = stretch.nu(D(t.value, 0));
  const D distance = plain.distance_to_event(plain.coefficients(nu, direction), direction, moving.data());
  const S step = -(rest / distance.slope[0]);
  t = t + step;
  for (std::size_t i = 0; i < size; ++i) y[i] = y[i] + dydt[i] * step;
  return true;
}

/// CVODES: the values by `plain`, and d/dt of the slopes, J s_k + d rate/dp_k, from one evaluation of the
/// rate with numbers that carry them.
template <class S, class Plain>
struct BySensitiveIntegrator {
  const Plain& plain;
  Integrator& integrator;
  Integrator& plain_integrator;
  std::size_t count;
  double rtol;

  template <class Form, class Rates, class Numbers>
  bool to_event(const Form& form, const BasicStretch<S>& stretch, const BasicDirection<S>& direction,
                const Stretch& values, const Direction& direction_values, const Rates& rates, S& t,
                Numbers& y) const {
    if constexpr (std::is_base_of_v<Coupled, Plain>) return move_to_pressure(rates, smallest_pressure, t, y);
    if constexpr (std::is_same_v<Memory, Plain>)
      return move_to_event(
          plain, values, direction_values, rates,
          S(form.distance_to_event(form.coefficients(stretch.nu(t), direction), direction, y.data())), t, y);
    return false;  // the others have no events
  }

  /// The volume fraction less that at which the contacts of the pressure law begin, which goes with phi_J.
  template <class Y>
  Y above_contacts(const Stretch& stretch, const Direction& direction, double t, const Y* y) const {
    const auto& law = plain.laws.pressure;
    const double nu = stretch.nu(t);
    return nu -
           plain.jamming_density_at(plain.coefficients(nu, direction), y) * (law.contacts.nu_c / law.nu_c);
  }
  /// The same of steady shear, to whose phi_J shear leads.
  double above_contacts_of_shear(const Stretch& stretch, double t) const {
    return stretch.nu(t) - plain.laws.shear_pressure.contacts.nu_c;
  }
  /// Where that passes 0 within the stretch, or rather some roundings beyond, for there derivatives are
  /// infinite.
  void find_crossing_of_shear(const Stretch& stretch, std::vector<Crossing>& crossings) const {
    if (stretch.eps_dev == 0 || stretch.eps_vol == 0) return;
    const double beyond = 1 + std::copysign(1e-13, stretch.eps_vol),
                 t = std::log(plain.laws.shear_pressure.contacts.nu_c * beyond / stretch.nu_0) /
                     stretch.eps_vol;
    if (t > 0 && t < 1) crossings.push_back({t, stretch.eps_vol > 0, true});
  }
  /// Where above_contacts() passes 0 before the jammed part of the stretch ends: found by an integration of
  /// the values alone.
  Status find_crossings_of_pressure(System system, const Stretch& stretch, const Direction& direction,
                                    const double* begin, std::vector<Crossing>& crossings) const {
    const auto above = [&](double t, const double* y) { return above_contacts(stretch, direction, t, y); };
    system.others = {above};
    std::array<double, Plain::size> y;
    std::copy_n(begin, y.size(), y.begin());
    bool rises = above(0, begin) < 0;
    for (double t = 0; t < 1; rises = !rises) {
      if (Status status = plain_integrator.start(system, t, 1, y.data()); status.failed()) return status;
      const auto arrival = plain_integrator.advance(1, y.data());
      if (arrival.status.failed()) return arrival.status;
      if (!arrival.event || arrival.which == 1 || !(arrival.t > t && arrival.t < 1)) break;
      t = arrival.t;
      crossings.push_back({t, rises});
    }
    return {};
  }
  /// Both, in their order.
  Status find_crossings(const System& system, const Stretch& stretch, const Direction& direction,
                        const double* begin, std::vector<Crossing>& crossings) const {
    if constexpr (std::is_same_v<Memory, Plain>) {
      find_crossing_of_shear(stretch, crossings);
      if (direction.jammed)
        if (Status status = find_crossings_of_pressure(system, stretch, direction, begin, crossings);
            status.failed())
          return status;
      std::sort(crossings.begin(), crossings.end(),
                [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    }
    return {};
  }

  /// Over the gap before a crossing, from `from`. What phi_J depends on most is moved by its error to where
  /// the contacts begin, or rather some roundings beyond, for there the derivatives are infinite. On the way
  /// there from above they go as a + b h^(alpha - 1), h what is left of it: a and b follow from the rates at
  /// `from` and half-way.
  template <std::size_t size>
  bool step_over(const System& system, const Stretch& stretch, const Direction& direction, double from,
                 const Crossing& to, Variables<S, size>& at) const {
    if constexpr (std::is_same_v<Memory, Plain>) {
      const double gap = to.t - from;
      std::array<double, size> dydt;
      std::vector<double> first(at.s.size()), second(at.s.size());
      const auto rates = [&](double t, std::vector<double>& dsdt) {
        return system.rate(t, at.y.data(), dydt.data()) &&
               system.sensitivity_rate(t, at.y.data(), at.s.data(), dsdt.data());
      };
      const auto move = [&](double by) {
        for (std::size_t i = 0; i < size; ++i) at.y[i] += by * dydt[i];
      };
      if (!rates(from, first)) return false;
      if (to.rises) {
        move(gap);
        for (std::size_t i = 0; i < first.size(); ++i) at.s[i] += gap * first[i];
      } else {
        const auto above = [&](double t) {
          return to.of_shear ? above_contacts_of_shear(stretch, t)
                             : above_contacts(stretch, direction, t, at.y.data());
        };
        const auto& law = to.of_shear ? plain.laws.shear_pressure : plain.laws.pressure;
        const double high = above(from), alpha = law.contacts.alpha;
        move(gap / 2);
        const double low = above(from + gap / 2);
        if (!(high > low && low > 0) || !rates(from + gap / 2, second)) return false;
        move(gap / 2);
        // What is left of the way, in t, as the volume fraction above the contacts has it.
        const double h = high / (high - low) * gap / 2, rest = h - gap / 2;
        const double at_first = std::pow(h, alpha - 1), at_second = std::pow(rest, alpha - 1);
        for (std::size_t i = 0; i < first.size(); ++i) {
          const double b = (second[i] - first[i]) / (at_second - at_first), a = first[i] - b * at_first;
          at.s[i] += a * gap + b * std::pow(h, alpha) / alpha;
        }
      }
      if (to.of_shear) return true;  // where that is does not hang on the variables
      std::array<Dual<size>, size> y;
      for (std::size_t i = 0; i < size; ++i) y[i] = Dual<size>(at.y[i], i);
      const Dual<size> above = above_contacts(stretch, direction, to.t, y.data());
      std::size_t most = 0;
      for (std::size_t i = 1; i < size; ++i)
        if (std::abs(above.slope[i]) > std::abs(above.slope[most])) most = i;
      if (above.slope[most] != 0)
        at.y[most] -= (above.value - (to.rises ? 1e-13 : -1e-13)) / above.slope[most];
    }
    return true;
  }

  template <class Form, class NextSample, class Visit>
  Reached<S> operator()(const Form& form, BasicState<S>& state, const BasicStretch<S>& stretch,
                        NextSample next_sample, Visit visit) const {
    constexpr std::size_t size = Form::size;
    using Both = Variables<S, size>;
    const BasicState<S> begin = state;
    const Stretch values = values_of(stretch);
    const Direction direction = values_of(begin.direction);
    System system = system_of(plain, values, direction);
    using Numbers = std::array<S, size>;
    const auto rates = [&](const S& t, const Numbers& y, Numbers& dydt) {
      return rate_at(form, stretch, begin.direction, t, y.data(), dydt.data());
    };
    system.sensitivity_rate = [&](double t, const double* y, const double* s, double* dsdt) {
      Numbers dydt;
      if (!rates(t, Both::joined(y, s, count), dydt)) return false;
      Both::split(dydt.data(), dsdt, count);
      return true;
    };
    Both at(form.variables(begin), count);
    std::vector<Crossing> crossings;
    if (Status status = find_crossings(system, values, direction, at.y.data(), crossings); status.failed())
      return {status, 0.0};
    const std::vector<Piece> pieces = pieces_of(crossings, std::max(1e-6, 100 * rtol));
    auto piece = pieces.begin();
    System mapped;
    const auto start = [&] {
      mapped = over(*piece, system, size, count);
      return integrator.start(mapped, 0, 1, at.y.data(), at.s.data());
    };
    if (Status status = start(); status.failed()) return {status, 0.0};
    for (bool last = false; !last;) {
      S t = next_sample();
      last = !(t <= 1);
      if (last) t = 1.0;
      auto arrival = integrator.advance(piece->tau(t.value), at.y.data(), at.s.data());
      while (!arrival.status.failed() && !arrival.event && t.value > piece->end) {
        const double from = piece->end;
        ++piece;
        const Crossing& crossing = crossings[static_cast<std::size_t>(piece - pieces.begin()) - 1];
        if (!step_over<size>(system, values, direction, from, crossing, at))
          return {{Status::Code::failed, "the law is not defined where its contacts begin"}, from};
        if (t.value < piece->begin) t = piece->begin;
        if (Status status = start(); status.failed()) return {status, piece->begin};
        arrival = integrator.advance(piece->tau(t.value), at.y.data(), at.s.data());
      }
      arrival.t = arrival.event || arrival.status.failed() ? piece->t(arrival.t) : t.value;
      if (arrival.status.failed()) return {arrival.status, arrival.t};
      // Where a sample or an event lies depends on the variables too.
      Numbers y = Both::joined(at.y.data(), at.s.data(), count);
      bool defined = true;
      if (arrival.event)
        defined = to_event(form, stretch, begin.direction, values, direction, rates, t = arrival.t, y);
      else if (t.slope != S().slope)
        defined = move_to(rates, t, arrival.t, y);
      if (!defined)
        return {{Status::Code::failed, "the law is not defined where it is to be differentiated"}, arrival.t};
      state = form.state(begin, stretch, t, y.data());
      if (arrival.event) return {{}, t, true};
      if (!last) visit(state);
    }
    return {};
  }
};

}  // namespace

template <class S>
SensitivePoint<S>::SensitivePoint(Law law, BasicLaw<S> slopes_law, const BasicState<S>& start,
                                  Tolerance tolerance, const std::vector<double>& scales, Method method)
    : law_(std::move(law)),
      slopes_law_(std::move(slopes_law)),
      state_(start),
      count_(scales.size()),
      rtol_(tolerance.rtol) {
  std::visit(
      [&]<class Form>(const Form&) {
        if constexpr (Form::size > 0) {
          integrator_.emplace(static_cast<int>(Form::size), tolerance, method, scales);
          plain_.emplace(static_cast<int>(Form::size), tolerance, method);
        }
      },
      law_);
}

template <class S>
Status SensitivePoint<S>::walk(double eps_vol, double eps_dev, std::span<const double> samples,
                               const Visit& visit) {
  if (auto reason = not_finite(state_, eps_vol, eps_dev)) return {Status::Code::failed, *reason};
  if (eps_vol == 0 && eps_dev == 0) {
    for (std::size_t i = 0; i < samples.size(); ++i) visit(i, state_);
    return {};
  }
  const BasicStretch<S> whole{state_.nu, eps_vol, eps_dev};
  if (auto reason = objection(law_, values_of(whole))) return {Status::Code::failed, *reason};
  const BasicState<S> before = state_;
  const std::size_t events_before = events_.size();
  const auto note = [&](bool jammed, const BasicState<S>& state) {
    events_.push_back({jammed, state.nu, state.eps_vol, state.eps_dev});
  };
  const auto along = [&](const auto& form, auto solver) {
    return Walk(form, state_, Course<S>(whole, samples), solver, visit, note).run();
  };
  Status status = std::visit(
      [&]<template <class> class Form>(const Form<S>& form) {
        if constexpr (Form<S>::size == 0)
          return along(form, Closed{});
        else
          return along(form, BySensitiveIntegrator<S, Form<double>>{std::get<Form<double>>(law_),
                                                                    *integrator_, *plain_, count_, rtol_});
      },
      slopes_law_);
  if (!status.failed()) return status;
  status.message += " (nu = " + shown(state_.nu.value) + ", eps_dev = " + shown(state_.eps_dev.value) + ")";
  state_ = before;
  events_.resize(events_before);
  return status;
}

template class SensitivePoint<Slopes>;
template class SensitivePoint<FewSlopes>;

}  // namespace grainlaw::model
