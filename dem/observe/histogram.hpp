// A density of something over its mean.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace grainlaw::dem::observe {

/// Bins are centred on x = 0, 0.1, ... 8, so that what equals the mean falls in the middle of one. What lies
/// outside (a contact that pulls; a huge force) is in no bin but counted in the total: sum P 0.1 may be
/// below 1.
class Histogram {
 public:
  static constexpr std::array<std::string_view, 3> columns{"x", "P", "count"};
  static constexpr double width = 0.1;
  static constexpr std::size_t bins = 81;

  void add(double x) {
    ++total_;
    const double bin = std::floor(x / width + 0.5);
    if (bin >= 0 && bin < static_cast<double>(bins)) ++counts_[static_cast<std::size_t>(bin)];
  }
  /// Rows of the three columns; none where nothing was added.
  template <class Append>
  void write(Append&& append) const {
    if (total_ == 0) return;
    for (std::size_t k = 0; k < bins; ++k) {
      const double count = static_cast<double>(counts_[k]);
      append(std::array<double, 3>{static_cast<double>(k) / 10, count / (static_cast<double>(total_) * width),
                                   count});
    }
  }

 private:
  std::array<std::uint64_t, bins> counts_{};
  std::uint64_t total_ = 0;
};

}  // namespace grainlaw::dem::observe
