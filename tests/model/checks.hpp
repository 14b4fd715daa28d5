// What the tests of the model share: the thesis's parameter set, paths from text, errors as text, and the V
// shape of a derivative check.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::model {

inline std::filesystem::path thesis_file() {
  return std::filesystem::path(GRAINLAW_DATA_DIR) / "thesis" / "parameters.json";
}

/// w = 3, Tables 2.1, 2.2, 4.1, 5.1; closure P iso, contacts d2 at moduli.nu_c.
inline ParameterSet thesis() { return ParameterSet::load(thesis_file()); }

/// With the numbers of the form with memory, which the thesis has not.
inline ParameterSet thesis_with_memory() {
  ParameterSet set = thesis();
  set.memory->eps_r.emplace().value = 0.145;
  set.memory->hold.emplace().value = 0.3;
  set.memory->pack_rate.emplace().value = 2;
  set.memory->phi_pack.emplace().value = 0.668;
  return set;
}

inline Path path_of(const std::string& text) {
  return Path::read(Reader(parse_json(text, "p.json"), "p.json"));
}

/// What an Error says, or "accepted".
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

/// The forward difference of f at x against its slope there, over steps from 0.1 to 1e-14 of `size`: the
/// error falls with the step (truncation), passes a small minimum, and rises again (rounding). A wrong slope
/// has no minimum, a test that compares a function with itself no rise.
inline void expect_v_shape(const std::function<double(double)>& f, double x, double slope, double size) {
  std::vector<double> errors;
  for (int exponent = -1; exponent >= -14; --exponent) {
    const double moved = x + std::pow(10.0, exponent) * size;
    errors.push_back(std::abs((f(moved) - f(x)) / (moved - x) - slope));
  }
  const auto lowest = std::min_element(errors.begin(), errors.end());
  EXPECT_LT(*lowest, 1e-5 * (std::abs(slope) + std::abs(f(x)) / size));
  EXPECT_GT(errors.front(), 30 * *lowest) << "no truncation error: is f linear?";
  EXPECT_GT(errors.back(), 30 * *lowest) << "no rounding error: is this a difference at all?";
}

}  // namespace grainlaw::model
