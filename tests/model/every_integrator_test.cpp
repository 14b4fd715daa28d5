// The hard cases of docs/model.md, each with its stated outcome, in every form and by every way of walking:
// CVODE by BDF and by Adams, the light path, and a batch.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "grainlaw/model/light/light_batch.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

enum class Way { bdf, adams, light, batch };
constexpr std::array ways{Way::bdf, Way::adams, Way::light, Way::batch};
constexpr std::array way_names{"BDF", "Adams", "light", "batch"};
constexpr Tolerance tolerance{1e-9, 1e-13};

/// A point that one of them walks.
class Walked {
 public:
  Walked(Way way, const Law& law, const State& start) : light_(law, tolerance), state_(start) {
    if (way == Way::bdf || way == Way::adams)
      point_.emplace(law, start, tolerance, way == Way::bdf ? Method::bdf : Method::adams);
    if (way == Way::batch) batch_ = std::make_unique<LightBatch>(light_, points, start);
  }
  Walked(const Walked&) = delete;
  Walked& operator=(const Walked&) = delete;

  const State& state() const { return state_; }
  const Laws& laws() const { return laws_of(light_.law()); }
  double s_max() const { return saturation(laws().s_max, state_.nu); }
  double F_max() const { return saturation(laws().F_max, state_.nu); }

  Status walk(double eps_vol, double eps_dev) {
    Status status;
    if (point_) {
      status = point_->walk(eps_vol, eps_dev);
      state_ = point_->state();
    } else if (batch_) {
      const std::array<double, points> v = all(eps_vol), e = all(eps_dev);
      status = batch_->update(v, e).status;
      for (std::size_t i = 1; i < points; ++i) EXPECT_EQ(batch_->P()[i], batch_->P()[i % 8]);
      state_ = batch_->state(0);
    } else {
      status = light_.update(state_, eps_vol, eps_dev);
    }
    return status;
  }
  /// Must not fail, and leaves a state with numbers that a state may have.
  void expect(double eps_vol, double eps_dev) {
    const Status status = walk(eps_vol, eps_dev);
    EXPECT_FALSE(status.failed()) << status.message;
    EXPECT_TRUE(is_finite(state_));
    EXPECT_GE(state_.P, 0);
    EXPECT_EQ(state_.jammed, state_.P > 0);
  }

 private:
  static constexpr std::size_t points = 11;  // one vector and a part of the next
  static std::array<double, points> all(double x) {
    std::array<double, points> result;
    result.fill(x);
    return result;
  }

  LightLaw light_;
  State state_;
  std::optional<MaterialPoint> point_;
  std::unique_ptr<LightBatch> batch_;
};

constexpr std::array forms{"reduced_closed", "reduced", "coupled",
                           "coupled+energy", "memory",  "coupled_3_14"};

ParameterSet numbers() {
  ParameterSet set = thesis_with_memory();
  set.moduli->a_F.emplace().value = 3.59;
  set.moduli->a_s.emplace().value = 0.149;
  return set;
}

/// Calls check(point) for each form and way, the point at nu; `prepare` may change its state before.
template <class Check>
void everywhere(double nu, Check check, const ParameterSet& set = numbers(),
                const std::function<void(const Law&, State&)>& prepare = {}) {
  for (const char* form : forms)
    for (const Way way : ways) {
      SCOPED_TRACE(std::string(form) + " by " + way_names[static_cast<std::size_t>(way)]);
      Path path;
      path.start.nu = nu;
      StartState start = start_of(set, path, choice_of(form));
      if (prepare) prepare(start.law, start.state);
      Walked point(way, start.law, start.state);
      check(point, choice_of(form).form);
    }
}

/// A sheared state with `s` times s_max and F_max; in the form with memory in steady shear.
void saturate(const Law& law, State& state, double s) {
  if (const auto* form = std::get_if<Memory>(&law)) {
    state.shear.plus = 1;
    state.phi_J = form->jamming_density_of(state);
    state.P = form->pressure_of(state.nu, state.phi_J);
  }
  state.sigma_dev = s * saturation(laws_of(law).s_max, state.nu) * state.P;
  state.F_dev = saturation(laws_of(law).F_max, state.nu);
}

TEST(EveryIntegrator, ExactlyAtSaturationShearOnChangesNothing) {
  everywhere(
      0.711,
      [](Walked& point, Form) {
        const double P = point.state().P;
        point.expect(0, 0.1);
        EXPECT_NEAR(point.state().s_dev() / point.s_max(), 1, 1e-6);
        EXPECT_NEAR(point.state().F_dev / point.F_max(), 1, 1e-6);
        EXPECT_NEAR(point.state().P / P, 1, 1e-6);
      },
      numbers(), [](const Law& law, State& state) { saturate(law, state, 1); });
}

TEST(EveryIntegrator, FromBeyondSaturationShearOnReturnsToIt) {
  everywhere(
      0.711,
      [](Walked& point, Form) {
        double before = point.state().s_dev() / point.s_max();
        EXPECT_NEAR(before, 1.4, 1e-12);
        for (const double e : {1e-6, 1e-3, 0.01, 0.1, 0.4}) {
          point.expect(0, e);
          const double s = point.state().s_dev() / point.s_max();
          EXPECT_LE(s, before + 1e-9);
          EXPECT_GE(s, 1 - 1e-7) << "never through it";
          before = s;
        }
        EXPECT_NEAR(before, 1, 1e-6);
      },
      numbers(), [](const Law& law, State& state) { saturate(law, state, 1.4); });
}

TEST(EveryIntegrator, WithoutPressureThePointIsUnjammedAndMayJamAgain) {
  everywhere(0.7, [](Walked& point, Form) {
    point.expect(0, 0.05);
    point.expect(std::log(0.63 / 0.7), 0.02);
    EXPECT_FALSE(point.state().jammed);
    EXPECT_EQ(point.state().P, 0);
    EXPECT_EQ(point.state().sigma_dev, 0);
    point.expect(-0.1, 0);  // and below: nothing more happens
    EXPECT_EQ(point.state().P, 0);
    point.expect(std::log(0.7 / 0.63) + 0.1, 0.02);
    EXPECT_TRUE(point.state().jammed);
    EXPECT_GT(point.state().P, 0.01);
  });
}

TEST(EveryIntegrator, AtAndAroundTheJammingDensity) {
  const double phi_J = thesis().isotropic.at("iso").nu_c.value;
  for (const double nu : {phi_J, std::nextafter(phi_J, 0), std::nextafter(phi_J, 1), phi_J * (1 + 1e-9)})
    everywhere(nu, [&](Walked& point, Form) {
      EXPECT_TRUE(nu > phi_J || !point.state().jammed);
      for (const double eps_vol : {0.0, 1e-12, -1e-12, 0.02, -0.03, 0.05}) point.expect(eps_vol, 1e-3);
      EXPECT_TRUE(point.state().jammed);
      EXPECT_NEAR(point.state().nu, nu * std::exp(0.04), 1e-12);
    });
}

TEST(EveryIntegrator, ReversalInEveryIncrement) {
  everywhere(0.711, [](Walked& point, Form form) {
    const int times = form == Form::coupled && point.laws().terms == Terms{} ? 100'000 : 3000;
    const double P = point.state().P;
    for (int i = 0; i < times; ++i) ASSERT_FALSE(point.walk(0, i % 2 == 0 ? 1e-5 : -1e-5).failed());
    point.expect(0, 1e-5);
    EXPECT_LT(std::abs(point.state().s_dev()), point.s_max());
    EXPECT_LT(std::abs(point.state().F_dev), point.F_max());
    EXPECT_NEAR(point.state().P / P, 1, form == Form::memory ? 0.1 : 1e-3);
    EXPECT_NEAR(point.state().eps_dev, 1e-5, 1e-10);
  });
}

TEST(EveryIntegrator, TinyAndHugeIncrementsAndNone) {
  everywhere(0.711, [](Walked& point, Form) {
    const State begin = point.state();
    for (int i = 0; i < 100; ++i) point.expect(0, 0);
    EXPECT_EQ(point.state().P, begin.P);
    EXPECT_EQ(point.state().sigma_dev, begin.sigma_dev);
    EXPECT_EQ(point.state().nu, begin.nu);
    for (int i = 0; i < 100; ++i) point.expect(1e-12, 1e-12);
    EXPECT_NEAR(point.state().nu, 0.711 * (1 + 1e-10), 1e-14);
    EXPECT_NEAR(point.state().P, begin.P, 1e-10);
    EXPECT_NEAR(point.state().sigma_dev / 1e-10, 0.15, 0.1);  // G, or P beta_s s_max
    point.expect(0, 1);
    EXPECT_NEAR(point.state().s_dev() / point.s_max(), 1, 1e-6);
    EXPECT_NEAR(point.state().F_dev / point.F_max(), 1, 1e-6);
  });
}

TEST(EveryIntegrator, StiffRates) {
  ParameterSet set = numbers();
  for (auto* law : {&*set.shear->beta_s, &*set.shear->beta_F}) {
    law->Q_max.value = 1e4;
    law->Q_v.value = 0;
  }
  everywhere(
      0.711,
      [](Walked& point, Form) {
        for (const double e : {0.02, -0.04}) {
          point.expect(0, e);
          EXPECT_NEAR(point.state().F_dev, sign(e) * point.F_max(), 1e-7);
        }
        point.expect(0.02, -0.02);
      },
      set);
}

TEST(EveryIntegrator, NegativeGammaP) {
  ParameterSet set = numbers();
  for (auto& [mode, row] : set.isotropic) row.gamma_p.value = -0.5;
  set.moduli->gamma_p.value = -0.5;
  everywhere(
      0.7,
      [](Walked& point, Form) {
        const double P = point.state().P;
        point.expect(0.1, 0.05);
        EXPECT_GT(point.state().P, 2 * P);
        point.expect(-0.2, 0.05);
        EXPECT_FALSE(point.state().jammed);
      },
      set);
}

TEST(EveryIntegrator, WhatIsNoNumberIsRefusedAndTheStateStays) {
  everywhere(0.7, [](Walked& point, Form) {
    const State before = point.state();
    for (const double bad : {std::nan(""), double{INFINITY}})
      for (const auto& [v, e] : {std::pair{bad, 0.0}, {0.0, bad}, {bad, bad}}) {
        const Status status = point.walk(v, e);
        EXPECT_TRUE(status.failed());
        EXPECT_FALSE(status.message.empty());
        EXPECT_EQ(point.state().P, before.P);
        EXPECT_EQ(point.state().eps_dev, before.eps_dev);
      }
  });
  everywhere(
      0.7,
      [](Walked& point, Form) {
        EXPECT_TRUE(point.walk(0.01, 0.01).failed());
        EXPECT_TRUE(std::isnan(point.state().F_dev));
      },
      numbers(), [](const Law&, State& state) { state.F_dev = std::nan(""); });
}

}  // namespace
}  // namespace grainlaw::model
