// Writes down what a test measures: the rows of its record, its snapshots, the moduli of states.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grainlaw/dem/drive/stage.hpp"
#include "grainlaw/dem/files/archive.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/record/moduli_writer.hpp"
#include "grainlaw/dem/record/row_writer.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/dem/step/dynamics.hpp"

namespace grainlaw::dem {

/// Looks at the grains and never changes them.
class Recorder {
 public:
  /// The rows so far, while the test runs.
  static constexpr auto rows_file = "rows.csv";

  Recorder(const Scene& scene, std::filesystem::path dir, double nu_start);
  /// As it was when it was kept; snapshots taken since then are dropped.
  Recorder(const Scene& scene, std::filesystem::path dir, double nu_start, ArchiveReader& archive);

  /// The first row: the start of the path.
  void begin_path(const Dynamics& dynamics);
  bool begun() const { return rows_.record().rows() > 0; }
  /// What is to be written down on `stage`, of which `leg` says how far it is.
  void enter(const Dynamics& dynamics, const Stage& stage, const LegState& leg);
  void after_step(const Dynamics& dynamics, const Stage& stage, const LegState& leg);
  /// What is left, where a relaxation ended early.
  void leave(const Dynamics& dynamics, const Stage& stage, const LegState& leg);

  /// Brings all snapshots to the disk, and the rows so far into rows.csv.
  void flush() const;
  const Record& record() const { return rows_.record(); }
  const std::vector<observe::Table>& tables() const { return rows_.tables(); }
  /// Without rows where the scene asks for none.
  const Record& moduli() const { return moduli_.record(); }
  std::vector<std::string> warnings() const;

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.path_begin_, self.rows_, self.moduli_, self.frames_, self.rows_done_, self.wanted_,
            self.missed_);
  }

 private:
  std::filesystem::path snapshot_file() const { return dir_ / "snapshots.h5"; }
  using Steps = std::vector<std::uint64_t>;
  void after_controlled_step(const Dynamics& dynamics, const Stage& stage, const LegState& leg);
  bool passed(const StateRequest& wanted, const Dynamics& dynamics, const Stage& stage,
              const LegState& leg) const;
  void write_row(const Dynamics& dynamics, const Stage& stage, double eps_dev);
  void take_snapshot(const Dynamics& dynamics, const Stage& stage, double eps_dev);
  /// What falls on step `step` of a leg that is not controlled.
  void take_due(std::uint64_t step, const Dynamics& dynamics, const Stage& stage, const LegState& leg);
  bool wants_moduli(std::uint64_t request) const { return request >= snapshot_requests_; }
  /// The snapshots (one for all of them) and moduli of these requests, here.
  void take(const Steps& requests, const Dynamics& dynamics, const Stage& stage, double eps_dev);

  std::filesystem::path dir_;
  std::vector<StateRequest> requests_;  ///< those of snapshots, then those of moduli
  std::size_t snapshot_requests_;
  double nu_start_;
  double path_begin_ = 0;  ///< us
  RowWriter rows_;
  ModuliWriter moduli_;
  std::unique_ptr<SnapshotWriter> snapshots_;
  std::uint64_t frames_ = 0;
  Steps::const_iterator next_row_, next_snapshot_, next_moduli_;  ///< of the stage it is in
  std::uint64_t rows_done_ = 0;                                   ///< of the controlled stage it is in
  Steps wanted_;  ///< requests that the controlled stage it is in has not come to, as indices
  Steps missed_;  ///< those that a stage never came to
};

}  // namespace grainlaw::dem
