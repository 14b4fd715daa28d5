// The form with memory: shear by Eq. 5.3 from isotropy, steady shear's pressure, shear jamming and loss of
// contact at reversal, pressure that does not drift, and every integrator on all of it.
#include "grainlaw/model/forms/memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "grainlaw/model/predict.hpp"
#include "grainlaw/model/start.hpp"
#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Of the thesis.
constexpr double alpha = 1.37, eps0 = 0.102;

/// Eq. 5.3: m after shear e from isotropy at constant volume.
double remembered_after(double e) { return -std::expm1(-std::pow(e / eps0, alpha)); }
/// The strain after which it is m.
double strain_to(double m) { return eps0 * std::pow(-std::log(1 - m), 1 / alpha); }

TEST(Memory, FirstLoadingFollowsEquation5_3InEveryIntegrator) {
  for (const WalkedBy integrator : integrators)
    for (const double nu : {0.66, 0.685, 0.711, 0.82})
      for (const double q : {1.0, -1.0}) {
        SCOPED_TRACE(std::string(name_of(integrator)) + " at " + to_text(nu));
        State state = isotropic(nu);
        ASSERT_EQ(memory_in(state), 0);
        double e = 0;
        for (const double step : {1e-6, 1e-4, 1e-3, 0.01, 0.03, 0.05, 0.1, 0.2, 0.5}) {
          ASSERT_FALSE(walk_by(integrator, state, 0, q * step).failed());
          e += step;
          const double m = remembered_after(e);
          EXPECT_NEAR(memory_in(state), m, 1e-7 * m) << e;
          EXPECT_NEAR(state.phi_J, 0.6649 + m * (form().steady_density(nu) - 0.6649), 1e-10);
          EXPECT_EQ(q > 0 ? state.shear.minus : state.shear.plus, 0);
          EXPECT_EQ(state.shear.packed, 0) << "nothing has been given back yet";
          EXPECT_EQ(state.shear.steady, form().steady_density(nu));
          EXPECT_NEAR(state.P, state.jammed ? form().pressure_of(nu, state.phi_J) : 0, 1e-15);
        }
      }
}

TEST(Memory, FirstLoadingAsThePressureHasIt) {
  // alpha_P and eps0_P stand before alpha and eps0, which the strains to jam have.
  ParameterSet set = thesis_with_memory();
  set.memory->alpha_P.emplace().value = 1.7026;
  set.memory->eps0_P.emplace().value = 0.0785;
  const Law law = make_law(set, Form::memory);
  State state = isotropic(0.711);
  ASSERT_FALSE(walk_by(WalkedBy::light, state, 0, 0.05, {1e-10, 1e-13}, law).failed());
  EXPECT_NEAR(std::get<Memory>(law).memory(state.shear), -std::expm1(-std::pow(0.05 / 0.0785, 1.7026)), 1e-9);
}

TEST(Memory, TheSteadyDensityHasThePressureOfSteadyShear) {
  for (int i = 0; i <= 160; ++i) {
    const double nu = 0.66 + 0.001 * i, phi_ss = form().steady_density(nu);
    const double P = pressure(form().laws.shear_pressure, nu);
    EXPECT_NEAR(form().pressure_of(nu, phi_ss), P, 1e-10 * P) << nu;
    EXPECT_LT(phi_ss, nu);
  }
  const double phi_s = form().laws.shear_pressure.nu_c;
  for (const double nu : {0.6, std::nextafter(phi_s, 0.0), phi_s})
    EXPECT_EQ(form().steady_density(nu), phi_s);
  for (const double above : {1e-15, 1e-12, 1e-9, 1e-6, 1e-4})  // it leaves phi_s without a jump
    EXPECT_NEAR(form().steady_density(phi_s * (1 + above)), phi_s, 2 * above + 1e-15) << above;
  const Dual<1> slope = form().steady_density(Dual<1>(0.711, 0));
  EXPECT_NEAR(slope.slope[0],
              (form().steady_density(0.711 + 1e-6) - form().steady_density(0.711 - 1e-6)) / 2e-6, 1e-7);
}

TEST(Memory, SteadyShearHasThePressureOfItsRowWhateverWasBefore) {
  for (const WalkedBy integrator : integrators)
    for (const double nu : {0.66, 0.67, 0.711, 0.77, 0.82})
      for (const double phi_J : {0.6600, 0.6649, 0.6690}) {
        State state = isotropic(nu, phi_J);
        ASSERT_FALSE(walk_by(integrator, state, 0, 3, {1e-11, 1e-14}).failed());
        const double P = pressure(form().laws.shear_pressure, nu);
        EXPECT_NEAR(state.P, P, 1e-10 + 1e-8 * P) << name_of(integrator) << nu << ' ' << phi_J;
        EXPECT_NEAR(state.s_dev(), saturation(form().laws.s_max, nu), 1e-6);
      }
}

TEST(Memory, SteadyShearAtAnotherDensityFindsItsPressureToo) {
  // phi_t follows phi_ss(nu), also where the volume has moved since.
  State state = isotropic(0.69);
  for (const auto& [v, e] : {std::pair{0.0, 1.0}, {0.04, 0.02}, {0.0, 2.0}, {-0.03, 0.0}, {0.0, -2.0}}) {
    ASSERT_FALSE(walk_by(WalkedBy::bdf, state, v, e, {1e-11, 1e-14}).failed());
    if (v != 0) continue;
    EXPECT_NEAR(state.P, pressure(form().laws.shear_pressure, state.nu), 1e-7) << state.nu;
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
  // What packs goes on as the inverse of the number of cycles, and P with it.
  EXPECT_NEAR(ends.back(), ends[20], 1e-3 * ends[20]);
  EXPECT_NEAR(ends.back(), ends[150], 5e-5 * ends[150]);
  MaterialPoint without(make_law(thesis_with_memory(), Form::coupled), isotropic(0.711, 0.6649),
                        {1e-8, 1e-11});
  for (int i = 0; i < 400; ++i) ASSERT_FALSE(without.walk(0, i % 2 == 0 ? 0.1 : -0.1).failed());
  EXPECT_GT(std::abs(without.state().P / ends[20] - 1), 0.1);  // Eq. 4.16 by itself does
}

TEST(Memory, ShearJamsBetweenBothDensitiesAndReversalUnjams) {
  const double nu = 0.6610, phi_H = 0.6649;
  MaterialPoint point = point_at(isotropic(nu, phi_H));
  ASSERT_FALSE(point.state().jammed);
  ASSERT_FALSE(point.walk(0, 0.3).failed());
  ASSERT_TRUE(point.state().jammed);
  EXPECT_GT(point.state().P, 1e-4);
  EXPECT_GT(point.state().s_dev(), 0.05);
  // Where it jams: m = (phi_H - nu)/(phi_H - phi_ss), by Eq. 5.3.
  ASSERT_EQ(point.events().size(), 1U);
  EXPECT_NEAR(point.events()[0].eps_dev, strain_to((phi_H - nu) / (phi_H - form().steady_density(nu))), 1e-5);
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

TEST(Memory, APackingThatJamsBelowSteadyShearIsUnjammedByIt) {
  // Over-compression to 0.66 leaves phi_H between phi_SJ and phi_s: it gives way to phi_s.
  const double phi_H = 0.6570, nu = 0.6575, phi_s = form().laws.shear_pressure.nu_c;
  ASSERT_LT(nu, phi_s);
  MaterialPoint point = point_at(isotropic(nu, phi_H));
  ASSERT_TRUE(point.state().jammed);
  ASSERT_FALSE(point.walk(0, 3).failed());
  EXPECT_FALSE(point.state().jammed);
  ASSERT_EQ(point.events().size(), 1U);
  EXPECT_NEAR(point.events()[0].eps_dev, strain_to((nu - phi_H) / (phi_s - phi_H)), 1e-4);
  EXPECT_NEAR(point.state().phi_J, phi_s, 1e-9);
}

TEST(Memory, VolumeMovesFromAnyDensityOnTheLightPath) {
  const Law law = memory_law();
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
  const LightLaw light(memory_law(), {1e-8, 1e-11});
  const State good = isotropic(0.7, 0.6649);
  for (const double wrong : {std::nan(""), -0.1, 1.1}) {
    for (double ShearHistory::*member : {&ShearHistory::plus, &ShearHistory::minus, &ShearHistory::packed}) {
      State state = good;
      state.shear.*member = wrong;
      EXPECT_TRUE(light.update(state, 0, 0.01).failed());
      EXPECT_TRUE(light.update(state, 0, 0).failed());
    }
  }
  State state = good;
  state.shear.steady = std::nan("");
  EXPECT_TRUE(light.update(state, 0, 0.01).failed());
  MaterialPoint point = point_at(good);
  EXPECT_TRUE(point.walk(1e3, 0).failed());
  EXPECT_TRUE(point.walk(0, 1e300).failed());
  EXPECT_EQ(point.state().nu, good.nu);
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
  const Law law = memory_law();
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
      EXPECT_NEAR(state.shear.plus, reference[i].shear.plus, 10 * rtol) << i;
      EXPECT_NEAR(state.shear.minus, reference[i].shear.minus, 10 * rtol) << i;
      EXPECT_NEAR(state.shear.packed, reference[i].shear.packed, 10 * rtol) << i;
      EXPECT_NEAR(state.phi_J, reference[i].phi_J, 10 * rtol * 0.01) << i;
    }
  }
}

/// What an integration leaves is admitted again: loose steps may take u past its ends by their error.
TEST(Memory, AdmitsItsOwnStatesAtALooseTolerance) {
  const Law law = memory_law();
  for (const LightMethod method : {LightMethod::automatic, LightMethod::explicit_third})
    for (const double rtol : {1e-3, 1e-4}) {
      const LightLaw light(law, {rtol, 1e-3 * rtol}, method);
      State state = isotropic(0.64, 0.6567, 0.64);
      for (const auto& [v, e] : eventful)
        for (int i = 0; i < 10; ++i) {
          const Status status = light.update(state, v / 10, e / 10);
          ASSERT_FALSE(status.failed()) << status.message;
        }
      for (const double u : {state.shear.plus, state.shear.minus, state.shear.packed})
        EXPECT_NEAR(u, std::clamp(u, 0.0, 1.0), 10 * rtol);
      state.shear.plus = 1.5;
      EXPECT_TRUE(light.update(state, 0, 1e-3).failed());
    }
}

TEST(Memory, TangentThroughShearJamming) {
  const LightLaw light(memory_law(), {1e-11, 1e-14});
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
  EXPECT_THAT(predict(thesis_with_memory(), cycles, options).warnings, Contains(HasSubstr("restoring term")));
  options.form = Form::memory;
  EXPECT_THAT(predict(thesis_with_memory(), cycles, options).warnings,
              Not(Contains(HasSubstr("restoring term"))));
}

TEST(Memory, AHoldAndAPackingOfNothingAreNone) {
  const Path cycle = path_of(R"({"start": {"nu": 0.69, "phi_J": 0.662}, "segments": [
      {"mode": "d2", "amount": 0.3}, {"mode": "d2", "amount": -0.3}]})");
  const auto run = [&](const ParameterSet& with) {
    PredictOptions options;
    options.form = Form::memory;
    return predict(ParameterSet::read(Reader(with.to_json(), "written")), cycle, options).record;
  };
  const auto expect_same = [](const Record& a, const Record& b) {
    for (const char* column : {"P", "sigma_dev", "F_dev"})
      for (std::size_t row = 0; row < a.rows(); ++row)
        EXPECT_EQ(a[column][row], b[column][row]) << column << ' ' << row;
  };
  const ParameterSet full = thesis_with_memory();
  const Record with_all = run(full);
  ParameterSet set = full;
  set.memory->hold.reset();
  const Record no_hold = run(set);
  EXPECT_NE(no_hold["F_dev"].back(), with_all["F_dev"].back());
  set.memory->hold.emplace().value = 0;
  expect_same(run(set), no_hold);
  set = full;
  set.memory->pack_rate.reset();
  set.memory->phi_pack.reset();
  const Record no_packing = run(set);
  EXPECT_NE(no_packing["P"].back(), with_all["P"].back());
  set.memory->phi_pack.emplace().value = 0.668;
  EXPECT_THAT(refusal([&] { make_law(set, Form::memory); }), HasSubstr("memory.pack_rate: is missing"));
  set.memory->pack_rate.emplace().value = 0;
  expect_same(run(set), no_packing);
  set.memory->pack_rate->value = 2;
  set.memory->phi_pack.reset();
  EXPECT_THAT(refusal([&] { make_law(set, Form::memory); }), HasSubstr("memory.phi_pack: is missing"));
}

/// A packing denser than phi_pack has nothing to pack to.
TEST(Memory, NothingPacksBeyondItsDensity) {
  MaterialPoint point = point_at(isotropic(0.70, 0.6690));
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(point.walk(0, i % 2 == 0 ? 0.08 : -0.08).failed());
  EXPECT_EQ(form().packed_density(point.state()), 0.6690);
}

TEST(Memory, StartsFromPressureOrJammingDensityOrCompression) {
  const ParameterSet set = thesis_with_memory();
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
  EXPECT_NEAR(form().pressure_of(0.7, pressed.history.phi_H), 0.017, 1e-12);
  EXPECT_EQ(pressed.P, 0.017);
  const auto compressed = start(R"({"nu": 0.7, "phi_max": 0.75})").state;
  EXPECT_EQ(compressed.history.phi_H, jamming_density_after(form().laws.memory.over, 0.75, 1.0));
  EXPECT_EQ(compressed.history.phi_max, 0.75);
  EXPECT_THAT(refusal([&] { start(R"({"nu": 0.7, "P": 0.017, "phi_J": 0.664})"); }),
              HasSubstr("phi_J: redundant"));
  EXPECT_THAT(refusal([] { make_law(thesis(), Form::memory); }),
              AllOf(HasSubstr("memory.eps_r: is missing"), HasSubstr("calibrate write it"),
                    HasSubstr("--form minimal does without")));
}

/// Increments that go on in a direction take what the last one knew; what it is of is looked at.
TEST(Memory, ACacheChangesNothingOnTheLightPath) {
  const LightLaw light(memory_law(), {1e-8, 1e-11});
  State with = isotropic(0.68), without = with, other = isotropic(0.7);
  LightCache cache;
  for (int i = 0; i < 300; ++i) {
    const double v = i % 3 == 0 ? 1e-4 : 0, e = i % 50 < 25 ? 1e-3 : -1e-3;
    ASSERT_FALSE(light.update(with, v, e, &cache).failed());
    ASSERT_FALSE(light.update(without, v, e).failed());
    if (i % 20 == 0) {
      ASSERT_FALSE(light.update(other, v, e, &cache).failed());
    }
    ASSERT_NEAR(with.P, without.P, 1e-13);
    ASSERT_NEAR(with.sigma_dev, without.sigma_dev, 1e-13);
    ASSERT_NEAR(with.phi_J, without.phi_J, 1e-13);
    ASSERT_NEAR(with.history.phi_H, without.history.phi_H, 1e-13);
  }
}

/// The density of the steady state is what the pressure of its row asks for, from whatever it is looked for.
TEST(Memory, TheDensityOfTheSteadyStateHasItsPressure) {
  const double phi_s = form().laws.shear_pressure.nu_c;
  for (const double above : {1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.05, 0.16, 0.3}) {
    const double nu = phi_s + above, phi = form().steady_density(nu);
    EXPECT_NEAR(form().pressure_of(nu, phi) / pressure(form().laws.shear_pressure, nu), 1,
                1e-13 + 1e-15 / above);
    for (const double at : {phi_s + above / 2, phi_s + 2 * above, 0.8})
      EXPECT_NEAR(form().steady_density(nu, at, form().steady_density(at)), phi, 4e-16);
  }
}

}  // namespace
}  // namespace grainlaw::model
