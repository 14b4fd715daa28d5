// Strain paths of element tests: modes, segments, and the one schema (PATH.json) that DEM scenes and the law
// share.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/element/json.hpp"
#include "grainlaw/element/tensor.hpp"

namespace grainlaw {

enum class Mode { iso, uni, d2, d3, components, relax };
enum class Profile { constant, cosine };

std::string name_of(Mode mode);
std::string name_of(Profile profile);

/// Logarithmic strain, compression positive: tensor components xx, yy, zz, yz, xz, xy.
using Strain3 = Sym6;

/// Start of a path; what is not given comes from the parameter set (law) or is measured (DEM).
struct Start {
  std::optional<double> nu, P, sigma_dev, F_dev, phi_J, phi_max;
};

/// One straight stretch of a path as written, before its targets are known in strain.
struct Segment {
  Mode mode = Mode::iso;
  std::optional<double> to_nu, to_eps_vol, to_eps_dev;  ///< controls: at most one is set
  std::optional<double> amount;                         ///< eps_vol for iso and uni, eps_dev for d2 and d3
  Strain3 strain{};                                     ///< only for components
  std::optional<double> rate;                           ///< mean strain rate of the mode, 1/us
  std::optional<double> duration;                       ///< us; for relax the longest time
  Profile profile = Profile::constant;
  double tolerance = 1e-6;  ///< only for relax
  std::string key;          ///< where it stands in its file ("path.segments[2]")
};

/// A segment with its strain known: what DEM and law both walk along.
struct Leg {
  Mode mode;
  Strain3 strain;     ///< logarithmic strain of this leg, compression positive; zero for relax
  double eps_vol[2];  ///< from the path's start, at begin and end
  double eps_dev[2];  ///< sum of the signed increments from the path's start, at begin and end
  double duration;    ///< us
  Profile profile;
  double tolerance;
  /// Fraction of the leg's logarithmic strain applied at time t in [0, duration], the same for all
  /// components, so that D2 and D3 keep the volume at all times. Cosine: (1 - cos(pi t/duration))/2, which is
  /// Eq. 2.2 to first order in the strain.
  double progress(double t) const;
  /// Its inverse: the time at which fraction f in [0, 1] is applied, us.
  double time_at(double f) const;
};

struct Path {
  Start start;
  std::vector<Segment> segments;  ///< repeats written out

  /// Reads and checks a PATH object; see docs/formats.md.
  static Path read(Reader reader);
  /// The path with defaults filled in, repeats written out.
  Json to_json() const;
  /// Turns targets into strains, for a path that starts at volume fraction nu. Throws Error when a target is
  /// the state already reached, or the volume fraction leaves (0, 1).
  std::vector<Leg> legs(double nu) const;
  std::string file;  ///< for error messages
};

/// Sign convention of deviatoric scalars (Fsgn): the sign of a tensor's projection on the leg's axis, D2 (-1,
/// 1, 0), that is sgn(Qyy - Qxx); UNI and D3 (-1/2, -1/2, 1), that is sgn(Qzz - (Qxx+Qyy)/2). `components`
/// takes whichever of these, or the axis before it, it is coaxial with, else its own deviator. A leg without
/// deviator (iso, relax) takes the axis before it, else the one after it, else UNI's.
class SignConvention {
 public:
  explicit SignConvention(const std::vector<Leg>& legs);
  /// Deviatoric magnitude sqrt(3 J2) of q with its sign in leg i.
  double signed_deviator(const Sym6& q, std::size_t leg) const;
  const Strain3& axis(std::size_t leg) const { return axes_.at(leg); }

 private:
  std::vector<Strain3> axes_;
};

/// True if the deviators of a and b are parallel (either sign), or one has none.
bool coaxial(const Strain3& a, const Strain3& b);

}  // namespace grainlaw
