// A batch of points: the same answers as one by one, ordinary or not, on one thread or several, and failures
// that name their point.
#include "grainlaw/model/light/light_batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

State start_at(const Law& law, double nu) {
  State state;
  state.nu = nu;
  state.P = pressure(laws_of(law).pressure, nu);
  state.phi_J = jamming_density(laws_of(law).pressure);
  state.jammed = state.P > 0;
  if (const auto* form = std::get_if<Memory>(&law)) {
    state.history = {state.phi_J, 0.82, nu};
    state.shear.steady = form->steady_density(nu);
  }
  return state;
}

/// Takes points of many densities through `count` random increments, some of them without shear, without
/// volume, or of the other direction, both ways, and compares every state.
void expect_as_one_by_one(const LightLaw& law, double size, int count, int threads) {
  const std::size_t points = threads > 1 ? 4099 : 1003;  // what threads share, and what they do not
  LightBatch batch(law, points, start_at(law.law(), 0.7));
  std::vector<State> singles;
  for (std::size_t i = 0; i < points; ++i) {
    singles.push_back(start_at(law.law(), 0.66 + 0.1 * static_cast<double>(i) / static_cast<double>(points)));
    batch.set_state(i, singles.back());
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<double> v(points), e(points);
  for (int step = 0; step < count; ++step) {
    for (std::size_t i = 0; i < points; ++i) {
      v[i] = step % 3 == 0 ? size * any(random) : 0;
      e[i] = step % 5 == 0 && i % 7 == 0 ? 0 : size * (i % 11 == 0 ? any(random) : 1);
    }
    ASSERT_EQ(batch.update(v, e, threads).failed, 0U);
    for (std::size_t i = 0; i < points; ++i) ASSERT_FALSE(law.update(singles[i], v[i], e[i]).failed());
  }
  for (std::size_t i = 0; i < points; ++i) {
    const State one = singles[i], many = batch.state(i);
    ASSERT_EQ(one.jammed, many.jammed) << i;
    EXPECT_NEAR(one.P, many.P, 1e-7 * (1e-4 + one.P)) << i;
    EXPECT_NEAR(one.sigma_dev, many.sigma_dev, 1e-7 * (1e-4 + one.P)) << i;
    EXPECT_NEAR(one.F_dev, many.F_dev, 1e-7) << i;
    EXPECT_NEAR(one.nu, many.nu, 1e-14) << i;
    EXPECT_NEAR(one.eps_dev, many.eps_dev, 1e-12) << i;
    EXPECT_EQ(one.direction.q, many.direction.q) << i;
    EXPECT_NEAR(one.direction.S_I, many.direction.S_I, 1e-5) << i;
  }
}

TEST(LightBatch, AnswersAsOneByOne) {
  for (const char* name : {"reduced_closed", "reduced", "coupled", "memory", "coupled_3_14"}) {
    SCOPED_TRACE(name);
    const LightLaw law(make_law(thesis_with_memory(), choice_of(name)), {1e-8, 1e-11});
    const bool in_lanes = LightBatch::runs_in_lanes(law.law());  // without them it is one by one
    expect_as_one_by_one(law, 1e-4, in_lanes ? 60 : 6, 1);
    expect_as_one_by_one(law, 1e-2, in_lanes ? 10 : 6, 3);
  }
}

TEST(LightBatch, FewerPointsThanLanesAndNone) {
  const LightLaw law(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  LightBatch few(law, 3, start_at(law.law(), 0.7)), none(law, 0, start_at(law.law(), 0.7));
  const std::vector<double> v{0, 0, 0}, e{1e-4, 2e-4, 0};
  ASSERT_EQ(few.update(v, e).failed, 0U);
  EXPECT_EQ(none.update({}, {}, 2).failed, 0U);
  EXPECT_NEAR(few.sigma_dev()[1], 2 * few.sigma_dev()[0], 0.01 * few.sigma_dev()[1]);
  EXPECT_EQ(few.sigma_dev()[2], 0);
}

TEST(LightBatch, AFailureNamesItsPointAndLeavesItAlone) {
  const LightLaw law(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  constexpr std::size_t points = 10000;  // enough for several threads
  LightBatch batch(law, points, start_at(law.law(), 0.7));
  std::vector<double> v(points, 0.0), e(points, 1e-4);
  e[42] = std::nan("");
  v[7777] = INFINITY;
  for (const int threads : {1, 4}) {
    const State before = batch.state(42), other = batch.state(41);
    const auto outcome = batch.update(v, e, threads);
    EXPECT_EQ(outcome.failed, 2U);
    EXPECT_EQ(outcome.first, 42U);
    EXPECT_THAT(outcome.status.message, HasSubstr("must be finite"));
    EXPECT_EQ(batch.state(42).P, before.P);
    EXPECT_EQ(batch.state(42).eps_dev, before.eps_dev);
    EXPECT_NEAR(batch.state(41).eps_dev, other.eps_dev + 1e-4, 1e-16);
  }
}

TEST(LightBatch, RefusesWhatDoesNotFit) {
  const LightLaw law(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  LightBatch batch(law, 10, start_at(law.law(), 0.7));
  const std::vector<double> ten(10), nine(9);
  EXPECT_THAT(refusal([&] { batch.update(nine, ten); }), HasSubstr("eps_vol: must have one number for each"));
  EXPECT_THAT(refusal([&] { batch.update(ten, nine); }), HasSubstr("eps_dev: must have one number for each"));
  EXPECT_THAT(refusal([&] { batch.update(ten, ten, 0); }), HasSubstr("threads: must be >= 1"));
}

}  // namespace
}  // namespace grainlaw::model
