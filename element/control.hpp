// How a segment of a path is controlled: each component of the tensor, or the mean stress, follows a strain
// rate or a stress target. Modes are presets of this.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <variant>

#include "grainlaw/element/json.hpp"

namespace grainlaw {

/// The component follows the strain of its segment, in the segment's profile.
struct StrainRate {};

/// The servo strains the box so that the static stress is this.
struct StressTarget {
  std::optional<double> stress;  ///< over k*, > 0 but for shear; none: that which the segment starts with
};

using ComponentControl = std::variant<StrainRate, StressTarget>;

/// How well, how fast and how patiently stress targets are followed.
struct ServoLimits {
  /// Largest |stress/target - 1|; of a shear stress largest |stress - target|/max(P, |target|).
  double tolerance = 1e-3;
  double rate = 0;  ///< largest strain rate of a component by the servo, 1/us
  double wait = 0;  ///< us; a target that is out of tolerance for longer cannot be reached
};

struct Control {
  std::array<ComponentControl, 6> component;  ///< xx, yy, zz, yz, xz, xy
  std::optional<StressTarget> mean;  ///< of tr(sigma)/3: an isotropic strain comes on top of that of the axes
  ServoLimits servo;

  bool by_stress(std::size_t c) const { return std::holds_alternative<StressTarget>(component[c]); }
  /// Whether the stress on any of the axes x, y, z is a target.
  bool axis_by_stress() const { return any_by_stress(0, 3); }
  /// Whether any shear stress is a target.
  bool shear_by_stress() const { return any_by_stress(3, 6); }
  /// Whether any stress is a target, so that the strain is known only when the grains have run.
  bool by_stress() const { return mean || any_by_stress(0, 6); }

 private:
  bool any_by_stress(std::size_t first, std::size_t last) const {
    for (std::size_t c = first; c < last; ++c)
      if (by_stress(c)) return true;
    return false;
  }
};

/// Mean and normal stresses over k* that may be targets.
Range target_range();
/// Shear stresses over k* that may be: of either sign, or 0.
Range shear_target_range();
/// `key` of reader: a stress over k*, or "start".
StressTarget read_target(Reader& reader, std::string_view key, const Range& range = target_range());
/// The same, where a missing key means the stress at the start.
StressTarget read_target_or_start(Reader& reader, std::string_view key);
/// The key `servo`; `rate` is the servo's where it is not given.
ServoLimits read_servo(Reader reader, double rate);
Json to_json(const StressTarget& target);
Json to_json(const ServoLimits& servo);

}  // namespace grainlaw
