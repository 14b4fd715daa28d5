// Turns measurements into rows of record.csv, and watches what the rows say about the quality of the run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grainlaw/dem/measure.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::dem {

class RowWriter {
 public:
  /// `nu_start` is the volume fraction at the start of the path.
  RowWriter(const Material& material, const std::vector<Leg>& legs, double nu_start);

  /// One row: `progress` in [0, 1] along leg `segment`, `time` since the start of the path in us.
  /// Throws Error if the grains have become unstable (energies not finite).
  void append(const Measurement& m, std::size_t segment, double progress, double time);

  double eps_vol(const Measurement& m) const;
  double eps_dev(std::size_t segment, double progress) const;
  const Record& record() const { return record_; }

  /// Sentences on E_k/E_p above 1e-3 and above 1 among the rows that bear load (at least half the grains have
  /// four contacts; below jamming the ratio says nothing).
  std::vector<std::string> warnings() const;

 private:
  Material material_;
  std::vector<Leg> legs_;
  SignConvention sign_;
  double nu_start_;
  Record record_;
  std::uint64_t bearing_ = 0, restless_ = 0, violent_ = 0;
  double worst_ratio_ = 0, worst_nu_ = 0;
};

}  // namespace grainlaw::dem
