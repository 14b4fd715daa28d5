// Turns measurements into rows of record.csv, and watches what the rows say about the quality of the run.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/dem/step/measure.hpp"
#include "grainlaw/element/column_groups.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::dem {

class RowWriter {
 public:
  /// `nu_start` is the volume fraction at the start of the path; `standard` are of column_groups(), and
  /// `observe` names what is measured beside their columns.
  RowWriter(const Material& material, const std::vector<Leg>& legs, double nu_start,
            const std::vector<std::string>& standard = column_groups(),
            const std::vector<std::string>& observe = {});

  /// Measures what was asked for and nothing else, and appends one row: `eps_dev` of the path where the box
  /// is, `time` since the start of the path in us. Throws Error if the grains have become unstable (energies
  /// not finite; of the kinetic energy, this is looked at whatever was asked for).
  void append(const Dynamics& dynamics, std::size_t segment, double eps_dev, double time);

  double eps_vol(const Measurement& m) const;
  /// What a row takes beside nu.
  const Wanted& wanted() const { return wanted_; }
  const Record& record() const { return record_; }
  /// What goes into files of its own.
  const std::vector<observe::Table>& tables() const { return observers_.tables(); }

  /// Sentences on E_k/E_p above 1e-3 and above 1 among the rows that bear load (P over k* at least 1e-3;
  /// below jamming the ratio says nothing); or that nobody watched.
  std::vector<std::string> warnings() const;
  /// Whether stress and energies are measured, by which the ratio is watched.
  bool watches() const;

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    std::vector<std::vector<double>> columns = observe::columns_of(self.record_);
    archive(columns, self.bearing_, self.restless_, self.violent_, self.worst_ratio_, self.worst_nu_,
            self.observers_);
    if constexpr (!std::is_const_v<Self>) self.record_ = observe::record_of(self.record_.columns(), columns);
  }

 private:
  double pressure(const Measurement& m) const;
  std::vector<double> standard_values(const Measurement& m, std::size_t segment, double eps_dev,
                                      double time) const;
  void watch(const Measurement& m);

  Material material_;
  SignConvention sign_;
  double nu_start_;
  observe::Observers observers_;
  std::vector<std::string> columns_;  ///< the standard ones
  Wanted standard_;                   ///< what they take
  Wanted wanted_;                     ///< and what the observers read
  Record record_;
  std::uint64_t bearing_ = 0, restless_ = 0, violent_ = 0;
  double worst_ratio_ = 0, worst_nu_ = 0;
};

}  // namespace grainlaw::dem
