// The light path: order of its methods, the error that was asked for, agreement with CVODE through every
// event, tangents against differences, and hard increments.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "allocations.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled, Form::coupled_3_14};

State start_at(const Law& law, double nu) {
  State state;
  state.nu = nu;
  state.P = pressure(laws_of(law).pressure, nu);
  state.phi_J = jamming_density(laws_of(law).pressure);
  state.jammed = state.P > 0;
  if (!state.jammed) state.P = 0;
  return state;
}

/// y' = -3 (y - cos t) - sin t with y(0) = 2.
struct Relaxation {
  template <class X, class Y>
  bool operator()(const X& t, const Y* y, Y* dydt) const {
    if constexpr (std::is_same_v<X, double>)
      dydt[0] = -3 * (y[0] - std::cos(t)) - std::sin(t);
    else
      dydt[0] = -3 * (y[0] - cosine(t)) - sine(t);
    return true;
  }
  static Dual<2> cosine(const Dual<2>& t) { return Dual<2>::chain(std::cos(t.value), -std::sin(t.value), t); }
  static Dual<2> sine(const Dual<2>& t) { return Dual<2>::chain(std::sin(t.value), std::cos(t.value), t); }
};

template <class Step>
double order_of(Step step) {
  const auto error = [&](int count) {
    std::array<double, 1> y{2};
    for (int i = 0; i < count; ++i) step(y, i / double(count), 1 / double(count));
    return std::abs(y[0] - (std::cos(1) + std::exp(-3)));
  };
  return std::log2(error(32) / error(64));
}

template <class Pair>
double order_of_pair() {
  return order_of([](std::array<double, 1>& y, double t, double h) {
    const Relaxation relaxation;
    std::array<std::array<double, 1>, Pair::stages> k;
    Trial<double, 1> trial;
    relaxation(t, y.data(), k[0].data());
    trial_step<Pair>([&](double c, const double* x, double* dx) { return relaxation(t + c * h, x, dx); }, y,
                     h, k, trial);
    y = trial.y;
  });
}

TEST(Light, MethodsHaveTheirOrder) {
  EXPECT_NEAR(order_of_pair<BogackiShampine>(), 3, 0.2);
  EXPECT_NEAR(order_of_pair<DormandPrince>(), 5, 0.3);
  EXPECT_NEAR(order_of([](std::array<double, 1>& y, double t, double h) {
                Trial<double, 1> trial;
                rosenbrock_step(Relaxation{}, y, t, h, trial);
                y = trial.y;
              }),
              4, 0.3);
}

/// Increments (eps_vol, eps_dev) that pass reversals, volume change, unjamming in shear and in decompression,
/// and back.
const std::vector<std::array<double, 2>> eventful{
    {0, 0.2}, {0, -0.3},  {0.05, 0.05}, {-0.05, 0.02}, {-0.08, -0.08}, {0.02, 0}, {0.1, 0.1},
    {0, 0},   {0, -0.05}, {-0.2, 0},    {0.16, 0.02},  {0.02, 0.02},   {0, 1}};

/// Largest difference of P, sigma_dev and F_dev at the ends of the increments, over the largest value of
/// each.
struct Ends {
  std::vector<State> states;
  double distance(const Ends& other) const {
    double worst = 0;
    for (const auto member : {&State::P, &State::sigma_dev, &State::F_dev}) {
      double most = 0, size = 0;
      for (std::size_t i = 0; i < states.size(); ++i) {
        most = std::max(most, std::abs(states[i].*member - other.states[i].*member));
        size = std::max(size, std::abs(other.states[i].*member));
      }
      worst = std::max(worst, most / size);
    }
    return worst;
  }
};

Ends by_cvode(const Law& law, const State& start, const std::vector<std::array<double, 2>>& increments) {
  MaterialPoint point(law, start, {1e-12, 1e-15});
  Ends ends;
  for (const auto& [v, e] : increments) {
    const Status status = point.walk(v, e);
    EXPECT_FALSE(status.failed()) << status.message;
    ends.states.push_back(point.state());
  }
  return ends;
}

Ends by_light(const LightLaw& law, State state, const std::vector<std::array<double, 2>>& increments) {
  Ends ends;
  for (const auto& [v, e] : increments) {
    const Status status = law.update(state, v, e);
    EXPECT_FALSE(status.failed()) << status.message;
    ends.states.push_back(state);
  }
  return ends;
}

TEST(Light, AchievesTheAskedErrorThroughEveryEvent) {
  for (const Form form : forms) {
    const Law law = make_law(thesis(), form);
    const State start = start_at(law, 0.7);
    const Ends reference = by_cvode(law, start, eventful);
    EXPECT_TRUE(
        std::any_of(reference.states.begin(), reference.states.end(), [](auto& s) { return !s.jammed; }));
    for (const LightMethod method : {LightMethod::automatic, LightMethod::explicit_third,
                                     LightMethod::explicit_fifth, LightMethod::rosenbrock})
      for (const double rtol : {1e-3, 1e-5, 1e-7, 1e-9}) {
        const LightLaw light(law, {rtol, 1e-3 * rtol}, method);
        EXPECT_LT(by_light(light, start, eventful).distance(reference), 10 * rtol)
            << name_of(form) << " method " << static_cast<int>(method) << " rtol " << rtol;
      }
  }
}

TEST(Light, SmallIncrementsAgreeWithLargeOnes) {
  for (const Form form : forms) {
    const Law law = make_law(thesis(), form);
    const State start = start_at(law, 0.7);
    std::vector<std::array<double, 2>> pieces;
    for (const auto& [v, e] : eventful)
      for (int i = 0; i < 1000; ++i) pieces.push_back({v / 1000, e / 1000});
    const LightLaw light(law, {1e-8, 1e-11});
    State state = start;
    Ends ends;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Status status = light.update(state, pieces[i][0], pieces[i][1]);
      ASSERT_FALSE(status.failed()) << status.message << i;
      if (i % 1000 == 999) ends.states.push_back(state);
    }
    EXPECT_LT(ends.distance(by_cvode(law, start, eventful)), 1e-7) << name_of(form);
  }
}

TEST(Light, SamplesOfALongStretchAreThoseOfCvode) {
  for (const Form form : forms) {
    const Law law = make_law(thesis(), form);
    const LightLaw light(law, {1e-8, 1e-11});
    State state = start_at(law, 0.7);
    MaterialPoint point(law, state, {1e-11, 1e-14});
    std::vector<double> fractions;
    for (int i = 0; i <= 50; ++i) fractions.push_back(i / 50.0);
    for (const auto& [v, e] : eventful) {
      std::vector<State> expected;
      ASSERT_FALSE(
          point.walk(v, e, fractions, [&](std::size_t, const State& s) { expected.push_back(s); }).failed());
      ASSERT_FALSE(light
                       .walk(state, v, e, fractions,
                             [&](std::size_t i, const State& s) {
                               EXPECT_NEAR(s.P, expected.at(i).P, 1e-8);
                               EXPECT_NEAR(s.sigma_dev, expected.at(i).sigma_dev, 1e-8);
                               EXPECT_NEAR(s.F_dev, expected.at(i).F_dev, 1e-7);
                               EXPECT_NEAR(s.nu, expected.at(i).nu, 1e-13);
                             })
                       .failed());
      EXPECT_NEAR(state.P, point.state().P, 1e-8);
    }
  }
}

TEST(Light, ACacheChangesNothing) {
  const LightLaw light(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  State with = start_at(light.law(), 0.7), without = with;
  LightCache cache;
  for (int i = 0; i < 300; ++i) {
    const double v = i % 3 == 0 ? 1e-4 : 0, e = i % 50 < 25 ? 1e-3 : -1e-3;
    ASSERT_FALSE(light.update(with, v, e, &cache).failed());
    ASSERT_FALSE(light.update(without, v, e).failed());
    ASSERT_EQ(with.P, without.P);
    ASSERT_EQ(with.sigma_dev, without.sigma_dev);
  }
}

TEST(Light, ACacheKnowsWhoseItIs) {
  ParameterSet other = thesis();
  other.moduli->p0.value *= 2;
  const LightLaw one(make_law(thesis(), Form::coupled), {1e-8, 1e-11}),
      two(make_law(other, Form::coupled), {1e-8, 1e-11});
  State first = start_at(one.law(), 0.7), second = first, alone = first;
  LightCache shared;
  ASSERT_FALSE(one.update(first, 0, 1e-3).failed());
  ASSERT_FALSE(one.update(first, 0, 1e-3, &shared).failed());
  ASSERT_FALSE(two.update(second, 0, 1e-3).failed());
  ASSERT_FALSE(two.update(second, 0, 1e-3, &shared).failed());
  for (int i = 0; i < 2; ++i) ASSERT_FALSE(two.update(alone, 0, 1e-3).failed());
  EXPECT_EQ(second.sigma_dev, alone.sigma_dev);
}

TEST(Light, DoesNotAllocate) {
  const LightLaw light(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  State state = start_at(light.law(), 0.7);
  Tangent tangent;
  const long before = allocations();
  for (const auto& [v, e] : eventful) {
    State other = state;
    ASSERT_FALSE(light.update(other, v, e, tangent).failed());
    ASSERT_FALSE(light.update(state, v, e).failed());
  }
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(before, 0);  // the counter counts
}

/// Every entry of the tangent of one increment against a central difference of updates at a tight tolerance.
void expect_tangent(const LightLaw& light, const State& start, double v, double e, double step) {
  SCOPED_TRACE("eps_vol " + shown(v) + " eps_dev " + shown(e));
  Tangent tangent;
  State state = start;
  ASSERT_FALSE(light.update(state, v, e, tangent).failed());
  const auto at = [&](double dv, double de) {
    State moved = start;
    EXPECT_FALSE(light.update(moved, v + dv, e + de).failed());
    return moved;
  };
  const double B = 0.5;  // the size of moduli
  for (std::size_t i = 0; i < 2; ++i) {
    const State up = i == 0 ? at(step, 0) : at(0, step), down = i == 0 ? at(-step, 0) : at(0, -step);
    EXPECT_NEAR(tangent.P[i], (up.P - down.P) / (2 * step), 1e-5 * B);
    EXPECT_NEAR(tangent.sigma_dev[i], (up.sigma_dev - down.sigma_dev) / (2 * step), 1e-5 * B);
    EXPECT_NEAR(tangent.F_dev[i], (up.F_dev - down.F_dev) / (2 * step), 1e-4);
  }
}

TEST(Light, TangentIsTheDerivativeOfTheIncrement) {
  for (const Form form : forms) {
    SCOPED_TRACE(name_of(form));
    const LightLaw light(make_law(thesis(), form), {1e-11, 1e-14});
    State state = start_at(light.law(), 0.7);
    ASSERT_FALSE(light.update(state, 0, 0.03).failed());
    for (const auto& [v, e] : std::vector<std::array<double, 2>>{
             {0, 1e-3}, {0, -1e-3}, {0, 0.1}, {1e-3, 1e-3}, {-0.01, 0.02}, {0.05, -0.05}, {0.01, 1e-5}})
      expect_tangent(light, state, v, e, 1e-6);
  }
}

TEST(Light, TangentThroughUnjammingAndJamming) {
  for (const Form form : {Form::reduced, Form::coupled}) {
    SCOPED_TRACE(name_of(form));
    const LightLaw light(make_law(thesis(), form), {1e-11, 1e-14});
    State unjammed = start_at(light.law(), 0.66);
    ASSERT_FALSE(unjammed.jammed);
    expect_tangent(light, unjammed, 0.1, 0.1,
                   1e-6);  // jams at a strain that moves with the increment's direction
    State jammed = start_at(light.law(), 0.7);
    Tangent tangent;
    ASSERT_FALSE(light.update(jammed, -0.1, -0.1, tangent).failed());
    ASSERT_FALSE(jammed.jammed);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(tangent.P[i], 0);
      EXPECT_EQ(tangent.sigma_dev[i], 0);
    }
  }
}

TEST(Light, TangentWhereItIsStiff) {
  ParameterSet set = thesis();
  set.shear->beta_F->Q_max.value = 1e4;
  const LightLaw light(make_law(set, Form::coupled), {1e-10, 1e-13});
  const State start = start_at(light.law(), 0.7);
  expect_tangent(light, start, 0.05, 1, 1e-5);
}

TEST(Light, ElasticTangentIsThatOfTheModuli) {
  const LightLaw light(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  const auto& form = std::get<Coupled>(light.law());
  State state = start_at(light.law(), 0.711);
  const auto c = form.coefficients(0.711);
  Tangent tangent;
  ASSERT_FALSE(light.update(state, 0, 1e-9, tangent).failed());
  EXPECT_NEAR(tangent.P[0], c.B, 1e-6);
  EXPECT_NEAR(tangent.sigma_dev[1], c.B * c.ratio_ini, 1e-6);
  EXPECT_NEAR(tangent.F_dev[1], c.beta_F * c.F_max, 1e-5);
}

TEST(Light, TangentWithoutShearIsElastic) {
  const LightLaw light(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  const auto& form = std::get<Coupled>(light.law());
  State state = start_at(light.law(), 0.711);
  ASSERT_FALSE(light.update(state, 0, 0.02).failed());
  const State before = state;
  Tangent tangent;
  ASSERT_FALSE(light.update(state, 0, 0, tangent).failed());
  const auto c = form.coefficients(0.711);
  const double G = shear_modulus(form.laws.moduli, c.B, c.ratio_ini, state.sigma_dev, state.F_dev);
  EXPECT_NEAR(tangent.P[0], c.B, 1e-14);
  EXPECT_NEAR(tangent.P[1], 0.66 * c.B * state.F_dev, 1e-14);
  EXPECT_NEAR(tangent.sigma_dev[0], c.B * state.F_dev, 1e-14);
  EXPECT_NEAR(tangent.sigma_dev[1], G, 1e-14);
  EXPECT_EQ(state.direction.S_I, before.direction.S_I);  // and the point has not moved
  EXPECT_EQ(state.direction.q, 1);
  ASSERT_FALSE(light.update(state, 1e-9, 0, tangent).failed());
  EXPECT_NEAR(tangent.sigma_dev[1], G, 1e-6);
  EXPECT_EQ(state.direction.q, 0);
}

TEST(Light, FailureLeavesTheStateAlone) {
  ParameterSet set = thesis();
  set.shear->s_max->Q_max.value = -0.05;  // s_max(0.9) < 0
  for (const Form form : forms) {
    const LightLaw light(make_law(set, form), {1e-8, 1e-11});
    State state = start_at(light.law(), 0.7);
    ASSERT_FALSE(light.update(state, 0, 0.01).failed());
    const State before = state;
    for (const auto& [v, e, why] :
         std::vector<std::tuple<double, double, const char*>>{{0.2, 0.2, "s_max is -0.0"},
                                                              {std::nan(""), 0, "must be finite"},
                                                              {0, std::nan(""), "must be finite"},
                                                              {0, INFINITY, "must be finite"},
                                                              {-INFINITY, 1, "must be finite"}}) {
      Tangent tangent;
      for (const Status& status : {light.update(state, v, e), light.update(state, v, e, tangent)}) {
        EXPECT_TRUE(status.failed()) << name_of(form) << v << e;
        EXPECT_THAT(status.message, HasSubstr(why));
      }
      EXPECT_EQ(state.P, before.P);
      EXPECT_EQ(state.nu, before.nu);
      EXPECT_EQ(state.direction.S_I, before.direction.S_I);
    }
    EXPECT_FALSE(light.update(state, 0, 0.01).failed());
  }
}

TEST(Light, ReversalInEveryIncrement) {
  const LightLaw light(make_law(thesis(), Form::coupled), {1e-8, 1e-11});
  State state = start_at(light.law(), 0.711);
  for (int i = 0; i < 100'000; ++i) {
    ASSERT_FALSE(light.update(state, 0, i % 2 == 0 ? 1e-3 : -1e-3).failed());
    ASSERT_LE(std::abs(state.s_dev()), 0.167);
    ASSERT_LE(std::abs(state.F_dev), 0.124);
    ASSERT_GT(state.P, 0);
  }
}

TEST(Light, TinyAndHugeIncrements) {
  for (const Form form : forms) {
    const LightLaw light(make_law(thesis(), form), {1e-8, 1e-11});
    State state = start_at(light.law(), 0.711);
    for (int i = 0; i < 100; ++i) ASSERT_FALSE(light.update(state, 0, 1e-12).failed());
    EXPECT_NEAR(state.eps_dev, 1e-10, 1e-22);
    EXPECT_GT(state.sigma_dev, 0);
    ASSERT_FALSE(light.update(state, 0, 1).failed());
    EXPECT_NEAR(state.s_dev(), 0.16691, 1e-5);
    ASSERT_FALSE(light.update(state, 0, 100).failed());
    EXPECT_NEAR(state.s_dev(), 0.16691, 1e-5);
  }
}

TEST(Light, StiffRelaxation) {
  // beta_F 1e4 and shear right above jamming, where s_dev relaxes at the rate G/(P s_max).
  ParameterSet set = thesis();
  set.shear->beta_F->Q_max.value = 1e4;
  const Law law = make_law(set, Form::coupled);
  const std::vector<std::array<double, 2>> increments{{0.005, 0.1}, {0, 1}, {0, -1}, {0.05, -0.5}, {0, 1e-4}};
  const State start = start_at(law, 0.6648);
  const Ends reference = by_cvode(law, start, increments);
  for (const double rtol : {1e-4, 1e-6, 1e-8})
    EXPECT_LT(by_light(LightLaw(law, {rtol, 1e-3 * rtol}), start, increments).distance(reference), 10 * rtol);
}

TEST(Light, TenThousandCyclesDriftNoFurtherThanTheLawDoes) {
  const Law law = make_law(thesis(), Form::coupled);
  const auto after = [&](double rtol) {
    const LightLaw light(law, {rtol, 1e-3 * rtol});
    State state = start_at(law, 0.711);
    for (int i = 0; i < 10'000; ++i) {
      EXPECT_FALSE(light.update(state, 0, 0.01).failed());
      EXPECT_FALSE(light.update(state, 0, -0.01).failed());
    }
    return state;
  };
  const State coarse = after(1e-6), fine = after(1e-9);
  EXPECT_NEAR(coarse.P, fine.P, 1e-5 * fine.P);
  EXPECT_NEAR(coarse.F_dev, fine.F_dev, 1e-5 * 0.124);
}

TEST(Light, RefusesToleranceThatMeansNothing) {
  const Law law = make_law(thesis(), Form::coupled);
  EXPECT_THAT(refusal([&] { LightLaw(law, {0, 1e-9}); }), HasSubstr("rtol: must be > 0"));
  EXPECT_THAT(refusal([&] { LightLaw(law, {1e-8, NAN}); }), HasSubstr("atol: must be > 0"));
}

}  // namespace
}  // namespace grainlaw::model
