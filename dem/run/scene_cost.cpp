#include "grainlaw/dem/run/scene_cost.hpp"

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/run/watch.hpp"

namespace grainlaw::dem {

double SceneCost::seconds_of_rows_and_files() const {
  double sum = row_seconds * static_cast<double>(rows) + moduli_seconds * static_cast<double>(moduli) +
               snapshot_seconds * static_cast<double>(snapshots);
  for (const ObserverCost& observer : observers) sum += observer.seconds_per_row * static_cast<double>(rows);
  return sum;
}

double SceneCost::seconds_without_checkpoints(double StageCost::*of) const {
  double sum = seconds_of_rows_and_files();
  for (const StageCost& stage : stages) sum += stage.*of;
  return sum;
}

double SceneCost::checkpoints_in(double seconds) const {
  return std::floor(seconds / std::max(checkpoint_every, Watch::shortest_interval));
}

double SceneCost::with_checkpoints(double StageCost::*of) const {
  const double seconds = seconds_without_checkpoints(of);
  return seconds + checkpoints_in(seconds) * checkpoint_seconds;
}

double SceneCost::checkpoints() const {
  return checkpoints_in(seconds_without_checkpoints(&StageCost::seconds));
}

double SceneCost::seconds() const { return with_checkpoints(&StageCost::seconds); }
double SceneCost::least() const { return with_checkpoints(&StageCost::least); }
double SceneCost::most() const { return with_checkpoints(&StageCost::most); }

double SceneCost::particle_steps() const {
  double sum = 0;
  for (const StageCost& stage : stages) sum += stage.passes * static_cast<double>(grains);
  return sum;
}

double SceneCost::held_bytes() const {
  double sum = 0;
  for (const FieldCost& field : fields)
    if (!field.passing) sum += field.bytes_per_grain * static_cast<double>(grains);
  double network = 0;
  for (const ObserverCost& observer : observers) {
    sum += observer.kept_bytes;
    network = std::max(network, observer.network_bytes);
  }
  return sum + network;
}

double SceneCost::passing_bytes() const {
  double sum = 0;
  for (const FieldCost& field : fields)
    if (field.passing) sum += field.bytes_per_grain * static_cast<double>(grains);
  return sum;
}

/// Beside what is kept: one observer after the other looks at the same contacts.
double SceneCost::bytes_of_a_row() const {
  double most = 0;
  for (const ObserverCost& observer : observers)
    most = std::max(most, observer.bytes - observer.kept_bytes - observer.network_bytes);
  return most;
}

double SceneCost::bytes() const {
  double beside = std::max({passing_bytes(), moduli_bytes, bytes_of_a_row()});
  for (const StageCost& stage : stages) beside = std::max(beside, stage.bytes);
  return held_bytes() + beside;
}

}  // namespace grainlaw::dem
