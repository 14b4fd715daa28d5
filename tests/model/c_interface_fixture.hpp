// A law of the thesis with a context and a point, as a host has them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "checks.hpp"
#include "grainlaw.h"

namespace grainlaw::model {

using Six = std::array<double, 6>;

constexpr Six d2_step{-1e-4, 1e-4, 0, 0, 0, 0};

/// A law, a context, and the state of a point at nu = 0.711.
class CInterface : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(grainlaw_axis("d2", settings.axis), GRAINLAW_OK);
    make(thesis().to_json().dump());
  }
  void TearDown() override { destroy(); }

  void destroy() {
    grainlaw_context_destroy(context);
    grainlaw_law_destroy(law);
  }
  void make(const std::string& text) {
    destroy();
    char message[256];
    ASSERT_EQ(grainlaw_law_from_text(text.c_str(), &settings, &law, message, sizeof message), GRAINLAW_OK)
        << message;
    ASSERT_EQ(grainlaw_context_create(law, &context), GRAINLAW_OK);
    state.assign(grainlaw_state_length(law), 0);
    ASSERT_EQ(begin({{"nu", 0.711}}), GRAINLAW_OK) << said();
  }
  /// A set whose s_max is negative at high densities.
  void make_failing() {
    ParameterSet set = thesis();
    set.shear->s_max->Q_max.value = -0.05;
    make(set.to_json().dump());
  }

  using Given = std::vector<std::pair<const char*, double>>;
  int begin(const Given& given) {
    std::vector<const char*> names;
    std::vector<double> values;
    for (const auto& [name, value] : given) {
      names.push_back(name);
      values.push_back(value);
    }
    return grainlaw_start(context, given.size(), names.data(), values.data(), state.data(), state.size());
  }
  int update(const Six& increment, double* matrix = nullptr) {
    return grainlaw_update(context, state.data(), state.size(), increment.data(), stress.data(), matrix);
  }
  double& entry(const char* name) {
    return state.at(static_cast<std::size_t>(grainlaw_state_index(law, name)));
  }
  std::string said() const { return grainlaw_message(context); }

  /// The status, and that neither state nor stress has changed.
  void expect_refused(int status, int expected, const std::string& why, const std::vector<double>& before) {
    EXPECT_EQ(status, expected) << said();
    EXPECT_THAT(said(), testing::HasSubstr(why));
    EXPECT_TRUE(std::equal(state.begin(), state.end(), before.begin(),
                           [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }));
    EXPECT_EQ(stress, untouched);
  }

  static constexpr Six untouched{7, 7, 7, 7, 7, 7};
  grainlaw_settings settings = GRAINLAW_SETTINGS;
  grainlaw_law* law = nullptr;
  grainlaw_context* context = nullptr;
  std::vector<double> state;
  Six stress = untouched;
  std::array<double, 36> tangent{};
};

}  // namespace grainlaw::model
