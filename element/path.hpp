// Strain paths of element tests: modes, segments, and the one schema (PATH.json) that DEM scenes and the law share.
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

/// Diagonal logarithmic strain, compression positive.
using Strain3 = std::array<double, 3>;

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
};

/// A segment with its strain known: what DEM and law both walk along.
struct Leg {
  Mode mode;
  Strain3 strain;      ///< logarithmic strain of this leg, compression positive; zero for relax
  double eps_vol[2];   ///< from the path's start, at begin and end
  double eps_dev[2];   ///< signed, from the path's start, at begin and end
  double duration;     ///< us
  Profile profile;
  double tolerance;
  /// Fraction of the leg's logarithmic strain applied at time t in [0, duration] (component c): exact for both profiles.
  double progress(double t, int component) const;
};

struct Path {
  Start start;
  std::vector<Segment> segments;  ///< repeats written out

  /// Reads and checks a PATH object; see docs/formats.md.
  static Path read(Reader reader);
  /// The path with defaults filled in, repeats written out.
  Json to_json() const;
  /// Turns targets into strains, for a path that starts at volume fraction nu. Throws Error when a target is the state already
  /// reached, or volume fraction leaves (0, 1).
  std::vector<Leg> legs(double nu, const std::string& file = "") const;
};

/// Sign convention of deviatoric scalars in a leg (Fsgn): +1 or -1 for tensor q, by the axes of the mode
/// (D2: sgn(Qyy - Qxx); otherwise sgn(Qzz - (Qxx+Qyy)/2); components: the sign of its projection on the leg's own deviator).
/// A purely isotropic leg takes the mode of the nearest deviatoric leg after it, then before it, then UNI.
class SignConvention {
 public:
  explicit SignConvention(const std::vector<Leg>& legs);
  /// Signed deviatoric magnitude of q in leg i.
  double signed_deviator(const Sym6& q, std::size_t leg) const;

 private:
  std::vector<Strain3> axis_;
};

/// True if the deviators of a and b are parallel (either sign), or one has none.
bool coaxial(const Strain3& a, const Strain3& b);

}  // namespace grainlaw
