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

/// The rates of a form along a stretch. Coefficients are taken once where the volume rests; where only its
/// slopes move, they do so in proportion to t; else they are taken anew at every stage.
template <class F, class T>
class StretchRate {
 public:
  using Coefficients =
      decltype(std::declval<F>().coefficients(std::declval<T>(), std::declval<BasicDirection<T>>()));

  StretchRate(const F& form, const BasicStretch<T>& stretch, const BasicDirection<T>& direction,
              const Coefficients& at_start)
      : form_(form), stretch_(stretch), direction_(direction), at_start_(at_start) {
    if constexpr (!std::is_same_v<T, double>)
      if (rests()) at_end_ = form.coefficients(stretch.nu(T(1.0)), direction);
  }

  template <class X, class Y>
  bool operator()(const X& t, const Y* y, Y* dydt) const {
    if (!rests()) return rate_at(form_, stretch_, direction_, t, y, dydt);
    if constexpr (std::is_same_v<T, double>)
      return form_.rate(at_start_, stretch_, direction_, y, dydt);
    else
      return form_.rate(F::between(at_start_, at_end_, t), stretch_, direction_, y, dydt);
  }
  /// What reaches 0 where the stretch is to be left.
  template <class X, class Y>
  auto event(const X& t, const Y* y) const {
    if constexpr (requires { F::goes_on_unjammed; })
      if (!rests())
        return form_.distance_to_event(form_.coefficients(stretch_.nu(t), direction_), direction_, y);
    return form_.distance_to_event(at_start_, direction_, y);
  }
  /// How much of what changes along the whole stretch would be made up for in it, at the rate with which the
  /// point relaxes or its volume leaves the neighbourhood of jamming.
  double relaxations(const T* y) const {
    double sum = form_.relaxation(at_start_, stretch_, direction_, y);
    if (!rests())
      sum += std::abs(value(stretch_.eps_vol)) /
             (std::abs(std::log(value(stretch_.nu_0) / value(form_.unjamming_density()))) + 1e-6);
    return sum;
  }
  std::array<double, F::size> scales(const T* y) const { return form_.scales(at_start_, y); }

 private:
  bool rests() const { return value(stretch_.eps_vol) == 0; }

  const F& form_;
  const BasicStretch<T>& stretch_;
  const BasicDirection<T>& direction_;
  Coefficients at_start_, at_end_;
};

/// Carries variables along a stretch.
template <class F, class T>
class LightRun {
 public:
  static constexpr std::size_t n = F::size;
  using Variables = std::array<T, n>;
  using Rate = StretchRate<F, T>;

  LightRun(const Rate& rate, const Variables& begin, Tolerance tolerance, LightMethod method)
      : rate_(rate), y_(begin), tolerance_(tolerance), method_(method) {}

  enum class End { there, event, failed };
  /// Goes on to t = `to` in (t(), 1], or to where `event(y)` falls to 0. Its sign at the start must be > 0.
  template <class Event>
  End advance(double to, Event event) {
    for (int steps = 0; t_ < to; ++steps) {
      if (steps == most_steps) return End::failed;
      const double left = to - t_;
      double h = step_ > 0 ? std::min(step_, left) : left;
      const LightMethod method = method_ == LightMethod::automatic ? choose(h) : method_;
      if (step_ <= 0 && method != LightMethod::explicit_third) h = std::min(left, first_step(left));
      if (left - h < 1e-13) h = left;
      Trial<T, n> trial;
      const auto error = try_step(method, h, trial);
      if (!error || *error > 1) {
        step_ = h * (error ? std::max(0.2, 0.9 * std::pow(*error, -1.0 / order(method))) : 0.25);
        known_ = known_ && method != LightMethod::rosenbrock;  // the rate at the start holds
        if (t_ + step_ <= t_) return End::failed;
        continue;
      }
      if (!(event(t_ + h, trial.y) > 0)) return find_event(method, h, event);
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

  LightMethod choose(double h) const {
    const double all = rate_.relaxations(y_.data());
    if (!(all * (1 - t_) < stiff)) return LightMethod::rosenbrock;
    const double z = all * h;
    return z * z * z < 12 * light_safety_third * tolerance_.rtol ? LightMethod::explicit_third
                                                                 : LightMethod::explicit_fifth;
  }
  double first_step(double left) const {
    const double lambda = rate_.relaxations(y_.data());
    return lambda > 0 ? std::min(left, 2 * std::pow(light_safety * tolerance_.rtol, 1. / 6) / lambda) : left;
  }

  /// The error over what is allowed; nothing where a stage is not defined.
  std::optional<double> try_step(LightMethod method, double h, Trial<T, n>& trial) {
    bool defined = false;
    if (method == LightMethod::rosenbrock) {
      defined = rosenbrock_step(rate_, y_, t_, h, trial);
    } else {
      if (!known_) {
        if (!rate_(T(t_), y_.data(), start_rate_.data())) return std::nullopt;
        known_ = true;
      }
      const auto rate = [&](double c, const T* y, T* dydt) { return rate_(T(t_ + c * h), y, dydt); };
      defined = method == LightMethod::explicit_third ? explicit_step<BogackiShampine>(rate, h, trial)
                                                      : explicit_step<DormandPrince>(rate, h, trial);
    }
    if (!defined) return std::nullopt;
    const auto scale = rate_.scales(y_.data());
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double error = std::abs(value(trial.error[i])) / (tolerance_.rtol * scale[i] + tolerance_.atol);
      if (!std::isfinite(error) || !std::isfinite(value(trial.y[i]))) return std::nullopt;
      worst = std::max(worst, error);
    }
    return worst / safety(method);
  }

  template <class Pair, class StageRate>
  bool explicit_step(const StageRate& rate, double h, Trial<T, n>& trial) {
    std::array<std::array<T, n>, Pair::stages> k;
    k[0] = start_rate_;
    if (!trial_step<Pair>(rate, y_, h, k, trial)) return false;
    end_rate_ = k[Pair::stages - 1];
    return true;
  }

  void accept(LightMethod method, double h, const Trial<T, n>& trial) {
    y_ = trial.y;
    t_ += h;
    known_ = method != LightMethod::rosenbrock;
    if (known_) start_rate_ = end_rate_;
  }

  /// A step over h passes the event: the longest step that does not is taken, and slopes of the time at which
  /// it comes go into the variables by the caller.
  template <class Event>
  End find_event(LightMethod method, double h, Event event) {
    double low = 0, high = h;
    Trial<T, n> trial, best;
    for (int i = 0; i < 100 && high - low > 1e-16 * h; ++i) {
      const double middle = 0.5 * (low + high);
      const auto error = try_step(method, middle, trial);
      if (error && event(t_ + middle, trial.y) > 0) {
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
  bool known_ = false;  // start_rate_ is the rate at (t_, y_)
  Variables start_rate_, end_rate_;
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
    if constexpr (F::size == 0)
      return Closed{}(form, state, stretch, next_sample, visit);
    else
      return run(form, state, stretch, form.coefficients(stretch.nu_0, state.direction), next_sample, visit);
  }

  /// The same where the coefficients at the start are known.
  template <class F, class T, class Coefficients, class NextSample, class Visit>
  Reached<T> run(const F& form, BasicState<T>& state, const BasicStretch<T>& stretch, const Coefficients& c,
                 NextSample next_sample, Visit visit) const {
    const BasicState<T> begin = state;
    const StretchRate<F, T> rate(form, stretch, begin.direction, c);
    LightRun<F, T> run(rate, form.variables(begin), tolerance, method);
    for (bool last = false; !last;) {
      T t = next_sample();
      last = !(t <= 1);
      if (last) t = 1.0;
      const auto end =
          run.advance(value(t), [&](double at, const auto& y) { return value(rate.event(at, y.data())); });
      using End = typename LightRun<F, T>::End;
      if (end == End::failed)
        return {{Status::Code::failed, "the step became too small, or steps too many"}, run.t()};
      if (end == End::event) t = event_time<F>(rate, run);
      const auto y = at_time<F>(rate, run.y(), t);
      state = form.state(begin, stretch, t, y.data());
      if (end == End::event) return {{}, t, true};
      if (!last) visit(state);
    }
    return {};
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
      const auto g = rate.event(D(T(run.t()), 0), y.data());
      if constexpr (std::is_same_v<decltype(g), const double>)
        return run.t();  // no event of its own
      else
        return run.t() - (g.value - value(g)) / value(g.slope[0]);
    }
  }
};

}  // namespace grainlaw::model
