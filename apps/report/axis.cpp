#include "grainlaw/apps/report/axis.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace grainlaw::report {
namespace {

/// The smallest of 1, 2, 5 times a power of ten that cuts `span` into at most `most` pieces.
double round_step(double span, int most) {
  const double least = span / std::max(1, most);
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1 - 1e-9)) return factor * decade;
  }
  return 10 * decade;
}

/// Decimals that a multiple of `step` needs.
int decimals_of(double step) {
  for (int decimals = 0; decimals < 12; ++decimals) {
    const double scaled = step * std::pow(10.0, decimals);
    if (std::abs(scaled - std::round(scaled)) < 1e-6 * scaled) return decimals;
  }
  return 12;
}

std::string print_fixed(double x, int decimals) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, std::abs(x), std::chars_format::fixed, decimals).ptr;
  const std::string digits(text, end);
  const bool is_zero = digits.find_first_not_of("0.") == std::string::npos;
  return x < 0 && !is_zero ? "−" + digits : digits;
}

/// Thousands or thousandths to take out of the labels where they would be long.
int power_for(double largest) {
  if (largest >= 1e5) return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  if (largest < 1e-2) return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  return 0;
}

}  // namespace

Axis make_axis(std::array<double, 2> range, int most, double unit, std::size_t least) {
  Axis axis{range[0], range[1], {}, 0};
  const double largest = std::max(std::abs(range[0]), std::abs(range[1])) * unit;
  axis.power = power_for(largest);
  const double shown = unit / std::pow(10.0, axis.power);  // label value per unit of data
  // A step that leaves too few marks inside the range is too coarse.
  for (int attempt = 0; attempt < 3 && axis.tics.size() < least; ++attempt, most *= 2) {
    const double step = round_step((range[1] - range[0]) * shown, most);
    const int decimals = decimals_of(step);
    const double slack = 1e-9 * step;
    axis.tics.clear();
    for (double i = std::ceil((range[0] * shown - slack) / step); i * step <= range[1] * shown + slack; ++i) {
      axis.tics.push_back({i * step / shown, print_fixed(i * step, decimals)});
    }
  }
  return axis;
}

Axis make_log_axis(std::array<double, 2> range, int most) {
  Axis axis{range[0], range[1], {}, 0};
  const int first = static_cast<int>(std::ceil(axis.low)), last = static_cast<int>(std::floor(axis.high));
  if (last <= first) {  // not two decades in it: widened to the next ones
    axis.low = std::floor(axis.low);
    axis.high = std::ceil(axis.high) > axis.low ? std::ceil(axis.high) : axis.low + 1;
  }
  const int low = static_cast<int>(std::ceil(axis.low)), high = static_cast<int>(std::floor(axis.high));
  const int every = std::max(1, (high - low + most - 1) / std::max(1, most));
  for (int decade = low; decade <= high; decade += every)
    axis.tics.push_back({static_cast<double>(decade), "10^{" + std::string(decade < 0 ? "−" : "") +
                                                          std::to_string(std::abs(decade)) + "}"});
  return axis;
}

std::array<double, 2> padded_range(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {0, 1};
  // A span of rounding errors is no span.
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * size || high == low) {
    const double around = size > 0 ? 0.05 * size : 1;
    return {low - around, high + around};
  }
  const double pad = 0.05 * (high - low);
  return {low - pad, high + pad};
}

std::string with_power(const std::string& label, int power) {
  if (power == 0) return label;
  const std::string factor =
      "10^{" + std::string(power < 0 ? "−" : "") + std::to_string(std::abs(power)) + "}";
  const auto open = label.rfind('(');
  if (open == std::string::npos || label.back() != ')') return label + " (" + factor + ")";
  const std::string unit = label.substr(open + 1, label.size() - open - 2);
  return label.substr(0, open + 1) + factor + (unit == "–" ? "" : " " + unit) + ")";
}

}  // namespace grainlaw::report
