// What a scene will take: its planned steps, its memory, and the time of a step, of a row and of each
// observer, measured in a short trial on this machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/scene/scene.hpp"

namespace grainlaw::dem {

/// Processor seconds of this thread: a busy machine disturbs them less than the clock on the wall.
double thread_seconds();

/// Bytes per grain of one field, and what it is for.
struct FieldCost {
  std::string name;
  double bytes_per_grain;
};

struct StageCost {
  Stage stage;
  double nu[2];        ///< volume fraction at begin and end
  double seconds = 0;  ///< without rows; of a relaxation, which may end early, the most
};

struct ObserverCost {
  std::string name;
  double seconds_per_row = 0;
  double bytes = 0;  ///< kept from row to row, tables included, and while a row is measured
};

struct SceneCost {
  std::size_t grains = 0;
  double contacts_per_grain = 0, pairs_per_grain = 0;  ///< in the trial, each pair once
  double force_seconds = 0;                            ///< of a step: contact forces
  double motion_seconds = 0;                           ///< of a step: motion and lists
  double row_seconds = 0;                              ///< of a row: the standard columns
  std::size_t rows = 0, snapshots = 0;
  double snapshot_bytes = 0;  ///< each
  std::size_t moduli = 0;     ///< states whose moduli are measured
  double moduli_seconds = 0;  ///< of each: balance and linear response (dem/run/moduli_cost.hpp)
  std::vector<FieldCost> fields;
  std::vector<StageCost> stages;
  std::vector<ObserverCost> observers;

  double seconds() const;  ///< of one core, all together
  double particle_steps() const;
  double bytes() const;
};

/// Throws Error as run_element_test does for bad input.
SceneCost cost_of(const Scene& scene);

}  // namespace grainlaw::dem
