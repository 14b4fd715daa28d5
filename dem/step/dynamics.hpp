// The motion of the grains: velocity Verlet in a deforming periodic box, with viscous contacts and a viscous
// background.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/packing/cell.hpp"
#include "grainlaw/dem/packing/grains.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/step/contact_law.hpp"
#include "grainlaw/dem/step/glance.hpp"
#include "grainlaw/dem/step/measure.hpp"
#include "grainlaw/dem/step/neighbours.hpp"
#include "grainlaw/dem/step/shares.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// The equations. With H the edges of the box, G = dH/dt H^-1 its velocity gradient (orthorhombic: d(ln L)/dt
/// per axis) and v the FLUCTUATION velocity (true velocity minus G x),
///
///   dx/dt = v + G x,   m dv/dt = sum of contact forces - gamma_b v - m G v.
///
/// The box carries the grains along; the background damps only what they move beyond that, so that it does
/// not hold back a homogeneous flow. The contacts (Eq. 2.1) see the true relative velocity, v_i - v_j + G
/// (x_i - x_j). The term m G v makes the work of the box equal that of the total stress, static plus kinetic.
///
/// One step is velocity Verlet: x moves with the velocity of the half step, the box moves, and forces are
/// computed for this (x, cell). They depend on the velocity of the full step, which is not known yet; it is
/// predicted with the extrapolated acceleration, v + dt/2 (a_n + (2 a_n - a_n-1)). The prediction errs by
/// O(dt^3), so the scheme keeps its second order and, to leading order, its error constant (taking the
/// half-step velocity would make it first order). All that is read between steps (positions, velocities,
/// measurements, states) belongs to one time and one box.
class Dynamics {
 public:
  /// `threads` share each step, but no more than there are runs of grains (GroupedPairs::block) for; how many
  /// they are changes no bit of it. Throws Error as Neighbours::update does.
  Dynamics(const Material& material, const State& state, int threads = 1);
  /// As it was when it was kept.
  Dynamics(const Material& material, ArchiveReader& archive, int threads = 1);
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    self.catch_up();
    archive(self.grains_, self.cell_, self.neighbours_, self.dt_, self.time_, self.steps_);
  }

  /// Must precede the first step, and steps with another dt (us). G is diagonal from now on, `rate`: d(ln
  /// L)/dt of an orthorhombic box.
  void start(double dt, const Vec3& rate) { start_flow(dt, Mat3::diagonal(rate)); }
  /// The same with any G, 1/us.
  void start_flow(double dt, const Mat3& gradient);
  /// One step to an orthorhombic box of edges `length` (mm), which then deforms at `rate` (1/us). Throws
  /// Error if the motion is no longer finite, or as Neighbours::update does; there is no going on from it.
  void step(const Vec3& length, const Vec3& rate) { step(Mat3::diagonal(length), Mat3::diagonal(rate)); }
  /// One step to a box of edges H (mm), which then deforms with G (1/us): H = F H_before, never flipped.
  void step(const Mat3& edges, const Mat3& gradient);
  /// One step in a box at rest.
  void step() { step(cell_.edges(), {}); }

  const Cell& cell() const { return cell_; }
  double dt() const { return dt_; }
  double time() const { return time_; }  ///< us
  std::uint64_t steps() const { return steps_; }
  std::size_t count() const { return grains_.count(); }
  int threads() const { return threads_; }
  /// Sorted in space, not as in the State. Several threads keep the grains to themselves until somebody
  /// looks, by this or anything below: a reference lags behind from the next step on until then, and two
  /// threads must not look at one Dynamics at a time.
  const Grains& grains() const {
    catch_up();
    return grains_;
  }
  const Neighbours& neighbours() const { return neighbours_; }
  const ContactLaw& law() const { return law_; }
  const Material& material() const { return material_; }

  /// Fluctuation velocities of the full step, mm/us, in the order of grains().
  Quads velocities() const;
  Measurement measure(const Wanted& wanted = Wanted::everything()) const;
  /// measure().stress but for the velocity, which is the one that the forces of this step saw (it is
  /// predicted, O(dt^3) off): cheap enough for a servo.
  Sym6 static_stress() const;
  /// measure().kinetic and elastic, to the last bit.
  Energies energies() const;
  /// Both in one pass, with the stiffness of the network: what servo and steering read. Velocities as in
  /// static_stress().
  Glance glance(Stresses which = Stresses::all) const {
    return dem::glance(law_, grains(), cell_, neighbours_.pairs(), which);
  }
  /// In the order of the State it began with; positions wrapped into the box.
  State state() const;
  /// As if made of `state`; what it holds is given back before. Throws as the constructor does: then there is
  /// no going on from it, but its state is this one.
  void begin_anew(const State& state);

 private:
  /// dv/dt of grain i, from its force and the velocity the force was computed with.
  Quad acceleration(std::size_t i) const;
  double advance_grains(const Cell& next);
  void update_list(double lookahead);
  void deal_out();
  void catch_up() const;

  Material material_;
  ContactLaw law_;
  Cell cell_;
  mutable Grains grains_;  ///< of several threads, as they were when somebody last looked; place and motion
                           ///< as they were when the list was made, if that is later
  Neighbours neighbours_;
  double dt_ = 0;
  double time_;
  std::uint64_t steps_;
  int threads_ = 1;
  mutable std::optional<Team> team_;  ///< of several threads, from the start on
  mutable bool behind_ = false;       ///< grains_, of the team
};

/// A time step: `fraction` of the contact duration of two grains of the smallest radius present, us.
double time_step(const Material& material, double smallest_radius, double fraction);

/// How much too short an undamped contact lasts at steps of this fraction of its duration t_c, as a share of
/// t_c. Velocity Verlet turns an oscillation of frequency pi/t_c into one of (2/dt) asin(pi dt/(2 t_c)).
inline double contact_error_of(double fraction) {
  const double half = std::numbers::pi / 2 * fraction;
  return 1 - half / std::asin(half);
}
/// Its inverse: the fraction of t_c at which a contact lasts too short by a share `error`, in [1e-12, 0.3].
double step_of_contact_error(double error);

}  // namespace grainlaw::dem
