// What a scene takes: of each stage, row, observer and file, and their sums.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"

namespace grainlaw::dem {

/// Bytes per grain of one field, and what it is for.
struct FieldCost {
  std::string name;
  double bytes_per_grain;
  bool passing = false;  ///< held for a moment, and not while a row is measured or an energy minimised
};

struct StageCost {
  Stage stage;
  double nu[2];                ///< volume fraction at begin and end
  double passes = 0;           ///< over the contacts, planned or tried
  double seconds = 0;          ///< without rows; of a relaxation that is not tried, the most
  double least = 0, most = 0;  ///< between which they mostly lie; `seconds` both, where no range is known
  bool tried = false;          ///< whether it was run, or a part of it (see try_leg)
  double ran = 0;              ///< s, after which a run of it was given up; it takes more
  bool still_moves = false;  ///< whether its grains do, of before (see still_moving), and what is said of it
                             ///< comes from grains at rest: it takes more
  double bytes = 0;          ///< held beside the grains while it lasts
};

struct ObserverCost {
  std::string name;
  double seconds_per_row = 0;
  double bytes = 0;          ///< alone: all that it holds while a row is measured
  double kept_bytes = 0;     ///< of these, by this one from row to row, tables included
  double network_bytes = 0;  ///< of these, the contacts, which observers share and keep
};

struct SceneCost {
  std::size_t grains = 0;
  double contacts_per_grain = 0, pairs_per_grain = 0;  ///< in the trial, each pair once
  double force_seconds = 0;                            ///< of a step: contact forces
  double damping_seconds = 0;                          ///< of these the viscous term
  double motion_seconds = 0;                           ///< of a step: motion and lists
  double row_seconds = 0;                              ///< of a row: the standard columns asked for
  std::size_t rows = 0, snapshots = 0;
  double snapshot_seconds = 0, snapshot_bytes = 0;  ///< each
  double checkpoint_every = 0;                      ///< s
  double checkpoint_seconds = 0;                    ///< each; without waiting for the disk
  double checkpoint_bytes = 0;                      ///< on disk, where two are kept
  std::size_t moduli = 0;                           ///< states whose moduli are measured
  double moduli_seconds = 0;  ///< of each: balance and linear response (dem/run/moduli_cost.hpp)
  double moduli_bytes = 0;    ///< held meanwhile
  std::vector<FieldCost> fields;
  std::vector<StageCost> stages;
  std::vector<ObserverCost> observers;

  double seconds() const;      ///< of one core, all together
  double least() const;        ///< s: with the least of each stage
  double most() const;         ///< s: with the most of each
  double checkpoints() const;  ///< that fall into them
  double particle_steps() const;
  double bytes() const;  ///< of memory, at most

 private:
  double seconds_of_rows_and_files() const;
  double seconds_without_checkpoints(double StageCost::*of) const;
  double checkpoints_in(double seconds) const;
  double with_checkpoints(double StageCost::*of) const;
  double held_bytes() const;
  double passing_bytes() const;
  double bytes_of_a_row() const;
};

}  // namespace grainlaw::dem
