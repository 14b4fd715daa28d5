// Overlaps of the contacts: their mean (Eq. 2.13) and how they are distributed.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/histogram.hpp"
#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// <delta>/<r>: the mean over contacts, over the mean radius of the material.
struct Overlap {
  static constexpr std::string_view name = "overlap";
  static constexpr std::array<std::string_view, 1> columns{"overlap"};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  std::array<double, 1> values(const View& view) const {
    return {view.network.mean_overlap / view.material.r_mean};
  }
};

/// P(delta/<delta>).
struct OverlapDistribution {
  static constexpr std::string_view name = "overlap_distribution";
  static constexpr std::array<std::string_view, 0> columns{};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  static constexpr std::string_view file = "overlap_distribution.csv";
  static constexpr auto table_columns = Histogram::columns;
  static constexpr std::size_t table_rows = Histogram::bins;
  std::array<double, 0> values(const View&) const { return {}; }
  template <class Append>
  void tabulate(const View& view, Append&& append) const {
    Histogram histogram;
    for (const Touch& c : view.network.contacts) histogram.add(c.overlap / view.network.mean_overlap);
    histogram.write(append);
  }
};

}  // namespace grainlaw::dem::observe
