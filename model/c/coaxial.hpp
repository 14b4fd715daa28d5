// The law between tensors, for hosts: a strain increment in, stress and tangent out. The law carries one axis
// of shear, so an increment must be isotropic or coaxial with it.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "grainlaw/element/path.hpp"
#include "grainlaw/element/tensor.hpp"
#include "grainlaw/model/light/light_batch.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

/// How a host writes its tensors: six numbers xx, yy, zz, yz, xz, xy, by default compression positive and
/// without a factor on shears.
struct Notation {
  bool tension_positive = false;   ///< strain and stress change their sign
  bool engineering_shear = false;  ///< strains yz, xz, xy are twice those of the tensor
  bool operator==(const Notation&) const = default;
};

struct CoaxialSettings {
  Choice choice;
  Tolerance tolerance;
  /// Its deviator is the axis: a strain with a positive projection on it counts as positive. Compression
  /// positive, tensor shears, whatever the notation. D2 (-1, 1, 0); UNI and D3 (-1/2, -1/2, 1).
  Sym6 axis{};
  /// What of an increment's deviator may lie off the axis and is dropped, over the increment's size |eps_vol|
  /// + sqrt(3 J2). At 1 every increment is projected.
  double coaxial_tolerance = 1e-8;
  Notation notation;
  /// The tangent off the axis: 0, which is the derivative of the projected increment, instead of the
  /// stiffness of isotropic shear.
  bool projected_tangent = false;
};
/// Throws Error for an axis without deviator and for tolerances out of range.
void check(const CoaxialSettings& settings);

/// A volume strain, or a deviator along the axis, that is a smaller part of an increment's size is its
/// rounding error and counts as 0.
inline constexpr double coaxial_rounding = 1e-12;

/// A point between two increments.
struct CoaxialState {
  State point;
  /// The jamming density at which the laws stand: nu_c of the closure's pressure law, or what the start gave.
  double phi_J_laws = 0;
};

/// Row i, column j, at 6 i + j: the derivative of stress i by number j of the strain, both as they are
/// written.
using Matrix6 = std::array<double, 36>;

/// Const, so that one object serves any number of threads, each with a Workspace.
class CoaxialLaw {
 public:
  /// Throws Error where the set lacks what the form needs, for an axis without deviator, and for tolerances
  /// out of range.
  CoaxialLaw(ParameterSet parameters, const CoaxialSettings& settings);

  const ParameterSet& parameters() const { return parameters_; }
  const CoaxialSettings& settings() const { return settings_; }

  /// What a thread keeps from one increment to the next: the laws of another history, and what was computed
  /// from nu last.
  struct Workspace {
    double phi_J_laws = std::numeric_limits<double>::quiet_NaN();
    std::unique_ptr<const LightLaw> moved;
    LightCache cache;
    std::unique_ptr<LightBatch> block;  // of the law that is used
  };

  struct Begin {
    CoaxialState state;
    std::vector<std::string> warnings;
  };
  /// A start as that of a path: see start.hpp. Throws Error.
  Begin start(const Start& start) const;

  /// P I + sigma_dev n over k*, n the axis with sqrt(3 J2) = 1.
  Sym6 stress(const State& point) const;

  /// Walks the state over a logarithmic strain increment. On failure state, stress and tangent are left
  /// alone. Throws Error for strains that are not finite.
  Status update(CoaxialState& state, const Sym6& increment, Workspace& workspace, Sym6& stress,
                Matrix6* tangent) const;

  /// So many points at most go through update_block() together.
  static constexpr std::size_t block = 64;
  /// The same for a block of points without tangents, in lanes: LightBatch's answers, within the tolerance.
  /// False where that cannot be done, and then nothing has changed: the form has no lanes, the points have
  /// several histories, an increment is refused, or one fails. Throws Error for strains that are not finite.
  bool update_block(std::span<CoaxialState> states, const double* increments, Workspace& workspace,
                    double* stresses) const;

 private:
  struct Parts;
  Sym6 read_strain(const Sym6& written) const;
  Parts split(const Sym6& strain) const;
  const LightLaw& law_at(double phi_J_laws, Workspace& workspace) const;
  Matrix6 matrix_of(const Tangent& tangent, double off_axis) const;

  ParameterSet parameters_;
  CoaxialSettings settings_;
  LightLaw law_;
  Sym6 axis_;  // its deviator, sqrt(3 J2) = 1
};

/// Stiffness of shear from the isotropic state of this density, dsigma*_dev/d eps_dev: B (G/B)_ini
/// (Eqs. 4.11, 4.14) in the coupled forms and, with the jamming density and memory of the point, in `memory`,
/// P beta_s s_max (Eq. 2.17) in the reduced ones; 0 where unjammed.
double isotropic_shear_stiffness(const Law& law, const State& point);

}  // namespace grainlaw::model
