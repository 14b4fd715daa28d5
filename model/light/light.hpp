// The light path: a solver of Walk without allocation, for hosts that come with one small increment after
// another. Explicit pairs of Runge and Kutta while nothing is stiff, RODAS where saturation comes within a
// small part of the increment; the error of each step is held below a part of the tolerance. With dual
// scalars it differentiates itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "grainlaw/model/forms/coupled.hpp"
#include "grainlaw/model/forms/reduced.hpp"
#include "grainlaw/model/light/explicit_pair.hpp"
#include "grainlaw/model/light/rosenbrock.hpp"
#include "grainlaw/model/walk/integrator.hpp"
#include "grainlaw/model/walk/walk.hpp"

namespace grainlaw::model {

/// Errors of steps add up along a path, P* forgets none: each is held to this part of the tolerance.
inline constexpr double light_safety = 0.002;

/// The same of the pair 3(2). Its third order goes on while the second is estimated, z^3/12 with z
/// relaxations in the step, so that what errs, z^4/24, adds up in proportion to the strain and to the
/// tolerance.
inline constexpr double light_safety_third = 0.016;

/// Which method a light step takes.
enum class LightMethod {
  automatic,       ///< the cheapest that the stretch allows
  explicit_third,  ///< Bogacki-Shampine 3(2)
  explicit_fifth,  ///< Dormand-Prince 5(4)
  rosenbrock       ///< RODAS 4(3)
};

/// What the rates of a form depend on besides the variables, and whatever of it a form knows of them: its
/// here(), or the coefficients themselves.
template <class F, class C, class S, class Y>
auto here_of(const F& form, const C& c, const BasicDirection<S>& direction, const Y* y) {
  if constexpr (requires { form.here(c, direction, y); })
    return form.here(c, direction, y);
  else
    return c;
}

/// What the coefficients of a form along a stretch have in common: its common(), or nothing.
struct NothingCommon {};
template <class F, class C, class T>
auto common_of(const F& form, const C& at_start, const BasicStretch<T>& stretch,
               const BasicDirection<T>& direction) {
  if constexpr (requires { form.common(at_start, stretch, direction); })
    return form.common(at_start, stretch, direction);
  else
    return NothingCommon{};
}

/// The rates of a form along a stretch. Coefficients are taken once where the volume rests; where only its
/// slopes move, they do so in proportion to t; else they are taken anew at every stage.
template <class F, class T>
class StretchRate {
 public:
  using Coefficients =
      decltype(std::declval<F>().coefficients(std::declval<T>(), std::declval<BasicDirection<T>>()));
  using Here = decltype(here_of(std::declval<F>(), std::declval<Coefficients>(),
                                std::declval<BasicDirection<T>>(), std::declval<const T*>()));

  using Common = decltype(common_of(std::declval<F>(), std::declval<Coefficients>(),
                                    std::declval<BasicStretch<T>>(), std::declval<BasicDirection<T>>()));

  StretchRate(const F& form, const BasicStretch<T>& stretch, const BasicDirection<T>& direction)
      : StretchRate(form, stretch, direction, form.coefficients(stretch.nu_0, direction)) {}
  StretchRate(const F& form, const BasicStretch<T>& stretch, const BasicDirection<T>& direction,
              const Coefficients& at_start)
      : form_(form),
        stretch_(stretch),
        direction_(direction),
        at_start_(at_start),
        common_(common_of(form, at_start, stretch, direction)) {
    if constexpr (!std::is_same_v<T, double>)
      if (rests()) at_end_ = coefficients(T(1.0));
  }

  Here here(const T& t, const T* y) const {
    return with_coefficients(t, [&](const auto& c) { return here_of(form_, c, direction_, y); });
  }
  template <class X, class Y>
  bool operator()(const X& t, const Y* y, Y* dydt) const {
    return with_coefficients(t, [&](const auto& c) { return form_.rate(c, stretch_, direction_, y, dydt); });
  }
  /// Of what is there.
  bool from(const Here& here, const T* y, T* dydt) const {
    return form_.rate(here, stretch_, direction_, y, dydt);
  }
  /// The same, which tells what is there.
  bool operator()(const T& t, const T* y, T* dydt, Here& here) const {
    here = this->here(t, y);
    return from(here, y, dydt);
  }
  /// What reaches 0 where the stretch is to be left.
  T event(const Here& here, const T* y) const { return form_.distance_to_event(here, direction_, y); }
  template <class X, class Y>
  auto event_at(const X& t, const Y* y) const {
    return with_coefficients(t, [&](const auto& c) { return form_.distance_to_event(c, direction_, y); });
  }
  /// How much of what changes along the whole stretch would be made up for in it, at the rate with which the
  /// point relaxes or its volume leaves the neighbourhood of jamming.
  double relaxations(const Here& here, const T* y) const {
    double sum = form_.relaxation(here, stretch_, direction_, y);
    if (!rests())
      sum += std::abs(value(stretch_.eps_vol)) /
             (std::abs(std::log(value(stretch_.nu_0) / value(form_.unjamming_density()))) + 1e-6);
    return sum;
  }
  std::array<double, F::size> scales(const Here& here, const T* y) const { return form_.scales(here, y); }

 private:
  bool rests() const { return value(stretch_.eps_vol) == 0; }
  template <class X>
  auto coefficients(const X& t) const {
    if constexpr (std::is_same_v<Common, NothingCommon>)
      return form_.coefficients(stretch_.nu(t), direction_);
    else
      return form_.coefficients(stretch_.nu(t), common_);
  }
  template <class X, class Use>
  auto with_coefficients(const X& t, Use use) const {
    if (!rests()) return use(coefficients(t));
    if constexpr (std::is_same_v<T, double>)
      return use(at_start_);
    else
      return use(F::between(at_start_, at_end_, t));
  }

  const F& form_;
  const BasicStretch<T>& stretch_;
  const BasicDirection<T>& direction_;
  Coefficients at_start_, at_end_;
  Common common_;
};

/// Carries variables along a stretch.
template <class F, class T>
class LightRun {
 public:
  static constexpr std::size_t n = F::size;
  using Variables = std::array<T, n>;
  using Rate = StretchRate<F, T>;

  using Here = typename Rate::Here;

  /// From the variables `begin`; `here` is what is there, if that is known.
  LightRun(const Rate& rate, const Variables& begin, Tolerance tolerance, LightMethod method,
           const Here* here = nullptr)
      : rate_(rate), y_(begin), tolerance_(tolerance), method_(method) {
    if (!here || !rate.from(*here, begin.data(), start_rate_.data())) return;
    start_here_ = *here;
    known_ = true;
  }

  enum class End { there, event, failed };
  /// Goes on to t = `to` in (t(), 1], or to where the event comes.
  End advance(double to) {
    for (int steps = 0; t_ < to; ++steps) {
      if (steps == most_steps || !known()) return End::failed;
      const double left = to - t_;
      double h = step_ > 0 ? std::min(step_, left) : left;
      const LightMethod method = method_ == LightMethod::automatic ? choose(h) : method_;
      if (step_ <= 0 && method != LightMethod::explicit_third) h = std::min(left, first_step(left));
      if (left - h < 1e-13) h = left;
      Trial<T, n> trial;
      const auto error = try_step(method, h, trial);
      if (!error || *error > 1) {
        step_ = h * (error ? std::max(0.2, 0.9 * std::pow(*error, -1.0 / order(method))) : 0.25);
        if (t_ + step_ <= t_) return End::failed;
        continue;
      }
      if (passes_event(trial)) return find_event(method, h);
      accept(method, h, trial);
      if (h == left) t_ = to;
      const double growth = *error > 0 ? 0.9 * std::pow(*error, -1.0 / order(method)) : 5;
      if (h < left || *error > 0.5)
        step_ = h * std::clamp(growth, 0.2, 5.0);
      else if (step_ > 0)
        step_ = std::max(step_, h * std::clamp(growth, 1.0, 5.0));
    }
    return End::there;
  }

  double t() const { return t_; }
  const Variables& y() const { return y_; }
  /// What is there, if that is known.
  const Here* here() const { return known_ ? &start_here_ : nullptr; }

 private:
  static constexpr int most_steps = 100'000;
  /// Relaxations within a stretch from which explicit steps would be many.
  static constexpr double stiff = 150;

  /// The power of the step that the estimated error goes with.
  static int order(LightMethod method) {
    switch (method) {
      case LightMethod::explicit_fifth:
        return DormandPrince::order;
      case LightMethod::rosenbrock:
        return Rodas::order;
      default:
        return BogackiShampine::order;
    }
  }
  static double safety(LightMethod method) {
    return method == LightMethod::explicit_third ? light_safety_third : light_safety;
  }

  /// Whether the rate is defined here; then start_rate_ and start_here_ are those at (t_, y_).
  bool known() {
    if (!known_) known_ = rate_(T(t_), y_.data(), start_rate_.data(), start_here_);
    return known_;
  }

  LightMethod choose(double h) const {
    const double all = rate_.relaxations(start_here_, y_.data());
    if (!(all * (1 - t_) < stiff)) return LightMethod::rosenbrock;
    const double z = all * h;
    return z * z * z < 12 * light_safety_third * tolerance_.rtol ? LightMethod::explicit_third
                                                                 : LightMethod::explicit_fifth;
  }
  double first_step(double left) const {
    const double lambda = rate_.relaxations(start_here_, y_.data());
    return lambda > 0 ? std::min(left, 2 * std::pow(light_safety * tolerance_.rtol, 1. / 6) / lambda) : left;
  }

  /// The error over what is allowed; nothing where a stage is not defined. end_here_ becomes what is at the
  /// end, with an explicit pair end_rate_ the rate there.
  std::optional<double> try_step(LightMethod method, double h, Trial<T, n>& trial) {
    bool defined = false;
    if (method == LightMethod::rosenbrock)
      defined = rosenbrock_step(rate_, y_, t_, h, trial);
    else if (method == LightMethod::explicit_third)
      defined = explicit_step<BogackiShampine>(h, trial);
    else
      defined = explicit_step<DormandPrince>(h, trial);
    if (!defined) return std::nullopt;
    const auto scale = rate_.scales(start_here_, y_.data());
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double error = std::abs(value(trial.error[i])) / (tolerance_.rtol * scale[i] + tolerance_.atol);
      if (!std::isfinite(error) || !std::isfinite(value(trial.y[i]))) return std::nullopt;
      worst = std::max(worst, error);
    }
    if (method == LightMethod::rosenbrock) end_here_ = rate_.here(T(t_ + h), trial.y.data());
    return worst / safety(method);
  }

  template <class Pair>
  bool explicit_step(double h, Trial<T, n>& trial) {
    std::array<std::array<T, n>, Pair::stages> k;
    k[0] = start_rate_;
    const auto rate = [&](double c, const T* y, T* dydt) { return rate_(T(t_ + c * h), y, dydt, end_here_); };
    if (!trial_step<Pair>(rate, y_, h, k, trial)) return false;
    end_rate_ = k[Pair::stages - 1];
    return true;
  }

  bool passes_event(const Trial<T, n>& trial) const {
    return !(value(rate_.event(end_here_, trial.y.data())) > 0);
  }

  void accept(LightMethod method, double h, const Trial<T, n>& trial) {
    y_ = trial.y;
    t_ += h;
    known_ = method != LightMethod::rosenbrock;
    if (!known_) return;
    start_rate_ = end_rate_;
    start_here_ = end_here_;
  }

  /// A step over h passes the event: the longest step that does not is taken, and slopes of the time at which
  /// it comes go into the variables by the caller.
  End find_event(LightMethod method, double h) {
    double low = 0, high = h;
    Trial<T, n> trial, best;
    for (int i = 0; i < 100 && high - low > 1e-16 * h; ++i) {
      const double middle = 0.5 * (low + high);
      const auto error = try_step(method, middle, trial);
      if (error && !passes_event(trial)) {
        low = middle;
        best = trial;
      } else {
        high = middle;
      }
    }
    if (low > 0) accept(method, low, best);
    known_ = false;
    return End::event;
  }

  const Rate& rate_;
  Variables y_;
  Tolerance tolerance_;
  LightMethod method_;
  double t_ = 0;
  double step_ = 0;     // proposed; 0: none yet
  bool known_ = false;  // start_rate_ and start_here_ are those at (t_, y_)
  Variables start_rate_, end_rate_;
  Here start_here_, end_here_;
};

/// Numbers of slope along a path that ends or is looked at where t has slopes of its own: y(t) with those of
/// t.
template <class F, class T, class Rate>
std::array<T, F::size> at_time(const Rate& rate, const std::array<T, F::size>& y, const T& t) {
  if constexpr (std::is_same_v<T, double>) {
    return y;
  } else {
    std::array<T, F::size> dydt, moved = y;
    if (!rate(T(value(t)), y.data(), dydt.data())) return y;
    for (std::size_t i = 0; i < F::size; ++i) moved[i] = moved[i] + dydt[i] * (t - value(t));
    return moved;
  }
}

/// A solver of Walk.
struct Light {
  Tolerance tolerance;
  LightMethod method = LightMethod::automatic;

  template <class F, class T, class NextSample, class Visit>
  Reached<T> operator()(const F& form, BasicState<T>& state, const BasicStretch<T>& stretch,
                        NextSample next_sample, Visit visit) const {
    if constexpr (F::size == 0) {
      return Closed{}(form, state, stretch, next_sample, visit);
    } else {
      const BasicState<T> begin = state;
      const StretchRate<F, T> rate(form, stretch, begin.direction);
      LightRun<F, T> run(rate, form.variables(begin), tolerance, method);
      return go(form, state, begin, stretch, rate, run, next_sample, visit);
    }
  }

  /// The run from `begin` over the whole stretch.
  template <class F, class T, class NextSample, class Visit>
  Reached<T> go(const F& form, BasicState<T>& state, const BasicState<T>& begin,
                const BasicStretch<T>& stretch, const StretchRate<F, T>& rate, LightRun<F, T>& run,
                NextSample next_sample, Visit visit) const {
    for (bool last = false; !last;) {
      T t = next_sample();
      last = !(t <= 1);
      if (last) t = 1.0;
      const auto end = run.advance(value(t));
      using End = typename LightRun<F, T>::End;
      if (end == End::failed)
        return {{Status::Code::failed, "the step became too small, or steps too many"}, run.t()};
      if (end == End::event) t = event_time<F>(rate, run);
      state = state_at(form, begin, stretch, t, at_time<F>(rate, run.y(), t), run);
      if (end == End::event) return {{}, t, true};
      if (!last) visit(state);
    }
    return {};
  }

  template <class F, class T>
  static BasicState<T> state_at(const F& form, const BasicState<T>& begin, const BasicStretch<T>& stretch,
                                const T& t, const std::array<T, F::size>& y, const LightRun<F, T>& run) {
    if constexpr (std::is_same_v<T, double> &&
                  requires { form.state(begin, stretch, t, y.data(), run.here()); })
      return form.state(begin, stretch, t, y.data(), run.here());
    else
      return form.state(begin, stretch, t, y.data());
  }

  /// The time of the event with its slopes: those of g(y, t) = 0, -g_p/g_t.
  template <class F, class T, class Rate>
  static T event_time(const Rate& rate, const LightRun<F, T>& run) {
    if constexpr (std::is_same_v<T, double>) {
      return run.t();
    } else {
      std::array<T, F::size> dydt;
      if (!rate(T(run.t()), run.y().data(), dydt.data())) return run.t();
      using D = Dual<1, T>;
      std::array<D, F::size> y;
      for (std::size_t i = 0; i < F::size; ++i) {
        y[i] = run.y()[i];
        y[i].slope[0] = dydt[i];
      }
      const auto g = rate.event_at(D(T(run.t()), 0), y.data());
      if constexpr (std::is_same_v<decltype(g), const double>)
        return run.t();  // no event of its own
      else
        return run.t() - (g.value - value(g)) / value(g.slope[0]);
    }
  }
};

}  // namespace grainlaw::model
