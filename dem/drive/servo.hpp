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
  /// The mean stress and six components: more than go together.
  using Each = std::array<double, 7>;
  Each target{};        ///< ug/(mm us^2)
  Each reached{};       ///< at the last look
  Each rate{};          ///< strain rate that it adds until the next look, 1/us, compression positive
  Each follow{};        ///< strain rate of the servo over that of the driven components, learnt on the way
  double P = 0;         ///< mean static stress at the last look, ug/(mm us^2)
  double throttle = 1;  ///< share of their rate that driven components have; 0 where out of tolerance
  double off = 0;       ///< for how long some stress has been out of tolerance, us
  double on = 0;        ///< for how long none has, us

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.target, self.reached, self.rate, self.follow, self.P, self.throttle, self.off, self.on);
  }
};

class Servo {
 public:
  Servo(const Material& material, const Control& control);

  /// What is controlled: a component (xx, yy, zz, yz, xz, xy), or none where it is the mean stress, by all
  /// axes alike.
  using Target = std::optional<std::size_t>;
  const std::vector<Target>& targets() const { return targets_; }
  static bool is_shear(const Target& target) { return target && *target >= 3; }

  /// Targets that are the stress at the start are those of `seen`.
  ServoState start(const Glance& seen) const;
  /// A look at the stress, `elapsed` us after the one before. `driven` is the largest strain rate of the
  /// components that the segment strains, without throttle, 1/us.
  void look(ServoState& state, const Glance& seen, double elapsed, double driven) const;
  /// Strain rates that the servo adds, 1/us, compression positive.
  Sym6 rates(const ServoState& state) const;
  /// The target that is off by most, as an index of targets(), and by how much: stress/target - 1; of a shear
  /// stress (stress - target)/max(P, |target|), so that 0 can be a target.
  std::size_t worst(const ServoState& state) const;
  double error(const ServoState& state, std::size_t target) const;
  /// Whether all normal and mean targets are compressive: a stress of 0 at the start is none.
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
