// The motion of a trial: how far the box goes before its steps are timed, and that it comes back.
#include "grainlaw/dem/run/trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "packings.hpp"
#include "planned_stage.hpp"

namespace grainlaw::dem {
namespace {

constexpr double nu = 0.7;

Stage stage_of(const std::string& segment) { return test::planned_stage(segment, nu, 2); }

State grains() { return test::squeezed(Material{}, 200, 3, nu); }

/// Of the box so far, along x; compression positive.
double strain_of(const Trial& trial, const State& start) {
  return -std::log(trial.dynamics().cell().edges()(0, 0) / start.box(0, 0));
}

double strain_of_step(const Stage& stage) {
  return stage.leg.strain[0] / static_cast<double>(stage.stepping.steps);
}

/// D2 strains by as much as the leg does, up to 0.3, and iso, which changes the density, by 0.01; half of
/// that before anything is timed.
TEST(Trial, AFastFlowFlowsHalfItsWayFirst) {
  const Material material;
  const State start = grains();
  const auto flowed = [&](const std::string& segment) {
    const Stage stage = stage_of(segment);
    Trial trial(material, start, stage);
    trial.flow_in();
    EXPECT_NEAR(trial.dynamics().cell().edges()(1, 1) / start.box(1, 1),
                std::exp(-strain_of(trial, start) * stage.leg.strain[1] / stage.leg.strain[0]), 1e-9);
    return std::abs(strain_of(trial, start)) / std::abs(strain_of_step(stage));
  };
  const auto steps = [](const std::string& segment, double way) {
    return way / std::abs(strain_of_step(stage_of(segment)));
  };
  const std::string d2 = R"({"mode": "d2", "amount": 0.2, "rate": 0.05})",
                    far = R"({"mode": "d2", "amount": 1.5, "rate": 0.05})",
                    iso = R"({"mode": "iso", "controls": {"nu": 0.8}, "rate": 0.005})",
                    slow = R"({"mode": "d2", "amount": 0.2, "rate": 3e-5})";
  const double d2_way = std::abs(stage_of(d2).leg.strain[0]);
  ASSERT_GT(std::abs(stage_of(far).leg.strain[0]), 0.3);
  ASSERT_GT(d2_way, 0.05);
  EXPECT_NEAR(flowed(d2), 0.5 * steps(d2, d2_way), 1);
  EXPECT_NEAR(flowed(far), 0.5 * steps(far, 0.3), 1);
  EXPECT_NEAR(flowed(iso), 0.5 * steps(iso, 0.01), 1);
  EXPECT_NEAR(flowed(slow), 1, 1e-6);  // the step with which every trial begins
}

/// However many steps are timed.
TEST(Trial, TheBoxGoesToAndFro) {
  const Material material;
  const State start = grains();
  const Stage stage = stage_of(R"({"mode": "iso", "controls": {"nu": 0.8}, "rate": 0.02})");
  const double step = strain_of_step(stage);
  ASSERT_GT(50 * step, 2 * 0.01);  // as many as are done at least
  Trial trial(material, start, stage);
  for (int turn = 0; turn < 3; ++turn) {
    trial.steps();
    EXPECT_GT(strain_of(trial, start), -1e-9);
    EXPECT_LT(strain_of(trial, start), 0.01 + step);
  }
}

}  // namespace
}  // namespace grainlaw::dem
