// How the contact forces are distributed.
#pragma once

#include <string_view>

#include "grainlaw/dem/observe/histogram.hpp"
#include "grainlaw/dem/observe/view.hpp"

namespace grainlaw::dem::observe {

/// P(f/<f>).
struct ForceDistribution {
  static constexpr std::string_view name = "force_distribution";
  static constexpr std::array<std::string_view, 0> columns{};
  static constexpr std::size_t grain_bytes = 0;
  static constexpr bool walks_contacts = true;
  static constexpr Wanted reads{};
  static constexpr std::string_view file = "force_distribution.csv";
  static constexpr auto table_columns = Histogram::columns;
  static constexpr std::size_t table_rows = Histogram::bins;
  std::array<double, 0> values(const View&) const { return {}; }
  template <class Append>
  void tabulate(const View& view, Append&& append) const {
    Histogram histogram;
    for (const Touch& c : view.network.contacts) histogram.add(c.force / view.network.mean_force);
    histogram.write(append);
  }
};

}  // namespace grainlaw::dem::observe
