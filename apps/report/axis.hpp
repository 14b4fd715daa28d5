// An axis with round tic marks: range, step and labels chosen so that labels neither collide nor repeat.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace grainlaw::report {

struct Tic {
  double at;          ///< in the units of the data
  std::string label;  ///< plain UTF-8
};

struct Axis {
  double low, high;
  std::vector<Tic> tics;
  int power = 0;  ///< labels are in units of 10^power
};

/// An axis over [low, high] with about `most` tic marks, and no fewer than `least` (2 or 3); labels show the
/// data times `unit`.
Axis make_axis(std::array<double, 2> range, int most, double unit = 1, std::size_t least = 2);

/// A logarithmic axis: range and places are common logarithms, labels powers of ten (enhanced text); decades
/// are left out where there are more than `most`.
Axis make_log_axis(std::array<double, 2> range, int most);

/// The range of finite values, widened by a twentieth on each side; one value or none gets a range around it.
std::array<double, 2> padded_range(const std::vector<double>& values);

/// "pressure P* (–)" becomes "pressure P* (10^{−3})", "P (kPa)" becomes "P (10^3 kPa)": enhanced text for an
/// axis's power.
std::string with_power(const std::string& label, int power);

}  // namespace grainlaw::report
