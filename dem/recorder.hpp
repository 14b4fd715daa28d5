// Writes down what a test measures: the rows of its record, and its snapshots.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/dem/dynamics.hpp"
#include "grainlaw/dem/row_writer.hpp"
#include "grainlaw/dem/scene.hpp"
#include "grainlaw/dem/snapshot.hpp"
#include "grainlaw/dem/stage.hpp"

namespace grainlaw::dem {

/// Looks at the grains and never changes them.
class Recorder {
 public:
  Recorder(const Scene& scene, std::filesystem::path dir, double nu_start);

  /// The first row: the start of the path.
  void begin_path(const Dynamics& dynamics);
  bool begun() const { return rows_.record().rows() > 0; }
  /// What is to be written down on `stage`, of which so many steps are taken.
  void enter(const Dynamics& dynamics, const Stage& stage, std::uint64_t taken);
  void after_step(const Dynamics& dynamics, const Stage& stage, std::uint64_t step);
  /// What is left, where a relaxation ended early.
  void leave(const Dynamics& dynamics, const Stage& stage);

  const Record& record() const { return rows_.record(); }
  std::vector<std::string> warnings() const { return rows_.warnings(); }

 private:
  using Steps = std::vector<std::uint64_t>;
  void write_row(const Dynamics& dynamics, const Stage& stage, double progress);
  void take_snapshot(const Dynamics& dynamics, const Stage& stage, double progress);

  std::filesystem::path dir_;
  double nu_start_;
  double path_begin_ = 0;  ///< us
  RowWriter rows_;
  std::unique_ptr<SnapshotWriter> snapshots_;
  Steps::const_iterator next_row_, next_snapshot_;  ///< of the stage it is in
};

}  // namespace grainlaw::dem
