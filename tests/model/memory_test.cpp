// The form with memory: over-compression by Eqs. 5.1 and 5.5, shear by its rate against a closed form and
// Eq. 5.3, shear jamming and loss of contact at reversal, pressure that does not drift, and every integrator
// on all of it.
#include "grainlaw/model/forms/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/start.hpp"
#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double eps_c = 0.0423;

/// m after shear e from isotropy at constant volume: dm/de = [(1 - exp(-beta e))^2 - m]/eps_c.
double remembered(double beta, double e) {
  const double x = std::exp(-e / eps_c), b = beta * eps_c;
  return 1 - x - 2 * (std::exp(-beta * e) - x) / (1 - b) + (std::exp(-2 * beta * e) - x) / (1 - 2 * b);
}

TEST(Memory, CyclesOfOverCompressionFollowEquation5_1) {
  const Memory law = form();
  const auto& over = law.laws.memory.over;
  for (const double phi_max : {0.68, 0.73, 0.82}) {
    State start = isotropic(0.64, over.phi_SJ, 0.64);
    MaterialPoint point = point_at(start);
    for (int M = 1; M <= 20; ++M) {
      ASSERT_FALSE(point.walk(std::log(phi_max / 0.64), 0).failed());
      EXPECT_NEAR(point.state().history.phi_H, jamming_density_after(over, phi_max, M), 1e-6) << M;
      EXPECT_NEAR(point.state().history.phi_max, phi_max, 1e-12);
      ASSERT_FALSE(point.walk(-std::log(phi_max / 0.64), 0).failed());
      EXPECT_FALSE(point.state().jammed);
      EXPECT_NEAR(point.events().back().nu, jamming_density_after(over, phi_max, M), 1e-6) << M;
    }
  }
}

TEST(Memory, OverCompressionMayBeCutIntoPieces) {
  const State start = isotropic(0.64, 0.6567, 0.64);
  const double up = std::log(0.73 / 0.64);
  const auto compress = [&](int pieces) {
    MaterialPoint point = point_at(start);
    for (int cycle = 0; cycle < 3; ++cycle)
      for (const double way : {up, -up})
        for (int i = 0; i < pieces; ++i) EXPECT_FALSE(point.walk(way / pieces, 0).failed());
    return point.state().history.phi_H;
  };
  // ln(phi_max/phi_H) is that of the piece: phi_H moves by 1e-3 of itself within a cycle.
  EXPECT_NEAR(compress(1), compress(100), 2e-5);
}

TEST(Memory, BeyondTheLargestDensityACycleIsAFirstOneAgain) {
  const auto& over = form().laws.memory.over;
  const double five = jamming_density_after(over, 0.70, 5.0);
  History history{five, 0.70, 0.64};
  history = compressed<double, double>(over, history, 0.7001);
  EXPECT_GE(history.phi_H, five);  // what cycles have left is not lost
  history = compressed<double, double>(over, history, 0.82);
  EXPECT_EQ(history.phi_H, jamming_density_after(over, 0.82, 1.0));
  EXPECT_EQ(history.phi_max, 0.82);
  history = compressed<double, double>(over, history, 0.7);
  EXPECT_EQ(history.phi_H, jamming_density_after(over, 0.82, 1.0));
}

/// As one does that starts from a measured pressure: the least compression must not bring it to the mean
/// packing.
TEST(Memory, APackingThatJamsEarlierThanTheMeanOneGoesOnFromThere) {
  const auto& over = form().laws.memory.over;
  const double below = 0.002, mean = jamming_density_after(over, 0.70, 1.0);
  const History start{mean - below, 0.70, 0.70};
  const History least = compressed<double, double>(over, start, 0.70 * (1 + 1e-9));
  EXPECT_NEAR(least.phi_H, start.phi_H, 1e-9);
  const History once = compressed<double, double>(over, start, 0.82);
  EXPECT_NEAR(once.phi_H, jamming_density_after(over, 0.82, 1.0) - below, 1e-15);
  History pieces = start;
  for (int i = 1; i <= 12; ++i) pieces = compressed<double, double>(over, pieces, 0.70 + 0.01 * i);
  EXPECT_NEAR(pieces.phi_H, once.phi_H, 1e-14);
}

TEST(Memory, CompressionBelowTheShearJammingDensityLeavesNone) {
  const auto& over = form().laws.memory.over;
  History history{over.phi_SJ, 0.64, 0.64};
  history = compressed<double, double>(over, history, 0.656);
  EXPECT_EQ(history.phi_H, over.phi_SJ);
  history = compressed<double, double>(over, history, over.phi_SJ);
  EXPECT_EQ(history.phi_H, over.phi_SJ);
  history = compressed<double, double>(over, history, 0.99);
  EXPECT_EQ(history.phi_H, jamming_density_after(over, 0.99, 1.0));
}

TEST(Memory, ShearTakesTheJammingDensityByItsClosedForm) {
  const Memory law = form();
  const double nu = 0.711, beta = saturation(law.laws.beta_F, nu);
  MaterialPoint point = point_at(isotropic(nu, 0.6649));
  for (int i = 1; i <= 40; ++i) {
    ASSERT_FALSE(point.walk(0, 0.01).failed());
    const double m = remembered(beta, 0.01 * i);
    EXPECT_NEAR(point.state().memory, m, 1e-9);
    EXPECT_NEAR(point.state().phi_J, 0.6649 + m * (0.6581 - 0.6649), 1e-11);
    EXPECT_NEAR(point.state().P, law.pressure_of(nu, 0.6649, m), 1e-10);
  }
}

TEST(Memory, SteadyShearHasThePressureOfItsRowWhateverWasBefore) {
  const Memory law = form();
  for (const double phi_J : {0.6600, 0.6649, 0.6690}) {
    MaterialPoint point = point_at(isotropic(0.711, phi_J));
    ASSERT_FALSE(point.walk(0, 2).failed());
    EXPECT_NEAR(point.state().P, pressure(law.laws.shear_pressure, 0.711), 1e-9);
    EXPECT_NEAR(point.state().s_dev(), saturation(law.laws.s_max, 0.711), 1e-6);
  }
}

TEST(Memory, PressureRisesBelowADensityAndFallsAboveIt) {
  // Dilatancy and compactancy: steady shear over the start (Fig. 4.2).
  const auto change = [](double nu) {
    MaterialPoint point = point_at(isotropic(nu, 0.6649));
    const double before = point.state().P;
    EXPECT_FALSE(point.walk(0, 1).failed());
    return point.state().P / before - 1;
  };
  EXPECT_GT(change(0.685), 0.1);
  EXPECT_GT(change(0.711), 0.03);
  EXPECT_LT(change(0.82), 0);
}

TEST(Memory, ManyCyclesDoNotPumpPressure) {
  MaterialPoint point = point_at(isotropic(0.711, 0.6649), {1e-8, 1e-11});
  std::vector<double> ends;
  for (int i = 0; i < 400; ++i) {
    ASSERT_FALSE(point.walk(0, i % 2 == 0 ? 0.1 : -0.1).failed());
    if (i % 2 == 1) ends.push_back(point.state().P);
  }
  EXPECT_NEAR(ends.back(), ends[20], 1e-7 * ends[20]);
  MaterialPoint without(make_law(with_memory(), Form::coupled), isotropic(0.711, 0.6649), {1e-8, 1e-11});
  for (int i = 0; i < 400; ++i) ASSERT_FALSE(without.walk(0, i % 2 == 0 ? 0.1 : -0.1).failed());
  EXPECT_GT(std::abs(without.state().P / ends[20] - 1), 0.1);  // Eq. 4.16 by itself does
}

TEST(Memory, ShearJamsBetweenBothDensitiesAndReversalUnjams) {
  const Memory law = form();
  const double nu = 0.6610, phi_H = 0.6649, phi_s = law.laws.shear_pressure.nu_c;
  MaterialPoint point = point_at(isotropic(nu, phi_H));
  ASSERT_FALSE(point.state().jammed);
  ASSERT_FALSE(point.walk(0, 0.3).failed());
  ASSERT_TRUE(point.state().jammed);
  EXPECT_GT(point.state().P, 1e-4);
  EXPECT_GT(point.state().s_dev(), 0.05);
  // Where it jams: m = (phi_H - nu)/(phi_H - phi_s), by the closed form.
  ASSERT_EQ(point.events().size(), 1U);
  const double e = point.events()[0].eps_dev, beta = saturation(law.laws.beta_F, nu);
  EXPECT_NEAR(remembered(beta, e), (phi_H - nu) / (phi_H - phi_s), 1e-4);
  ASSERT_FALSE(point.walk(0, -0.06).failed());
  EXPECT_FALSE(point.state().jammed);
  ASSERT_FALSE(point.walk(0, -0.3).failed());
  EXPECT_TRUE(point.state().jammed);
  EXPECT_LT(point.state().s_dev(), -0.05);
  EXPECT_EQ(point.events().size(), 3U);
}

TEST(Memory, BelowTheDensityOfSteadyShearNothingJams) {
  const double phi_s = form().laws.shear_pressure.nu_c;
  for (const double nu : {0.65, phi_s}) {
    MaterialPoint point = point_at(isotropic(nu, 0.6649));
    for (const double e : {0.1, -0.2, 1.0, 100.0}) {
      ASSERT_FALSE(point.walk(0, e).failed());
      EXPECT_FALSE(point.state().jammed);
      EXPECT_EQ(point.state().P, 0);
    }
  }
}

TEST(Memory, ShearNeverUnjamsAPackingThatJamsBelowSteadyShear) {
  // Over-compression to 0.66 leaves phi_H between phi_SJ and phi_s.
  const double phi_H = 0.6570, nu = 0.6575;
  ASSERT_LT(nu, form().laws.shear_pressure.nu_c);
  MaterialPoint point = point_at(isotropic(nu, phi_H));
  ASSERT_TRUE(point.state().jammed);
  for (const double e : {0.3, -0.3, 0.05, -0.05}) {
    ASSERT_FALSE(point.walk(0, e).failed());
    EXPECT_TRUE(point.state().jammed);
    EXPECT_EQ(point.state().phi_J, phi_H);
  }
}

TEST(Memory, VolumeMovesFromAnyDensityOnTheLightPath) {
  const Law law = make_law(with_memory(), Form::memory);
  const LightLaw light(law, {1e-8, 1e-11});
  const double phi_s = form().laws.shear_pressure.nu_c;
  for (const double nu : {phi_s, phi_s * (1 + 1e-12), phi_s * (1 - 1e-12)})
    for (const double v : {1e-3, -1e-3, 1e-6, 1e-300}) {
      State state = isotropic(nu, 0.6649);
      const Status status = light.update(state, v, 0.01);
      EXPECT_FALSE(status.failed()) << nu << " " << v << status.message;
    }
}

TEST(Memory, StatesThatAreNoneAreRefused) {
  const LightLaw light(make_law(with_memory(), Form::memory), {1e-8, 1e-11});
  const State good = isotropic(0.7, 0.6649);
  for (const double wrong : {std::nan(""), -0.1, 1.1}) {
    State state = good;
    state.memory = wrong;
    EXPECT_TRUE(light.update(state, 0, 0.01).failed());
    EXPECT_TRUE(light.update(state, 0, 0).failed());
  }
  MaterialPoint point = point_at(good);
  EXPECT_TRUE(point.walk(1e3, 0).failed());
  EXPECT_TRUE(point.walk(0, 1e300).failed());
  EXPECT_EQ(point.state().nu, good.nu);
}

TEST(Memory, AFirstCompressionMayBeginAtTheLowestDensity) {
  const auto& over = form().laws.memory.over;
  const History h = compressed<double, double>(over, {over.phi_SJ, 0.73, 0.64}, 0.73);
  EXPECT_NEAR(h.phi_H, jamming_density_after(over, 0.73, 1.0), 1e-12);
}

TEST(Memory, ExactlyAtTheJammingDensity) {
  for (const double nu : {0.6649 * (1 - 1e-12), 0.6649, 0.6649 * (1 + 1e-12)}) {
    MaterialPoint point = point_at(isotropic(nu, 0.6649));
    EXPECT_FALSE(point.state().jammed);
    ASSERT_FALSE(point.walk(0.01, 0.01).failed());
    EXPECT_TRUE(point.state().jammed);
    ASSERT_FALSE(point.walk(-0.03, 0).failed());
    EXPECT_FALSE(point.state().jammed);
  }
}

/// Everything at once: over-compression, shear jamming, loss of contact at reversal, decompression under
/// shear.
const std::vector<std::array<double, 2>> eventful{
    {0.05, 0},    {0.15, 0.1}, {-0.2, 0.05}, {0, 0.4}, {0, -0.05}, {0, -0.4},  {0.06, 0.1}, {0, -0.2},
    {-0.1, -0.1}, {0.03, 0},   {0, 0.3},     {0, 0},   {0, -0.3},  {0.2, 0.2}, {-0.25, 0},  {0.05, 0.5}};

TEST(Memory, LightPathAgreesWithCvodeThroughEverything) {
  const Law law = make_law(with_memory(), Form::memory);
  const State start = isotropic(0.64, 0.6567, 0.64);
  MaterialPoint point(law, start, {1e-11, 1e-14});
  std::vector<State> reference;
  for (const auto& [v, e] : eventful) {
    const Status status = point.walk(v, e);
    ASSERT_FALSE(status.failed()) << status.message;
    reference.push_back(point.state());
  }
  EXPECT_GT(point.events().size(), 5U);
  for (const double rtol : {1e-4, 1e-6, 1e-8}) {
    const LightLaw light(law, {rtol, 1e-3 * rtol});
    State state = start;
    for (std::size_t i = 0; i < eventful.size(); ++i) {
      const Status status = light.update(state, eventful[i][0], eventful[i][1]);
      ASSERT_FALSE(status.failed()) << status.message;
      EXPECT_EQ(state.jammed, reference[i].jammed) << i;
      EXPECT_NEAR(state.P, reference[i].P, 10 * rtol * 0.02) << i;
      EXPECT_NEAR(state.sigma_dev, reference[i].sigma_dev, 10 * rtol * 0.004) << i;
      EXPECT_NEAR(state.F_dev, reference[i].F_dev, 10 * rtol * 0.12) << i;
      EXPECT_NEAR(state.memory, reference[i].memory, 10 * rtol) << i;
    }
  }
}

/// What an integration leaves is admitted again: loose steps may take m past 1 by their error.
TEST(Memory, AdmitsItsOwnStatesAtALooseTolerance) {
  const Law law = make_law(with_memory(), Form::memory);
  for (const LightMethod method : {LightMethod::automatic, LightMethod::explicit_third})
    for (const double rtol : {1e-3, 1e-4}) {
      const LightLaw light(law, {rtol, 1e-3 * rtol}, method);
      State state = isotropic(0.64, 0.6567, 0.64);
      for (const auto& [v, e] : eventful)
        for (int i = 0; i < 10; ++i) {
          const Status status = light.update(state, v / 10, e / 10);
          ASSERT_FALSE(status.failed()) << status.message;
        }
      EXPECT_NEAR(state.memory, std::clamp(state.memory, 0.0, 1.0), 10 * rtol);
      state.memory = 1.5;
      EXPECT_TRUE(light.update(state, 0, 1e-3).failed());
    }
}

TEST(Memory, TangentThroughShearJamming) {
  const LightLaw light(make_law(with_memory(), Form::memory), {1e-11, 1e-14});
  for (const State& start : {isotropic(0.6610, 0.6649), isotropic(0.70, 0.6649)})
    for (const auto& [v, e] : std::vector<std::array<double, 2>>{{0, 0.25}, {0.005, 0.2}, {0.01, 0.01}}) {
      SCOPED_TRACE(shown(start.nu) + " " + shown(v));
      Tangent tangent;
      State end = start;
      ASSERT_FALSE(light.update(end, v, e, tangent).failed());
      ASSERT_TRUE(end.jammed);
      const auto at = [&](double dv, double de) {
        State moved = start;
        EXPECT_FALSE(light.update(moved, v + dv, e + de).failed());
        return moved;
      };
      const double step = 1e-6;
      const State e_up = at(0, step), e_down = at(0, -step), v_up = at(step, 0), v_down = at(-step, 0);
      const State& v_from =
          v == 0 ? end : v_up;  // compression is remembered, decompression is not: a kink at rest
      const double v_step = v == 0 ? step : 2 * step;
      EXPECT_NEAR(tangent.P[0], (v_from.P - v_down.P) / v_step, 1e-5);
      EXPECT_NEAR(tangent.P[1], (e_up.P - e_down.P) / (2 * step), 1e-5);
      EXPECT_NEAR(tangent.sigma_dev[0], (v_from.sigma_dev - v_down.sigma_dev) / v_step, 1e-5);
      EXPECT_NEAR(tangent.sigma_dev[1], (e_up.sigma_dev - e_down.sigma_dev) / (2 * step), 1e-5);
    }
}

/// What is said of P that drifts is true of Eq. 4.16 alone.
TEST(Memory, ThatPDriftsIsNotSaidOfIt) {
  const Path cycles = path_of(R"({"start": {"nu": 0.69}, "segments": [{"repeat": 3, "segments": [
      {"mode": "d2", "amount": 0.05}, {"mode": "d2", "amount": -0.05}]}]})");
  PredictOptions options;
  EXPECT_THAT(predict(with_memory(), cycles, options).warnings, Contains(HasSubstr("restoring term")));
  options.form = Form::memory;
  EXPECT_THAT(predict(with_memory(), cycles, options).warnings, Not(Contains(HasSubstr("restoring term"))));
}

TEST(Memory, AHoldOfNothingIsNone) {
  const Path cycle = path_of(R"({"start": {"nu": 0.69}, "segments": [
      {"mode": "d2", "amount": 0.3}, {"mode": "d2", "amount": -0.3}]})");
  ParameterSet set = with_memory();
  const auto run = [&](const ParameterSet& with) {
    PredictOptions options;
    options.form = Form::memory;
    return predict(with, cycle, options).record;
  };
  const Record without = run(set);
  set.memory->hold.emplace().value = 0.4;
  EXPECT_NE(run(set)["F_dev"].back(), without["F_dev"].back());
  set.memory->hold->value = 0;
  const auto read = ParameterSet::read(Reader(set.to_json(), "written"));
  const Record nothing = run(read);
  for (const char* column : {"P", "sigma_dev", "F_dev"})
    for (std::size_t row = 0; row < nothing.rows(); ++row)
      EXPECT_EQ(nothing[column][row], without[column][row]) << column << ' ' << row;
}

TEST(Memory, StartsFromPressureOrJammingDensityOrCompression) {
  const ParameterSet set = with_memory();
  const auto start = [&](const std::string& text) {
    return start_of(set,
                    path_of(R"({"start": )" + text + R"(, "segments": [{"mode": "d2", "amount": 0.1}]})"),
                    Form::memory);
  };
  EXPECT_EQ(start(R"({"nu": 0.7, "phi_J": 0.664})").state.history.phi_H, 0.664);
  EXPECT_EQ(start(R"({"nu": 0.66})").state.history.phi_H, form().laws.pressure.nu_c);
  const auto fresh = start(R"({"nu": 0.64})").state;  // nothing has compressed it yet
  EXPECT_EQ(fresh.history.phi_H, form().laws.memory.over.phi_SJ);
  EXPECT_LE(fresh.history.phi_max, form().laws.memory.over.phi_SJ);
  const auto pressed = start(R"({"nu": 0.7, "P": 0.017})").state;
  EXPECT_NEAR(form().pressure_of(0.7, pressed.history.phi_H, 0.0), 0.017, 1e-12);
  EXPECT_EQ(pressed.P, 0.017);
  const auto compressed = start(R"({"nu": 0.7, "phi_max": 0.75})").state;
  EXPECT_EQ(compressed.history.phi_H, jamming_density_after(form().laws.memory.over, 0.75, 1.0));
  EXPECT_EQ(compressed.history.phi_max, 0.75);
  EXPECT_THAT(refusal([&] { start(R"({"nu": 0.7, "P": 0.017, "phi_J": 0.664})"); }),
              HasSubstr("phi_J: redundant"));
  EXPECT_THAT(refusal([] { make_law(thesis(), Form::memory); }),
              AllOf(HasSubstr("memory.eps_c: is missing"), HasSubstr("calibrate write it"),
                    HasSubstr("--form minimal does without")));
}

}  // namespace
}  // namespace grainlaw::model
