// The moduli of states that a test passes through: a copy of the grains is brought into balance, and the test
// goes on as if nobody had looked.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "grainlaw/dem/observe/observers.hpp"
#include "grainlaw/dem/packing/state.hpp"
#include "grainlaw/element/material.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::dem {

class ModuliWriter {
 public:
  static constexpr auto file = "moduli.csv";

  ModuliWriter(const Material& material, const std::vector<Leg>& legs);

  /// Appends one row, along the axis of the deviatoric scalars on that segment; without moduli where the
  /// state is refused (see ProbedPacking).
  void append(const State& state, std::size_t segment, double eps_dev);

  const Record& record() const { return record_; }
  /// A sentence on each state that was refused.
  const std::vector<std::string>& warnings() const { return warnings_; }

  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    std::vector<std::vector<double>> columns = observe::columns_of(self.record_);
    archive(columns, self.warnings_);
    if constexpr (!std::is_const_v<Self>) self.record_ = observe::record_of(self.record_.columns(), columns);
  }

 private:
  Material material_;
  SignConvention sign_;
  Record record_;
  std::vector<std::string> warnings_;
};

}  // namespace grainlaw::dem
