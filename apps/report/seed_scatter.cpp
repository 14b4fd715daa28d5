#include "grainlaw/apps/report/seed_scatter.hpp"

#include <cmath>

namespace grainlaw::report {
namespace {

/// NaN where the columns have nothing to compare.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::nan("");
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    size += 0.5 * (a[i] * a[i] + b[i] * b[i]);
  }
  return std::sqrt(difference / size);
}

}  // namespace

std::optional<double> seed_scatter(const std::vector<const Record*>& records, const std::string& column) {
  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double d = distance((*records[i])[column], (*records[j])[column]);
      if (!std::isfinite(d)) continue;
      sum += d;
      ++pairs;
    }
  }
  if (pairs == 0) return std::nullopt;
  return sum / pairs;
}

}  // namespace grainlaw::report
