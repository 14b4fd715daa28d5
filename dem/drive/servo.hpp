// The servo: strains the box so that stresses stay at their targets. Each target has a proportional and
// integral controller, on the static stress, with its gain from the stiffness of the contact network.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "grainlaw/dem/step/glance.hpp"
#include "grainlaw/element/control.hpp"
#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {

/// All that a servo knows, an entry for each of its targets (see Servo::targets). Plain numbers.
struct ServoState {
  Vec3 target{};        ///< ug/(mm us^2)
  Vec3 reached{};       ///< at the last look
  Vec3 rate{};          ///< strain rate that it adds until the next look, 1/us, compression positive
  Vec3 follow{};        ///< strain rate of the servo over that of the driven axes, learnt on the way
  double throttle = 1;  ///< share of their rate that driven axes are granted; 0 where out of tolerance
  double off = 0;       ///< for how long some stress has been out of tolerance, us
  double on = 0;        ///< for how long none has, us

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.target, self.reached, self.rate, self.follow, self.throttle, self.off, self.on);
  }
};

class Servo {
 public:
  Servo(const Material& material, const Control& control);

  /// What is controlled: an axis, or none where it is the mean stress, by all axes alike.
  using Target = std::optional<std::size_t>;
  const std::vector<Target>& targets() const { return targets_; }

  /// Targets that are the stress at the start are those of `seen`.
  ServoState start(const Glance& seen) const;
  /// A look at the stress, `elapsed` us after the one before. `driven` is the largest strain rate of the axes
  /// that the segment strains, without throttle, 1/us.
  void look(ServoState& state, const Glance& seen, double elapsed, double driven) const;
  /// Strain rates that the servo adds, 1/us, compression positive.
  Vec3 rates(const ServoState& state) const;
  /// The target that is off by most, as an index of targets(), and by how much: stress/target - 1.
  std::size_t worst(const ServoState& state) const;
  double error(const ServoState& state, std::size_t target) const;
  /// Whether all targets are compressive: a stress of 0 at the start is none.
  bool possible(const ServoState& state) const;
  bool within_tolerance(const ServoState& state) const;
  /// The time in which an error falls to 1/e, us.
  double response() const { return response_; }

 private:
  Control control_;
  std::vector<Target> targets_;
  double stress_unit_, response_;
};

}  // namespace grainlaw::dem
