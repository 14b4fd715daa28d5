#include "grainlaw/dem/drive/controlled_drive.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/packing/least_width.hpp"
#include "grainlaw/element/components.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/short_text.hpp"

namespace grainlaw::dem {

namespace {

/// Time in which a steered rate may change by a factor e, over the contact duration of two mean grains.
constexpr double steering_over_contact = 10;
/// Contacts per grain from which a packing may be jammed (6 hold it, rattlers have none): E_k/E_p means
/// something.
constexpr double bearing_contacts = 1.5;
/// A leg that only waits for stresses ends when they have been reached for so many response times.
constexpr double settled_responses = 10;

class ControlledLeg {
 public:
  ControlledLeg(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state)
      : dynamics_(dynamics),
        leg_(leg),
        dt_(plan.dt),
        state_(state),
        control_(state.control),
        servo_(dynamics.material(), leg.control),
        steering_time_(steering_over_contact *
                       dynamics.material().contact_duration(dynamics.material().r_mean)),
        least_width_(least_width(dynamics.grains().largest_radius(), dynamics.material().r_mean)) {
    for (const Quad& place : dynamics.grains().place) solid_ += sphere_volume(place.w);
  }

  void begin() {
    state_.start_edges = dynamics_.cell().edges();
    control_.servo = servo_.start(seen());
    look(0);
    dynamics_.start_flow(dt_, box_rate(0));
  }

  /// One step, unless the leg is lost because its grains need more room than the box has after it.
  void step() {
    const double own_step = dt_ * control_.speed * control_.servo.throttle;
    const Mat3 rate = box_rate(own_step), edges = exponential(dt_ * rate) * dynamics_.cell().edges();
    control_.lost = !has_room(edges);
    if (control_.lost) return;
    control_.own_time += own_step;
    dynamics_.step(edges, rate);
    ++state_.step;
    control_.looked = state_.step % look_interval == 0;
    if (control_.looked) look(dt_ * static_cast<double>(look_interval));
  }

  /// Whether the leg is over, well or not; well only at a look.
  bool done() {
    if (control_.lost) return true;
    if (!control_.looked) return false;
    control_.lost = !servo_.possible(control_.servo) || control_.servo.off > leg_.control.servo.wait ||
                    (leg_.drives() && over_the_end());
    if (control_.lost) return true;
    if (!servo_.within_tolerance(control_.servo)) return false;
    return leg_.drives() ? control_.progress >= 1
                         : control_.servo.on >= settled_responses * servo_.response();
  }

 private:
  Glance seen() const {
    return dynamics_.glance(leg_.control.shear_by_stress() ? Stresses::all : Stresses::normal);
  }

  /// Whether a box with these edges is wide enough for the largest grain, and larger than all of them.
  bool has_room(const Mat3& edges) const {
    if (!(determinant(edges) > solid_)) return false;  // nor what is not a number
    const Cell cell = dynamics_.cell().moved(edges, {});
    return cell.narrowest() >= least_width_ || (cell.tilted() && Cell(edges).narrowest() >= least_width_);
  }

  void look(double elapsed) {
    const Glance now = seen();
    if (leg_.profile == Profile::steered) steer(now, elapsed);
    servo_.look(control_.servo, now, elapsed, driven());
    control_.on_target = servo_.within_tolerance(control_.servo);
    control_.progress = progress();
  }

  /// The rate follows ln(E_k/E_p) towards the wanted one: E_k goes with the rate squared where grains flow.
  void steer(const Glance& seen, double elapsed) {
    const bool bears =
        static_cast<double>(seen.contacts) > bearing_contacts * static_cast<double>(dynamics_.count());
    const double wanted =
        bears ? 0.5 * std::log(leg_.wanted_ratio * seen.elastic / seen.kinetic) : -std::log(control_.speed);
    control_.speed *= std::exp(std::clamp(wanted, -1.0, 1.0) * elapsed / steering_time_);
    control_.speed = std::clamp(control_.speed, slowest_steered, fastest_steered);
  }

  /// Largest strain rate of a driven component, without throttle.
  double driven() const {
    if (!leg_.drives()) return 0;
    const double own_step = dt_ * control_.speed;
    return largest_component(leg_.strain) *
           (leg_.progress(control_.own_time + own_step) - leg_.progress(control_.own_time)) / dt_;
  }

  /// G = dH/dt H^-1, symmetric, over a step by which the leg's own time goes on by `own_step`. Diagonal to
  /// the last bit where no shear is asked for.
  Mat3 box_rate(double own_step) const {
    const double share =
        (leg_.progress(control_.own_time + own_step) - leg_.progress(control_.own_time)) / dt_;
    Sym6 rate = servo_.rates(control_.servo);
    for (std::size_t c = 0; c < rate.size(); ++c) rate[c] = -(rate[c] + leg_.strain[c] * share);
    return matrix_of(rate);
  }

  double progress() const {
    if (!leg_.drives()) return 0;
    if (!leg_.to_eps_dev) return leg_.progress(control_.own_time);
    return (leg_eps_dev(dynamics_, leg_, state_) - leg_.eps_dev[0]) / (*leg_.to_eps_dev - leg_.eps_dev[0]);
  }
  /// The strain that certainly reaches eps_dev has not.
  bool over_the_end() const { return leg_.to_eps_dev && control_.own_time >= leg_.duration; }

  Dynamics& dynamics_;
  const Leg& leg_;
  double dt_;
  LegState& state_;
  ControlState& control_;
  Servo servo_;
  double steering_time_, least_width_, solid_ = 0;
};

}  // namespace

StrainTensor leg_strain(const Dynamics& dynamics, const LegState& state) {
  return dynamics.cell().strain_from(state.start_edges);
}

double leg_eps_dev(const Dynamics& dynamics, const Leg& leg, const LegState& state) {
  return leg.eps_dev[0] +
         signed_deviator(leg_strain(dynamics, state), leg.axis.value_or(StrainTensor{-0.5, -0.5, 1}));
}

void follow_controlled(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
                       const AfterStep& after_step) {
  ControlledLeg controlled(dynamics, leg, plan, state);
  if (state.step == 0) controlled.begin();
  while (!controlled.done()) {
    controlled.step();
    if (!state.control.lost && !after_step(state.step)) return;
  }
}

std::string why_lost(const Material& material, const Leg& leg, const LegState& state) {
  const Servo servo(material, leg.control);
  const ServoState& at = state.control.servo;
  const bool box_is_in_the_way = !(at.off > leg.control.servo.wait);
  const std::string no_room = "too narrow for its largest grain, or too small for all";
  if (leg.to_eps_dev && state.control.own_time >= leg.duration)
    return "eps_dev never comes to " + to_text(*leg.to_eps_dev);
  if (servo.possible(at) && servo.within_tolerance(at)) return "its strain makes the box " + no_room;
  const std::size_t worst = servo.worst(at);
  const auto target = servo.targets()[worst];
  const double unit = material.stress_unit();
  const std::string name = target ? stress_columns[*target] : "P";
  if (!servo.possible(at)) return name + " is 0 where the segment starts, and cannot be kept; give a number";
  const bool of_P = Servo::is_shear(target) && at.P > std::abs(at.target[worst]);
  return name + " cannot be kept at " + short_text(at.target[worst] / unit, 4) + " to " +
         short_text(leg.control.servo.tolerance, 4) + (of_P ? " of P = " + short_text(at.P / unit, 4) : "") +
         ": it is " + short_text(at.reached[worst] / unit, 4) + " after " + short_text(at.off, 4) +
         " us out of tolerance" + (box_is_in_the_way ? ", and the box would become " + no_room : "");
}

}  // namespace grainlaw::dem
