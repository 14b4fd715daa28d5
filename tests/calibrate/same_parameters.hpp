// Whether a set that stands in the tree is the one that a fit makes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate::test {

/// The same parameters, from the same sources; values as near as a minimum is found, to the square root of
/// rounding.
inline void expect_same_parameters(const model::ParameterSet& fitted, const model::ParameterSet& shipped) {
  const auto ours = fitted.named(), theirs = shipped.named();
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].name, theirs[i].name);
    EXPECT_EQ(ours[i].parameter->source, theirs[i].parameter->source) << ours[i].name;
    EXPECT_NEAR(ours[i].parameter->value, theirs[i].parameter->value,
                1e-5 * (1e-3 + std::abs(theirs[i].parameter->value)))
        << ours[i].name;
  }
}

}  // namespace grainlaw::calibrate::test
