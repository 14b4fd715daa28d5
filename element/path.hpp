// Strain paths of element tests: modes, segments, and the one schema (PATH.json) that DEM scenes and the law
// share.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/control.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/element/law_control.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw {

enum class Mode {
  iso,
  uni,
  d2,
  d3,
  components,
  relax,
  constant_p,        ///< D2 or D3 with an isotropic strain that keeps P
  biaxial,           ///< y driven, z at rest, x under constant stress
  triaxial,          ///< z driven, x and y under constant stress
  isotropic_stress,  ///< all three axes to the same stress
  control,           ///< any mix
  simple_shear       ///< planes of constant y glide along x: with spin, so that the axes of strain turn
};
enum class Profile {
  constant,
  cosine,
  steered,
  quasistatic  ///< in increments, each brought into balance by minimising the energy; no time passes
};

std::string name_of(Mode mode);
std::string name_of(Profile profile);

/// Logarithmic strain, compression positive: tensor components xx, yy, zz, yz, xz, xy.
using StrainTensor = Sym6;

/// Start of a path; what is not given comes from the parameter set (law) or is measured (DEM).
struct Start {
  std::optional<double> nu, P, sigma_dev, F_dev, phi_J, phi_max;

  /// Reads and checks a `start` object; see docs/formats.md.
  static Start read(Reader reader);
};

/// One straight stretch of a path as written, before its targets are known in strain.
struct Segment {
  Mode mode = Mode::iso;
  std::optional<double> to_nu, to_eps_vol, to_eps_dev;  ///< controls: at most one is set
  std::optional<double> amount;  ///< natural amount of the mode: eps_vol for iso and uni, eps_dev for d2, d3
                                 ///< and constant_p, axial strain for biaxial and triaxial, gamma for
                                 ///< simple_shear
  StrainTensor strain{};         ///< only for components and control
  Mode shear = Mode::d2;         ///< only for constant_p: d2 or d3
  Control control;
  std::optional<double> rate;      ///< mean strain rate of the mode, 1/us
  std::optional<double> duration;  ///< us; for relax the longest time
  Profile profile = Profile::constant;
  double wanted_ratio = 1e-4;      ///< E_k/E_p that a steered rate keeps
  double tolerance = 1e-6;         ///< only for relax
  double increment = 1e-4;         ///< quasistatic: largest strain component of a step, at most
  std::optional<double> residual;  ///< quasistatic, or a relax that minimises: see Leg
  /// Whether no component is driven at a strain rate: the box waits for rest or for stress targets.
  bool only_waits() const;
  /// Two quantities that the law is to follow; the mode then only says the axis of shear. Empty, or two.
  std::vector<LawControl> law_controls;
  std::optional<Stop> stop;
  /// Whether only the law can follow it.
  bool law_only() const { return !law_controls.empty() || stop; }
  /// Whether its strain is known only when it has been followed.
  bool by_stress() const { return control.by_stress() || !law_controls.empty(); }
  std::string key;  ///< where it stands in its file ("path.segments[2]")
};

/// A segment with its strain known: what DEM and law both walk along. Under stress control only part of the
/// strain is: what the law cannot walk along.
struct Leg {
  Mode mode;
  StrainTensor strain;  ///< logarithmic strain of this leg, compression positive; zero for relax. Of a
                        ///< component under a stress target, or beside a mean one: without what the servo
                        ///< adds. Where principal axes turn, because a servo strains, too: the time integral
                        ///< of the rate of deformation
  /// Of simple shear: F = 1 + gamma progress e_x (x) e_y; `strain` is then -ln V of the whole leg.
  std::optional<double> gamma;
  double gamma_before = 0;  ///< of the simple shear that this leg goes on with: see Waypoint
  double eps_vol[2];        ///< from the path's start, at begin and end, of `strain`
  double eps_dev[2];  ///< sum of the signed increments from the path's start, at begin and end, of `strain`;
                      ///< legs of simple shear that follow one another count as one
  double duration;    ///< us; for relax and a leg that only waits for stress targets the longest
  Profile profile;
  double tolerance;
  Control control;
  std::optional<double> to_eps_dev;  ///< ends where the box has this eps_dev, else when `strain` is applied
  double wanted_ratio = 1e-4;        ///< E_k/E_p that a steered rate keeps
  double increment = 1e-4;           ///< of a leg that minimises: largest strain component of a step, at most
  /// Where energy is minimised after each increment: to this largest net force over the mean contact force.
  std::optional<double> residual;
  std::optional<StrainTensor> axis;  ///< of its deviatoric scalars; none if it does not shear

  /// Whether the grains decide how it goes on: under stress control, or at a steered rate.
  bool controlled() const { return control.by_stress() || profile == Profile::steered; }
  /// Whether time stands still, and the grains go from one balance to the next.
  bool minimises() const { return residual.has_value(); }
  /// Whether any component is driven at a strain rate; else it relaxes, or waits for stress targets.
  bool drives() const { return strain != StrainTensor{}; }
  /// Fraction of the leg's logarithmic strain applied at time t in [0, duration], the same for all
  /// components, so that D2 and D3 keep the volume at all times. Cosine: (1 - cos(pi t/duration))/2, which is
  /// Eq. 2.2 to first order in the strain.
  double progress(double t) const;
  /// Its inverse: the time at which fraction f in [0, 1] is applied, us.
  double time_at(double f) const;
  /// eps_dev where that fraction is applied; in simple shear it is not linear in it.
  double eps_dev_at(double f) const;
  /// Its inverse, in [0, 1]; eps_dev[0] and eps_dev[1] must differ.
  double fraction_at(double eps_dev) const;
};

/// Where a path stands between two segments.
struct Waypoint {
  double nu_start;
  double nu;
  double eps_vol = 0, eps_dev = 0;   ///< from the path's start
  std::optional<StrainTensor> axis;  ///< of the last leg that sheared
  double gamma = 0;                  ///< of all simple shear since another shear; 0 where there was none

  explicit Waypoint(double start) : nu_start(start), nu(start) {}
  /// Goes on by the logarithmic strain of a leg that is no simple shear, or of part of it.
  void move(const StrainTensor& strain, const std::optional<StrainTensor>& leg_axis);
  /// Goes on by a leg. In simple shear eps_dev grows to sqrt(3) asinh(gamma/2), that of the whole `gamma`, in
  /// however many legs it came: -ln V of each for itself would not add up, because its axes turn.
  void move(const Leg& leg);
};

struct Path {
  Start start;
  std::vector<Segment> segments;  ///< repeats written out

  /// Reads and checks a PATH object; see docs/formats.md.
  static Path read(Reader reader);
  /// The path with defaults filled in, repeats written out.
  Json to_json() const;
  /// Turns targets into strains, for a path that starts at volume fraction nu. Throws Error when a target is
  /// the state already reached, or the volume fraction leaves (0, 1); also for a segment under stress
  /// control, whose strain only the grains know.
  std::vector<Leg> legs(double nu) const;
  /// Segment i as a leg from there. Throws Error as legs() does, but takes stress control.
  /// Unless `certain`, `from` leaves out what a servo strained before: then nothing is refused that depends
  /// on where the segment begins.
  Leg leg(std::size_t i, const Waypoint& from, bool certain = true) const;
  /// All legs as if servos added no strain, for estimates and signs: a leg that would then have nothing to do
  /// is empty. Throws Error as legs() does, up to the first segment under stress control; unless `nu` is
  /// `certain`, nothing that depends on it.
  std::vector<Leg> nominal_legs(double nu, bool certain = true) const;
  /// Whether any segment is under stress control.
  bool by_stress() const;
  /// Whether the strain of every segment is known before anything follows it.
  bool strain_is_known() const;
  /// Whether any segment is simple shear, whose axes turn.
  bool spins() const;
  /// Throws Error (file, key) for a segment that only grains can follow.
  void need_law_can_follow() const;
  /// Throws Error (file, key) for a segment that only the law can follow, and for one that strains the box by
  /// more than its numbers can hold (largest_spread).
  void need_grains_can_follow() const;
  std::string file;  ///< for error messages
};

/// -ln V of F = V R = 1 + gamma e_x (x) e_y: principal strains -+asinh(gamma/2), whose axes lie at half the
/// angle atan(2/gamma) to x and y.
StrainTensor simple_shear_strain(double gamma);

/// Logarithmic strain as one number: sqrt(3 J2) with the sign of its projection on the axis.
double signed_deviator(const StrainTensor& strain, const StrainTensor& axis);

/// Sign convention of deviatoric scalars (Fsgn): the sign of a tensor's projection on the leg's axis, D2 (-1,
/// 1, 0), that is sgn(Qyy - Qxx); UNI and D3 (-1/2, -1/2, 1), that is sgn(Qzz - (Qxx+Qyy)/2). `components`
/// takes whichever of these, or the axis before it, it is coaxial with, else its own deviator. A leg without
/// deviator (iso, relax) takes the axis before it, else the one after it, else UNI's.
class SignConvention {
 public:
  explicit SignConvention(const std::vector<Leg>& legs);
  /// Deviatoric magnitude sqrt(3 J2) of q with its sign in leg i.
  double signed_deviator(const Sym6& q, std::size_t leg) const;
  const StrainTensor& axis(std::size_t leg) const { return axes_.at(leg); }

 private:
  std::vector<StrainTensor> axes_;
};

/// True if the deviators of a and b are parallel (either sign), or one has none.
bool coaxial(const StrainTensor& a, const StrainTensor& b);

}  // namespace grainlaw
