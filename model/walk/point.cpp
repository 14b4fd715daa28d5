#include "grainlaw/model/walk/point.hpp"

#include <cmath>
#include <utility>

#include "grainlaw/model/walk/system_of.hpp"

namespace grainlaw::model {

namespace {

/// The solver of a Walk by CVODE.
struct ByIntegrator {
  Integrator& integrator;

  template <class Form, class NextSample, class Visit>
  Reached<double> operator()(const Form& form, State& state, const Stretch& stretch, NextSample next_sample,
                             Visit visit) const {
    const State begin = state;
    const System system = system_of(form, stretch, begin.direction);
    auto y = form.variables(begin);
    if (Status status = integrator.start(system, 0, 1, y.data()); status.failed()) return {status, 0.0};
    for (bool last = false; !last;) {
      const double t = next_sample();
      last = !(t <= 1);
      const auto arrival = integrator.advance(last ? 1 : t, y.data());
      if (arrival.status.failed()) return {arrival.status, arrival.t};
      state = form.state(begin, stretch, arrival.t, y.data());
      if (arrival.event) return {{}, arrival.t, true};
      if (!last) visit(state);
    }
    return {};
  }
};

}  // namespace

MaterialPoint::MaterialPoint(Law law, const State& start, Tolerance tolerance, Method method)
    : law_(std::move(law)), state_(start) {
  std::visit(
      [&]<class Form>(const Form&) {
        if constexpr (Form::size > 0) integrator_.emplace(static_cast<int>(Form::size), tolerance, method);
      },
      law_);
}

Status MaterialPoint::walk(double eps_vol, double eps_dev, std::span<const double> samples,
                           const Visit& visit) {
  const Stretch whole{state_.nu, eps_vol, eps_dev};
  if (auto reason = not_finite(state_, eps_vol, eps_dev)) return {Status::Code::failed, *reason};
  if (eps_vol == 0 && eps_dev == 0) {
    for (std::size_t i = 0; i < samples.size(); ++i) visit(i, state_);
    return {};
  }
  if (auto reason = objection(law_, whole)) return {Status::Code::failed, *reason};
  const State before = state_;
  const std::size_t events_before = events_.size();
  const auto note = [&](bool jammed, const State& state) {
    events_.push_back({jammed, state.nu, state.eps_vol, state.eps_dev});
  };
  Status status = std::visit(
      [&]<class Form>(const Form& form) {
        if constexpr (Form::size == 0)
          return Walk(form, state_, Course<double>(whole, samples), Closed{}, visit, note).run();
        else
          return Walk(form, state_, Course<double>(whole, samples), ByIntegrator{*integrator_}, visit, note)
              .run();
      },
      law_);
  if (!status.failed()) return status;
  status.message += " (nu = " + shown(state_.nu) + ", eps_dev = " + shown(state_.eps_dev) + ")";
  state_ = before;
  events_.resize(events_before);
  return status;
}

}  // namespace grainlaw::model
