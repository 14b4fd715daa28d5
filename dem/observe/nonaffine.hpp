// Rearrangement of the neighbourhoods of grains between one row and the next (Falk and Langer 1998).
#pragma once

#include <string_view>
#include <vector>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// D2_min: for a grain with n neighbours, the least of (1/n) sum |b - J b0|^2 over all tensors J, with b0 the
/// branch to a neighbour at the row before and b the one now; over <r>^2, the mean over grains. Neighbours
/// are those whose surfaces were less than <r>/2 apart at the row before; grains are left out whose
/// neighbours lie in a plane. Undefined in the first row.
class Nonaffine {
 public:
  static constexpr std::string_view name = "nonaffine";
  static constexpr std::array<std::string_view, 1> columns{"D2_min"};
  static constexpr std::size_t grain_bytes = 320;
  static constexpr std::size_t kept_bytes = sizeof(Quad);  ///< of these, from row to row
  static constexpr bool walks_contacts = false;
  static constexpr Wanted reads{};
  static constexpr double gap = 0.5;  ///< of neighbours, in <r>

  /// Compares with the row before, and keeps this one for the next.
  std::array<double, 1> values(const View& view);

  /// A row's grains in the order of the State, so that sorting does not matter.
  struct Row {
    Cell cell;    ///< reduced
    Quads place;  ///< wrapped into the box | radius, mm; empty before the first row
  };

  /// For a run that is interrupted between two rows.
  template <class Self, class Archive>
  static void keep(Self& self, Archive& archive) {
    archive(self.last_.cell, self.last_.place);
  }

 private:
  Row last_;
};

}  // namespace grainlaw::dem::observe
