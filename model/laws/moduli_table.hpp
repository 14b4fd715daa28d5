// Moduli by a table over the volume fraction: B and (G/B)_ini in place of Eqs. 4.11 and 4.14, and the numbers
// of Eqs. 4.12, 4.13 and 4.15 of each density. Between its rows they are monotone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "grainlaw/model/walk/dual.hpp"

namespace grainlaw::model {

/// What the table gives at one volume fraction; B over k*.
template <class T>
struct TabulatedModuli {
  T B, a_I, a_II, GB_ini, g_I;
};

/// Cubic between the rows with the slopes of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 300, 1984):
/// the curve has one derivative, and rises and falls only where the rows do.
class ModuliTable {
 public:
  enum Column : std::size_t { B, a_I, a_II, GB_ini, g_I, columns };
  static constexpr std::array<const char*, columns> names{"B", "a_I", "a_II", "GB_ini", "g_I"};

  ModuliTable() = default;
  /// `nu` ascends; at least two rows.
  ModuliTable(std::vector<double> nu, std::array<std::vector<double>, columns> values)
      : nu_(std::move(nu)), values_(std::move(values)) {
    for (std::size_t column = 0; column < columns; ++column) slopes_[column] = slopes(values_[column]);
  }

  const std::vector<double>& nu() const { return nu_; }
  const std::vector<double>& values(Column column) const { return values_[column]; }
  /// With room for the rounding error of a path that ends at the last row.
  bool covers(double nu) const {
    return nu > nu_.front() * (1 - rounding) && nu < nu_.back() * (1 + rounding);
  }
  /// Not a number where nu is beyond the table.
  template <class T>
  TabulatedModuli<T> at(const T& nu) const {
    if (!covers(value(nu))) {
      const T none = std::numeric_limits<double>::quiet_NaN();
      return {none, none, none, none, none};
    }
    const auto above = std::upper_bound(nu_.begin() + 1, nu_.end() - 1, value(nu));
    const auto k = static_cast<std::size_t>(above - nu_.begin()) - 1;
    const double width = nu_[k + 1] - nu_[k];
    const T t = (nu - nu_[k]) / width;
    const auto in = [&](Column c) -> T {
      const std::vector<double>&y = values_[c], &slope = slopes_[c];
      const T rest = 1 - t;
      return y[k] + t * t * (3 - 2 * t) * (y[k + 1] - y[k]) +
             t * rest * width * (rest * slope[k] - t * slope[k + 1]);
    };
    return {in(B), in(a_I), in(a_II), in(GB_ini), in(g_I)};
  }

 private:
  static constexpr double rounding = 1e-12;

  /// Harmonic means of the slopes on both sides, weighted by the widths; 0 at a maximum or minimum.
  std::vector<double> slopes(const std::vector<double>& y) const {
    const std::size_t n = nu_.size();
    const auto secant = [&](std::size_t k) { return (y[k + 1] - y[k]) / (nu_[k + 1] - nu_[k]); };
    std::vector<double> slope(n);
    slope.front() = secant(0);
    slope.back() = secant(n - 2);
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const double before = secant(k - 1), after = secant(k);
      if (!(before * after > 0)) continue;
      const double share = (1 + (nu_[k + 1] - nu_[k]) / (nu_[k + 1] - nu_[k - 1])) / 3;
      slope[k] = before * after / (share * after + (1 - share) * before);
    }
    return slope;
  }

  std::vector<double> nu_;
  std::array<std::vector<double>, columns> values_, slopes_;
};

}  // namespace grainlaw::model
