// The stages of an element test, one leg each: preparation, then the path. What happens at which step.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/path.hpp"

namespace grainlaw::dem {

struct Stage {
  std::string name;  ///< "compress the gas", "d2 (2 of 3)"
  Leg leg;
  std::optional<std::size_t> segment;  ///< index in the path; none during preparation
  StepPlan stepping;
  std::vector<std::uint64_t> rows;       ///< steps after which to measure, rising; none on a controlled leg
  std::vector<std::uint64_t> snapshots;  ///< steps after which to take one, rising; none on a controlled leg
  std::vector<std::uint64_t> moduli;     ///< the same for moduli; a step as often as requests fall on it

  std::uint64_t row_count = 0;  ///< rows of a controlled leg, evenly spaced in its progress

  /// Planned passes over the contacts: the steps, or what increments take about.
  std::uint64_t passes() const { return stepping.steps * passes_per_step(); }
  std::uint64_t passes_per_step() const { return leg.minimises() ? passes_per_increment : 1; }
  static constexpr std::uint64_t passes_per_increment = 1000;

  /// Share of the leg's strain after so many steps, if it is not controlled.
  double progress(std::uint64_t step) const;
};

/// The longest steps that a scene allows for grains of this smallest radius, us.
struct LongestSteps {
  double path, preparation;
  LongestSteps(const Scene& scene, double smallest_radius);
};

/// Passes over the contacts that legs take, about: steps, or those of a minimiser; of a relaxation's longest
/// time a part.
double expected_passes(const std::vector<Leg>& legs, const Measure& measure, double contact_duration);

/// All stages of a test whose path starts at `nu_start`.
std::vector<Stage> plan_stages(const Scene& scene, double nu_start, const LongestSteps& longest);

/// The stage of segment i again, when the strain so far is known.
Stage stage_from(const Scene& scene, std::size_t i, const Waypoint& from, const LongestSteps& longest);

/// Throws Error (file, segment) if the box becomes narrower along the path than its largest grain allows, or
/// is tilted so far that its edges no longer hold it, as far as its strain is known in advance: under stress
/// control, of the axes that no stress strains. `start` is the state the first stage starts from.
void check_width(const std::vector<Stage>& stages, const State& start, const Scene& scene);

}  // namespace grainlaw::dem
