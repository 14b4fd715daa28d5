// How a segment of a path is controlled: each axis of the box, or the mean stress, follows a strain rate or a
// stress target. Modes are presets of this.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "grainlaw/element/json.hpp"

namespace grainlaw {

/// The axis follows the strain of its segment, in the segment's profile.
struct StrainRate {};

/// The servo strains the box so that the static stress is this.
struct StressTarget {
  std::optional<double> stress;  ///< over k*, > 0; none: the stress that the segment starts with
};

using AxisControl = std::variant<StrainRate, StressTarget>;

/// How well, how fast and how patiently stress targets are followed.
struct ServoLimits {
  double tolerance = 1e-3;  ///< largest |stress/target - 1|
  double rate = 0;          ///< largest strain rate of an axis by the servo, 1/us
  double wait = 0;          ///< us; a target that is out of tolerance for longer cannot be reached
};

struct Control {
  std::array<AxisControl, 3> axis;   ///< x, y, z
  std::optional<StressTarget> mean;  ///< of tr(sigma)/3: an isotropic strain comes on top of that of the axes
  ServoLimits servo;

  bool by_stress(std::size_t c) const { return std::holds_alternative<StressTarget>(axis[c]); }
  /// Whether any stress is a target, so that the strain is known only when the grains have run.
  bool by_stress() const { return mean || by_stress(0) || by_stress(1) || by_stress(2); }
};

/// Stresses over k* that may be targets.
Range target_range();
/// `key` of reader: a stress over k*, or "start".
StressTarget read_target(Reader& reader, std::string_view key);
/// The same, where a missing key means the stress at the start.
StressTarget read_target_or_start(Reader& reader, std::string_view key);
/// The key `servo`; `rate` is the servo's where it is not given.
ServoLimits read_servo(Reader reader, double rate);
Json to_json(const StressTarget& target);
Json to_json(const ServoLimits& servo);

}  // namespace grainlaw
