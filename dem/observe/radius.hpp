// Quantities by the radius of the grains: overlap, C* and F_dev (Figs. 3.4, 3.9, 3.13).
#pragma once

#include <functional>
#include <string_view>

#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// Twenty bins of equal width in (r - r_min)/(r_max - r_min), from the smallest grain present to the largest:
/// overlap(r), the mean over the contacts of the grains in a bin, over <r>; C*(r) = M4/N4 of the bin;
/// F_dev(r), the signed deviator of (V_s/V_bin) (1/V) sum_{p in bin} V_p sum_c n (x) n, with V_s the volume
/// of all grains and V_bin that of the bin's, so that the mean over bins weighted with V_bin/V_s is the
/// fabric itself.
struct Radius {
  static constexpr std::string_view name = "radius";
  static constexpr std::array<std::string_view, 0> columns{};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  static constexpr std::string_view file = "radius.csv";
  static constexpr std::array<std::string_view, 5> table_columns{"r_sc", "grains", "overlap", "C_star",
                                                                 "F_dev"};
  static constexpr std::size_t bins = 20, table_rows = bins;
  std::array<double, 0> values(const View&) const { return {}; }
  void tabulate(const View& view, const std::function<void(const std::array<double, 5>&)>& append) const;
};

}  // namespace grainlaw::dem::observe
