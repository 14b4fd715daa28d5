#include "grainlaw/model/walk/controlled.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "grainlaw/model/columns.hpp"
#include "grainlaw/model/walk/steered.hpp"

namespace grainlaw::model {

double StopCondition::excess(const Law& law, const State& state) const {
  const double x = column_value(column, law, state) - value;
  return above ? x : -x;
}

namespace {

using Controls = std::array<Prescribed, 2>;
using Ended = Controlled::Ended;

/// Contact may be lost and found again, and shear reversed, this often on one segment.
constexpr int most_phases = 1000;

Status failed(std::string message) { return {Status::Code::failed, std::move(message)}; }

/// "P = 0.02 of 0.03"
std::string progress_of(const Prescribed& control, const State& state) {
  return control.name + " = " + shown(control.value(state)) +
         (control.change() == 0 ? " (to be kept)" : " on the way to " + shown(control.end));
}

/// Strains as functions of t where both controls are strains.
class StrainCourse {
 public:
  StrainCourse(const Controls& controls, const State& begin) : controls_(controls), begin_(begin) {}

  State at(double t) const {
    std::array<std::array<double, 2>, 2> a{};
    std::array<double, 2> b{};
    for (std::size_t i = 0; i < 2; ++i) {
      const Prescribed& control = controls_[i];
      const bool is_nu = control.kind == Prescribed::Kind::nu;
      a[i] =
          is_nu ? std::array<double, 2>{1, 0} : std::array<double, 2>{control.weight[0], control.weight[1]};
      b[i] = is_nu ? begin_.eps_vol + std::log(control.wanted(t) / begin_.nu) : control.wanted(t);
    }
    const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    State state = begin_;
    state.eps_vol = (b[0] * a[1][1] - b[1] * a[0][1]) / determinant;
    state.eps_dev = (a[0][0] * b[1] - a[1][0] * b[0]) / determinant;
    state.nu = begin_.nu * std::exp(state.eps_vol - begin_.eps_vol);
    return state;
  }
  /// The rest of the segment from t on, at the rates there.
  Stretch ahead(double t) const {
    constexpr double step = 1e-6;
    const State here = at(t), there = at(t + step);
    return {here.nu, (there.eps_vol - here.eps_vol) / step, (there.eps_dev - here.eps_dev) / step};
  }

 private:
  const Controls& controls_;
  State begin_;
};

/// The first t in (from, to] where `holds`, which does at `to`, not at `from`, and changes once.
template <class Holds>
double first_where(double from, double to, Holds holds) {
  return turning_point(from, to, [&](double t) { return !holds(t); });
}

template <class Form>
class ControlledWalk {
 public:
  ControlledWalk(const Form& form, const Law& law, State& state, const Controls& controls,
                 const std::optional<StopCondition>& stop, std::span<const double> samples,
                 const MaterialPoint::Visit& visit, Integrator& integrator, std::vector<Event>& events)
      : form_(form),
        law_(law),
        state_(state),
        begin_(state),
        controls_(controls),
        stop_(stop),
        samples_(samples),
        visit_(visit),
        integrator_(integrator),
        events_(events) {}

  Ended run() {
    for (int phase = 0;; ++phase) {
      if (phase == most_phases) return end(too_often());
      if (stop_ && stop_->excess(law_, state_) >= 0) stopped_ = true;
      if (stopped_ || t_ >= 1) break;
      if (Status status = state_.jammed || goes_on_unjammed ? walk_piece() : walk_unjammed();
          status.failed() || status.code == Status::Code::limit)
        return end(std::move(status));
    }
    if (!stopped_) visit_up_to(1, [&](double) { return state_; });
    return end({});
  }

 private:
  /// What may end a piece, beside its end.
  enum class Cause { reached, no_pressure, no_contacts, limit, reversal, shear, volume, stop };
  /// Whether the form integrates without contacts as well, and finds both events itself.
  static constexpr bool goes_on_unjammed = requires { Form::goes_on_unjammed; };
  static constexpr int most_turns = 100;  // of the volume: beyond them it trembles

  bool by_stress() const { return controls_[0].by_stress() || controls_[1].by_stress(); }

  /// Under stress neither direction of shear lasts then: there is none.
  Status too_often() const {
    const char* why = "contact is lost and found, or shear reversed, again and again without end";
    return by_stress() ? at_limit(why) : failed(why);
  }

  Ended end(Status status) const { return {std::move(status), t_, stopped_}; }

  Status at_limit(const std::string& why) const {
    return {Status::Code::limit, why + ": " + progress_of(controls_[0], state_) + ", " +
                                     progress_of(controls_[1], state_) + ", at nu = " + shown(state_.nu) +
                                     ", eps_dev = " + shown(state_.eps_dev)};
  }

  double next_sample() const { return next_ < samples_.size() ? std::max(samples_[next_], t_) : 2; }
  template <class At>
  void visit_up_to(double t, At at) {
    while (next_ < samples_.size() && samples_[next_] <= t) {
      const double sample = samples_[next_];
      visit_(next_++, at(sample));
    }
  }

  void note(bool jammed) { events_.push_back({jammed, state_.nu, state_.eps_vol, state_.eps_dev}); }

  bool may_carry_nothing() { return !by_stress() || freed_ || free_of_stress(); }
  static constexpr const char* unjammed = "the point is unjammed and carries no stress; compress it first";
  const Controls& followed() const { return freed_ ? *freed_ : controls_; }

  Status walk_unjammed() {
    if constexpr (goes_on_unjammed)
      return {};
    else
      return walk_to_contacts();
  }
  Status walk_to_contacts() requires(!goes_on_unjammed) {
    if (!may_carry_nothing()) return at_limit(unjammed);
    const StrainCourse course(followed(), begin_);
    if (course.at(1).nu >= 1) return at_limit("the volume fraction must stay below 1");
    const auto with_strain = [&](double t) {
      const State strained = course.at(t);
      State state = state_;
      state.nu = strained.nu;
      state.eps_vol = strained.eps_vol;
      state.eps_dev = strained.eps_dev;
      return state;
    };
    const double jams_at = form_.jamming_density(state_);
    const auto jams = [&](double t) { return course.at(t).nu >= jams_at; };
    const auto stops = [&](double t) { return stop_ && stop_->excess(law_, with_strain(t)) >= 0; };
    bool found = jams(1) && course.ahead(t_).eps_vol > 0;
    double to = found ? (jams(t_) ? t_ : first_where(t_, 1, jams)) : 1;
    if (stops(to)) {
      to = first_where(t_, to, stops);
      found = false;
      stopped_ = true;
    }
    // Where contact is found, the state belongs to the jammed phase that follows.
    if (!found && !stopped_)
      visit_up_to(to, with_strain);
    else
      visit_up_to(std::nextafter(to, 0), with_strain);
    state_ = with_strain(to);
    t_ = to;
    if (found && freed_) return at_limit("the point jams again, where it should carry no stress");
    if (found) {
      form_.jam(state_, course.ahead(to));
      note(true);
    }
    return {};
  }

  Status walk_piece() {
    if (!state_.jammed && !may_carry_nothing()) return at_limit(unjammed);
    if (auto reason = objection(law_, Stretch{state_.nu, 0, 1})) return failed(*reason);
    Steered<Form> steered(form_, state_, followed());
    if (!steered.find_direction(t_))
      return at_limit("no strain in either direction follows the path further");
    state_ = steered.begin();
    Cause cause{};
    if (Status status = integrate(steered, cause); status.failed()) return status;
    switch (cause) {
      case Cause::limit:  // also where Eq. 2.14 ends
        if (carries_nothing()) return lose_contact();
        return at_limit(why_);
      case Cause::no_pressure:
      case Cause::no_contacts:
        return state_.jammed ? lose_contact() : find_contact(steered);
      case Cause::volume:
        ++turns_;
        break;
      case Cause::stop:
        stopped_ = true;
        break;
      case Cause::reached:
        if (carries_nothing()) return lose_contact();
        break;
      default:
        break;
    }
    if (steered.q() == 0) state_.direction.q = 0;
    return {};
  }

  /// The end of a segment may be where the contacts are lost: no event is passed there.
  bool carries_nothing() const {
    constexpr double rounding = 2e-12;
    if (!state_.jammed) return false;
    return state_.nu <= form_.unjamming_density() * (1 + rounding) ||
           (by_stress() && state_.P <= smallest_pressure);
  }

  Status lose_contact() {
    form_.unjam(state_);
    note(false);
    if (by_stress() && !free_of_stress())
      return at_limit("the point loses its contacts and with them all stress");
    return {};
  }

  /// A form that goes on unjammed has come to its contacts.
  Status find_contact([[maybe_unused]] const Steered<Form>& steered) {
    if constexpr (goes_on_unjammed) {
      if (freed_) return at_limit("the point jams again, where it should carry no stress");
      form_.jam(state_, ahead_);
      note(true);
    }
    return {};
  }

  /// From here on without stress, if that is what is prescribed: P or sigma_dev are 0 until the end, and
  /// s_dev has no value any more. What rests then is the strain that nothing prescribes.
  bool free_of_stress() {
    bool any = false;
    for (const Prescribed& control : controls_) {
      constexpr double zero = 10 * smallest_pressure;
      if (!control.by_stress() || control.kind == Prescribed::Kind::s_dev) continue;
      if (control.end != 0 || !(std::abs(control.wanted(t_)) <= zero)) return false;
      any = true;
    }
    if (!any) return false;
    const Prescribed volume = Prescribed::strain("eps_vol", 1, 0).from(state_),
                     shear = Prescribed::strain("eps_dev", 0, 1).from(state_);
    freed_ = controls_;
    for (const std::size_t i : {0u, 1u}) {
      const Prescribed& other = controls_[1 - i];
      if (controls_[i].by_stress())
        (*freed_)[i] = (other.by_stress() ? i == 0 : other.is_shear()) ? volume : shear;
    }
    return true;
  }

  /// Events of a piece, in the order of `causes`.
  std::vector<System::Event> events_of(const Steered<Form>& steered, std::vector<Cause>& causes) const {
    std::vector<System::Event> events;
    const auto add = [&](Cause cause, System::Event event) {
      causes.push_back(cause);
      events.push_back(std::move(event));
    };
    constexpr std::size_t x = Form::size;
    if constexpr (!goes_on_unjammed)
      add(Cause::no_contacts, [room = std::log(steered.begin().nu / form_.unjamming_density())](
                                  double, const double* z) { return room + z[x]; });
    add(Cause::limit,
        [room = -std::log(steered.begin().nu)](double, const double* z) { return room - z[x]; });
    if constexpr (std::is_base_of_v<Coupled, Form>)
      add(Cause::no_pressure, [](double, const double* z) { return z[0] - smallest_pressure; });
    if constexpr (goes_on_unjammed) {
      add(Cause::no_pressure, [this, &steered](double, const double* z) {
        const Direction& direction = steered.begin().direction;
        const double nu = steered.begin().nu * std::exp(z[x]);
        return form_.distance_to_event(form_.coefficients(nu, direction), direction, z);
      });
      if (steered.may_turn() && turns_ < most_turns)
        add(Cause::volume, [&steered](double t, const double* z) { return steered.volume_rate(t, z); });
    }
    add(Cause::limit, [&steered](double t, const double* z) { return steered.distance_to_limit(t, z); });
    if (steered.may_reverse())
      add(Cause::reversal, [&steered](double t, const double* z) { return steered.shear_ahead(t, z); });
    if (steered.may_begin_to_shear())
      add(Cause::shear, [&steered](double t, const double* z) { return steered.shear_begins(t, z); });
    if (stop_)
      add(Cause::stop,
          [this, &steered](double, const double* z) { return stop_->excess(law_, steered.state(z)); });
    return events;
  }

  /// Walks to the end of the segment or to an event, whose cause it says.
  Status integrate(const Steered<Form>& steered, Cause& cause) {
    System system;
    system.rate = [&](double t, const double* z, double* dzdt) { return steered.rate(t, z, dzdt); };
    system.jacobian = [&](double t, const double* z, double* J) { return steered.jacobian(t, z, J); };
    std::vector<Cause> causes;
    system.others = events_of(steered, causes);
    auto z = steered.variables();
    if (Status status = integrator_.start(system, t_, 1, z.data()); status.failed()) return status;
    for (bool last = false; !last;) {
      const double to = next_sample();
      last = !(to <= 1);
      const auto arrival = integrator_.advance(last ? 1 : to, z.data());
      if (arrival.status.failed()) {
        if (!by_stress()) return arrival.status;
        // Steps shrink without end where strains grow so: at P* = 0 or s_dev = 0 over 0.
        why_ = "the strain that follows the path has a singularity (" + arrival.status.message + ")";
        cause = Cause::limit;
        return {};
      }
      t_ = arrival.t;
      state_ = steered.state(z.data());
      if (arrival.event) {
        cause = causes[arrival.which];
        ahead_ = steered.ahead(t_, z.data());
        return {};
      }
      if (!last) visit_(next_++, state_);
    }
    t_ = 1;
    cause = Cause::reached;
    return {};
  }

  const Form& form_;
  const Law& law_;
  State& state_;
  const State begin_;  // of the segment
  const Controls& controls_;
  const std::optional<StopCondition>& stop_;
  std::span<const double> samples_;
  const MaterialPoint::Visit& visit_;
  Integrator& integrator_;
  std::vector<Event>& events_;
  std::string why_ = "no strain follows the path further";
  std::optional<Controls> freed_;  // of stress, once it is gone for good
  Stretch ahead_;                  // rates where the last piece ended
  int turns_ = 0;
  std::size_t next_ = 0;
  double t_ = 0;
  bool stopped_ = false;
};

int variables_of(const Law& law) {
  return std::visit([]<class Form>(const Form&) { return static_cast<int>(Steered<Form>::size); }, law);
}

}  // namespace

Controlled::Controlled(MaterialPoint& point, Tolerance tolerance)
    : point_(point), integrator_(variables_of(point.law()), tolerance) {}

Ended Controlled::walk(const Controls& controls, const std::optional<StopCondition>& stop,
                       std::span<const double> samples, const MaterialPoint::Visit& visit) {
  State state = point_.state();
  const auto stops_here = [&] { return stop && stop->excess(point_.law(), state) >= 0; };
  if (controls[0].change() == 0 && controls[1].change() == 0 && !stops_here()) {
    for (std::size_t i = 0; i < samples.size(); ++i) visit(i, state);
    return {};
  }
  std::vector<Event> events;
  Ended ended = std::visit(
      [&]<class Form>(const Form& form) {
        return ControlledWalk<Form>(form, point_.law(), state, controls, stop, samples, visit, integrator_,
                                    events)
            .run();
      },
      point_.law());
  if (ended.status.failed()) {
    ended.status.message += " (nu = " + shown(state.nu) + ", eps_dev = " + shown(state.eps_dev) + ")";
    return ended;
  }
  for (const Event& event : events) point_.note(event);
  point_.set_state(state);
  return ended;
}

}  // namespace grainlaw::model
