// Hard cases with a stated outcome: volume fractions around jamming, many cycles, stiff laws, numbers that
// are none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/start.hpp"
#include "grainlaw/model/walk/point.hpp"
#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;

constexpr Form forms[] = {Form::reduced_closed, Form::reduced, Form::coupled, Form::memory,
                          Form::coupled_3_14};
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

MaterialPoint point_at(double nu, Form form, const ParameterSet& set = thesis_with_memory(),
                       Tolerance tolerance = {1e-10, 1e-13}, Method method = Method::bdf) {
  Path path;
  path.start.nu = nu;
  const StartState start = start_of(set, path, {form, {}});
  return MaterialPoint(start.law, start.state, tolerance, method);
}

void expect_sound(const State& state) {
  for (const double x : {state.nu, state.P, state.sigma_dev, state.F_dev, state.phi_J})
    EXPECT_TRUE(std::isfinite(x));
  EXPECT_GE(state.P, 0);
  EXPECT_EQ(state.jammed, state.P > 0);
}

TEST(HardCases, VolumeFractionAtAndAroundJamming) {
  const double phi_J = thesis().isotropic.at("iso").nu_c.value;
  for (const Form form : forms)
    for (const double nu : {phi_J, std::nextafter(phi_J, 0), std::nextafter(phi_J, 1), phi_J * (1 - 1e-12),
                            phi_J * (1 + 1e-12), phi_J * (1 + 1e-9), phi_J * (1 + 1e-6)}) {
      SCOPED_TRACE(name_of(form) + " at nu - phi_J = " + to_text(nu - phi_J));
      MaterialPoint point = point_at(nu, form);
      expect_sound(point.state());
      EXPECT_TRUE(nu > phi_J || !point.state().jammed);
      // Shear alone, a breath of volume either way, and well into both sides.
      for (const double eps_vol : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 0.02, -0.03, 0.05}) {
        const Status status = point.walk(eps_vol, 1e-3);
        ASSERT_FALSE(status.failed()) << status.message << " at eps_vol " << eps_vol;
        expect_sound(point.state());
      }
      EXPECT_TRUE(point.state().jammed);
      EXPECT_NEAR(point.state().nu, nu * std::exp(0.04), 1e-12);
      // From the same density well above, P is the same whatever happened around jamming: in the reduced
      // forms exactly, in the coupled ones up to what was carried and lost there.
      if (form == Form::reduced || form == Form::reduced_closed) {
        EXPECT_NEAR(point.state().P, point_at(point.state().nu, form).state().P, 1e-10);
      }
    }
}

TEST(HardCases, TenThousandCyclesDriftNoFurtherThanTheLawDoes) {
  // The one-cycle map of Eq. 4.16 itself moves P* in each of the cycles; two tolerances see the same map.
  const auto after = [&](double rtol) {
    std::vector<State> states;
    MaterialPoint point = point_at(0.711, Form::coupled, thesis(), {rtol, 1e-3 * rtol});
    for (int i = 0; i < 10'000; ++i) {
      EXPECT_FALSE(point.walk(0, 0.01).failed());
      EXPECT_FALSE(point.walk(0, -0.01).failed());
      if (i % 1000 == 999) states.push_back(point.state());
    }
    return states;
  };
  const double before = point_at(0.711, Form::coupled).state().P;
  const auto coarse = after(1e-6), fine = after(1e-9);
  EXPECT_GT(std::abs(fine.back().P / before - 1), 0.1);  // by the law: it loses P at this amplitude
  for (std::size_t i = 0; i < fine.size(); ++i) {
    // The tolerance is that of one cycle; what the integrator adds is besides small against what the law
    // does.
    const double drift = std::abs(coarse[i].P / fine[i].P - 1);
    EXPECT_LT(drift, 0.1 * 1e-6 * 1000 * static_cast<double>(i + 1)) << i;
    EXPECT_LT(drift, 3e-3 * std::abs(fine[i].P / before - 1)) << i;
    EXPECT_NEAR(coarse[i].F_dev, fine[i].F_dev, 1e-5 * 0.124);
  }
}

TEST(HardCases, StiffRates) {
  // Beta up to 1e4: F_dev is at saturation after 1e-3 of strain, and follows it under volume strain.
  for (const double beta : {1e3, 1e4})
    for (const Form form : forms) {
      SCOPED_TRACE(name_of(form) + " with beta " + to_text(beta));
      ParameterSet set = thesis_with_memory();
      for (auto* law : {&*set.shear->beta_s, &*set.shear->beta_F}) {
        law->Q_max.value = beta;
        law->Q_v.value = 0;
      }
      MaterialPoint point = point_at(0.711, form, set, {1e-8, 1e-11});
      ASSERT_FALSE(point.walk(0, 0.02).failed());
      const Laws& laws = laws_of(point.law());
      EXPECT_NEAR(point.state().F_dev, saturation(laws.F_max, 0.711), 1e-7);
      ASSERT_FALSE(point.walk(0, -0.04).failed());
      // With memory a full reversal goes at 1 - hold of the rate, over S_F = 2.
      const double F_max = saturation(laws.F_max, 0.711),
                   left = form == Form::memory ? 2 * F_max * std::exp(-beta * 0.7 / 2 * 0.04) : 0;
      EXPECT_NEAR(point.state().F_dev, left - F_max, 1e-7);
      ASSERT_FALSE(point.walk(0.02, -0.02).failed());
      if (form != Form::coupled_3_14) {
        EXPECT_NEAR(point.state().F_dev, -saturation(laws.F_max, point.state().nu), 3 / beta);
      }
      expect_sound(point.state());
    }
}

TEST(HardCases, NegativeGammaP) {
  for (const Form form : forms) {
    ParameterSet set = thesis_with_memory();
    for (auto& [mode, row] : set.isotropic) row.gamma_p.value = -0.5;
    set.moduli->gamma_p.value = -0.5;
    MaterialPoint stiffer = point_at(0.7, form, set), softer = point_at(0.7, form);
    ASSERT_FALSE(stiffer.walk(0.1, 0.05).failed());
    ASSERT_FALSE(softer.walk(0.1, 0.05).failed());
    EXPECT_GT(stiffer.state().P, softer.state().P) << name_of(form);
    expect_sound(stiffer.state());
    ASSERT_FALSE(stiffer.walk(-0.2, 0.05).failed());
    EXPECT_FALSE(stiffer.state().jammed);
  }
}

/// "refused", "failed", or "walked" with nothing in the record that is not a number but what is undefined.
std::string outcome(const ParameterSet& set, const Path& path, Form form) {
  try {
    const Prediction p = predict(set, path, {form, 1e-8, 1e-12, 5});
    for (const char* column : {"nu", "P", "sigma_dev", "F_dev"})
      for (const double x : p.record[column]) EXPECT_TRUE(std::isfinite(x)) << column;
    return p.status.failed() ? "failed" : "walked";
  } catch (const Error&) {
    return "refused";
  }
}

TEST(HardCases, NumbersThatAreNone) {
  const Path path = path_of(R"({"start": {"nu": 0.69}, "segments": [{"mode": "uni", "amount": 0.02},
      {"mode": "uni", "amount": -0.1}, {"mode": "uni", "amount": 0.15}]})");
  for (const Form form : forms) {
    std::map<const Parameter*, bool> used;
    const ParameterSet set = thesis_with_memory();
    make_law<double>(set, {form, {}}, [&](const Parameter& p) {
      used[&p] = true;
      return p.value;
    });
    for (const NamedParameter& entry : set.named())
      for (const double bad : {nothing, std::numeric_limits<double>::infinity()}) {
        SCOPED_TRACE(name_of(form) + " " + entry.name + " " + to_text(bad));
        ParameterSet spoilt = set;
        spoilt.parameter(entry.name).value = bad;
        EXPECT_EQ(outcome(spoilt, path, form), used.contains(entry.parameter) ? "refused" : "walked");
      }
    for (auto member :
         {&Start::nu, &Start::P, &Start::sigma_dev, &Start::F_dev, &Start::phi_J, &Start::phi_max})
      for (const double bad : {nothing, std::numeric_limits<double>::infinity()}) {
        Path spoilt = path;
        spoilt.start.*member = bad;
        EXPECT_EQ(outcome(set, spoilt, form), "refused") << name_of(form);
      }
    Path spoilt = path;
    spoilt.segments[1].amount = nothing;
    EXPECT_EQ(outcome(set, spoilt, form), "refused") << name_of(form);
  }
}

TEST(HardCases, NumbersThatAreNoneAtAPoint) {
  for (const Form form : forms) {
    SCOPED_TRACE(name_of(form));
    for (const double bad : {nothing, std::numeric_limits<double>::infinity()})
      for (const auto& [eps_vol, eps_dev] : {std::pair{bad, 0.0}, {0.0, bad}}) {
        MaterialPoint point = point_at(0.7, form);
        const Status status = point.walk(eps_vol, eps_dev);
        EXPECT_TRUE(status.failed());
        EXPECT_THAT(status.message, HasSubstr("not a number"));
        expect_sound(point.state());
      }
    for (double State::*member : {&State::nu, &State::P, &State::sigma_dev, &State::F_dev}) {
      const MaterialPoint good = point_at(0.7, form);
      State state = good.state();
      state.*member = nothing;
      MaterialPoint point(good.law(), state, {1e-8, 1e-11});
      EXPECT_TRUE(point.walk(0.01, 0.01).failed());
      EXPECT_TRUE(point.walk(0, 0.01).failed());
      EXPECT_TRUE(point.walk(-0.1, 0).failed());
    }
  }
}

/// Largest s/s_max on the way from nu = 0.711, sheared to saturation, to nu without shear.
double beyond_saturation(MaterialPoint& point, double nu) {
  EXPECT_FALSE(point.walk(0, 0.4).failed());
  std::vector<double> samples;
  for (int i = 1; i <= 50; ++i) samples.push_back(i / 50.0);
  double most = 0;
  const Status status = point.walk(std::log(nu / 0.711), 0, samples, [&](std::size_t, const State& state) {
    most = std::max(most, state.s_dev() / saturation(laws_of(point.law()).s_max, state.nu));
  });
  EXPECT_FALSE(status.failed()) << status.message;
  return most;
}

TEST(HardCases, StressRatioCrossesSaturationUnderVolumeChangeAlone) {
  // Decompression: sigma*_dev falls with A2 < s B. How far s goes beyond s_max is a matter of how much
  // pressure is left, and so of the start: 1.4 times with the P of Table 4.1's numbers, 2.2 times with the
  // ISO row's.
  MaterialPoint point = point_at(0.711, Form::coupled);
  State high = point.state();
  high.P = 0.0264;
  MaterialPoint more(point.law(), high, {1e-10, 1e-13});
  EXPECT_NEAR(beyond_saturation(more, 0.675), 1.4, 0.05);
  EXPECT_NEAR(beyond_saturation(point, 0.675), 2.17, 0.01);
  const auto ratio = [&] {
    return point.state().s_dev() / saturation(laws_of(point.law()).s_max, point.state().nu);
  };
  const double most = ratio();
  ASSERT_FALSE(point.walk(0, 1e-3).failed());
  EXPECT_LT(ratio(), most);
  EXPECT_GT(ratio(), 1);
  ASSERT_FALSE(point.walk(0, 0.4).failed());
  EXPECT_NEAR(ratio(), 1, 1e-4);
  EXPECT_GE(ratio(), 1 - 1e-9);  // from above, never through
  // Compression leaves s within.
  MaterialPoint denser = point_at(0.711, Form::coupled);
  EXPECT_LT(beyond_saturation(denser, 0.75), 1);
}

}  // namespace
}  // namespace grainlaw::model
