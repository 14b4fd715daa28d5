// Drives the box and its grains along one leg of a path.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "grainlaw/dem/drive/servo.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

/// The motion of the box along a leg: edges H(t) = exp(-strain progress(t)) H(0), a stretch without spin
/// whose principal axes stay where they are; or, in simple shear, (1 + gamma progress(t) e_x (x) e_y) H(0).
class Drive {
 public:
  Drive(const Mat3& start_edges, const Leg& leg);
  /// H at time t of the leg, mm.
  Mat3 edges(double t) const;
  /// G at time t, averaged over t - dt/2 ... t + dt/2 within the leg, 1/us.
  Mat3 gradient(double t, double dt) const;

 private:
  Mat3 start_;
  Mat3 strain_;         ///< of the whole leg, compression positive
  Spectrum principal_;  ///< of `strain_`, where it is not diagonal
  Leg leg_;
};

/// How a leg is cut into steps.
struct StepPlan {
  std::uint64_t steps = 1;  ///< for relax the most
  double dt = 0;            ///< us, at most what was asked for
};
/// `wanted` rounded up, but for rounding errors. Throws Error beyond 9e15: doubles would no longer count
/// them.
std::uint64_t whole_steps(double wanted);
/// At least `least_steps` (and one) of equal length, each no longer than `longest_step` us. Throws as
/// whole_steps() does.
StepPlan plan_steps(const Leg& leg, double longest_step, std::uint64_t least_steps);

/// Where a leg is whose strain is not known in advance (see controlled_drive.hpp).
struct ControlState {
  double own_time = 0;     ///< of the leg's profile: how long it would have taken unhindered, us
  double speed = 1;        ///< of a steered rate over the segment's
  double progress = 0;     ///< share of the leg that is done, at the last look
  bool looked = false;     ///< whether the last step ended with a look at stress and energies
  bool on_target = false;  ///< whether all stresses were within tolerance then
  bool lost = false;       ///< whether the leg ended because a stress could not be reached
  ServoState servo;

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.own_time, self.speed, self.progress, self.looked, self.on_target, self.lost, self.servo);
  }
};

/// How far a leg has been followed, and all that its next step needs to know beyond the grains and their box.
/// Whatever drives a leg keeps its state here, so that the leg can be left after any step and gone on with.
struct LegState {
  std::uint64_t step = 0;           ///< steps taken; 0: the leg has not begun
  bool entered = false;             ///< whether what is recorded before its first step has been
  Mat3 start_edges;                 ///< H where it began, mm
  double kinetic_at_start = 0;      ///< for relax, ug mm^2/us^2
  double eps_vol = 0, eps_dev = 0;  ///< of the path where it began
  double gamma = 0;                 ///< of the simple shear before it: see Waypoint
  StrainTensor axis{};              ///< of the last leg before it that sheared; zero: none
  ControlState control;             ///< of a controlled leg
  std::uint64_t passes = 1;         ///< over the contacts in the last step; not kept

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.step, self.entered, self.start_edges, self.kinetic_at_start, self.eps_vol, self.eps_dev,
            self.gamma, self.axis, self.control);
  }
};

/// Logarithmic strain of the box since the leg began, -ln V of F = V R, compression positive.
StrainTensor leg_strain(const Dynamics& dynamics, const LegState& state);
/// Deviatoric strain of the path where the box is now, on a controlled leg.
double leg_eps_dev(const Dynamics& dynamics, const Leg& leg, const LegState& state);

/// Called after each step with its number, counted from 1; false leaves the leg there.
using AfterStep = std::function<bool(std::uint64_t step)>;

/// Follows a leg that strains the box, from where `state` says it is.
void follow(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
            const AfterStep& after_step);

/// Lets the grains come to rest in a box at rest, until E_k/E_p falls below leg.tolerance or the plan ends.
/// Where no grain has four contacts, there is no network to compare with: there, until E_k has fallen by that
/// factor.
void relax(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
           const AfterStep& after_step);

/// A whole leg, however it is followed. `stop` is for legs whose steps take long; others are left by
/// `after_step` alone.
void drive(Dynamics& dynamics, const Leg& leg, const StepPlan& plan, LegState& state,
           const AfterStep& after_step, const std::atomic<bool>* stop = nullptr);
void drive(Dynamics& dynamics, const Leg& leg, const StepPlan& plan);

}  // namespace grainlaw::dem
