#include "grainlaw/calibrate/fit_packing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fit_noise.hpp"
#include "grainlaw/model/laws/packing_laws.hpp"

namespace grainlaw::calibrate {
namespace {

/// A row of Table 2.1.
struct Row {
  const char* mode;
  double C1, alpha, nu_c_contacts, phi_c, phi_v, p0, gamma_p, nu_c;
};
constexpr Row table[] = {{"iso", 8.2720, 0.5814, 0.6646, 0.1216, 15.8950, 0.04172, 0.06228, 0.6649},
                         {"uni", 8.370, 0.5998, 0.6625, 0.1507, 15.6835, 0.04006, 0.03270, 0.6619},
                         {"d2", 7.9219, 0.5769, 0.6601, 0.1363, 15.0010, 0.03886, 0.03219, 0.6581},
                         {"d3", 7.9289, 0.5764, 0.6603, 0.1327, 14.6813, 0.03899, 0.02893, 0.6583}};
constexpr Row iso = table[0];

model::PressureCurve laws_of(const Row& row, double C0 = 6) {
  return {{C0, row.C1, row.alpha, row.nu_c_contacts, row.phi_c, row.phi_v}, row.p0, row.gamma_p, row.nu_c};
}

/// States on the laws from `high` down to `low`, computed by the model, which shares no code with the fits.
PackingSeries branch(const Row& row, double high, double low, int rows, double C0 = 6) {
  const model::PressureCurve laws = laws_of(row, C0);
  PackingSeries series{row.mode, "1", {}};
  for (int i = 0; i < rows; ++i) {
    const double nu = high + (low - high) * i / (rows - 1);
    PackingState s;
    s.nu = nu;
    s.C_star = model::corrected_coordination(laws.contacts, nu);
    s.phi_r = model::rattlers(laws.contacts, nu);
    s.C = model::coordination(laws.contacts, nu);
    s.P = model::pressure(laws, nu);
    series.states.push_back(s);
  }
  return series;
}

void expect_value(const FitResult& fit, const std::string& name, double truth) {
  EXPECT_NEAR(fit.value(name), truth, 1e-6 * std::abs(truth)) << name;
  EXPECT_TRUE(fit[name].determined) << name << ": " << fit[name].reason;
  EXPECT_FALSE(fit[name].at_bound) << name;
}

TEST(PackingFits, ReturnTheThesisParametersFromNoiseFreeData) {
  for (const Row& row : table) {
    SCOPED_TRACE(row.mode);
    const PackingFit fit = fit_packing({branch(row, 0.82, 0.67, 60)}, Points::rows, {});
    expect_value(fit.contacts, "C1", row.C1);
    expect_value(fit.contacts, "alpha", row.alpha);
    expect_value(fit.contacts, "nu_c_contacts", row.nu_c_contacts);
    expect_value(fit.contacts_free_C0, "C0", 6);
    expect_value(fit.contacts_free_C0, "C1", row.C1);
    expect_value(fit.contacts_free_C0, "alpha", row.alpha);
    expect_value(fit.contacts_free_C0, "nu_c_contacts", row.nu_c_contacts);
    expect_value(fit.rattlers, "phi_c", row.phi_c);
    expect_value(fit.rattlers, "phi_v", row.phi_v);
    expect_value(fit.pressure, "p0", row.p0);
    expect_value(fit.pressure, "gamma_p", row.gamma_p);
    expect_value(fit.pressure, "nu_c", row.nu_c);
    EXPECT_LT(fit.contacts.rms, 1e-9);
    EXPECT_GE(fit.contacts.best_found, 1);
    EXPECT_TRUE(fit.contacts.exit.starts_with("converged")) << fit.contacts.exit;
  }
}

TEST(PackingFits, FreeC0LooksOnlyNearJamming) {
  // Far above jamming the contacts leave the law; the limit must not notice.
  PackingSeries bent = branch(iso, 0.82, 0.667, 100);
  for (PackingState& s : bent.states) s.C_star -= s.nu > 0.75 ? 3 * std::pow(s.nu - 0.75, 2) : 0;
  const PackingFit fit = fit_packing({bent}, Points::rows, {});
  EXPECT_NEAR(fit.contacts_free_C0.value("C0"), 6, 1e-6);
  EXPECT_GT(std::abs(fit.contacts.value("C1") - iso.C1), 1e-3);
}

TEST(PackingFits, FreeC0FindsAnotherC0ThanSix) {
  const PackingFit fit = fit_packing({branch(iso, 0.82, 0.67, 60, 5.7)}, Points::rows, {});
  expect_value(fit.contacts_free_C0, "C0", 5.7);
  EXPECT_GT(fit.contacts.rms, 1e-3);  // with C0 = 6 held the law cannot follow
}

/// Adds noise to one quantity of a branch.
using Disturb = std::function<void(PackingState&, double)>;
PackingSeries noisy(PackingSeries series, Noise& noise, double correlation, const Disturb& disturb) {
  const std::vector<double> z = noise.series(series.states.size(), correlation);
  for (std::size_t i = 0; i < z.size(); ++i) disturb(series.states[i], z[i]);
  return series;
}

constexpr int replicates = 400;
/// Noise of successive rows, white and with the correlation that rows of a shear test have. With 100 rows and
/// a correlation of 0.7 there are 18 independent ones, and estimating that costs up to 2 % of coverage.
constexpr double correlations[] = {0.0, 0.7};
double allowance(double correlation) { return correlation == 0 ? 0 : 0.02; }

TEST(PackingFits, ErrorsOfContactsCoverTheTruth) {
  const PackingSeries clean = branch(iso, 0.82, 0.67, 100);
  for (const double correlation : correlations) {
    SCOPED_TRACE(correlation);
    Noise noise(11);
    Coverage C1, alpha, nu_c;
    for (int i = 0; i < replicates; ++i) {
      const PackingSeries data =
          noisy(clean, noise, correlation, [](PackingState& s, double z) { s.C_star += 0.02 * z; });
      const FitResult r = fit(few_starts(contacts_problem({data}, Points::rows, {})));
      C1.count(r, "C1", iso.C1);
      alpha.count(r, "alpha", iso.alpha);
      nu_c.count(r, "nu_c_contacts", iso.nu_c_contacts);
    }
    C1.expect_as_claimed("C1", allowance(correlation));
    alpha.expect_as_claimed("alpha", allowance(correlation));
    nu_c.expect_as_claimed("nu_c", allowance(correlation));
  }
}

TEST(PackingFits, ErrorsOfFreeC0CoverTheTruth) {
  const PackingSeries clean = branch(iso, 0.82, 0.667, 100);
  Noise noise(12);
  Coverage C0;
  for (int i = 0; i < replicates; ++i) {
    const PackingSeries data =
        noisy(clean, noise, 0.5, [](PackingState& s, double z) { s.C_star += 0.005 * z; });
    C0.count(fit(few_starts(contacts_problem({data}, Points::rows, {}, true))), "C0", 6);
  }
  C0.expect_as_claimed("C0", allowance(0.5));
}

TEST(PackingFits, ErrorsOfRattlersCoverTheTruthAndCarryThatOfNuC) {
  const PackingSeries clean = branch(iso, 0.82, 0.67, 100);
  constexpr double nu_c_error = 2e-3;
  for (const double correlation : correlations) {
    SCOPED_TRACE(correlation);
    Noise noise(13);
    Coverage phi_c, phi_v;
    for (int i = 0; i < replicates; ++i) {
      const PackingSeries data =
          noisy(clean, noise, correlation, [](PackingState& s, double z) { s.phi_r += 0.001 * z; });
      const double nu_c = iso.nu_c_contacts + nu_c_error * noise.one();
      const FitResult r = fit(few_starts(rattlers_problem({data}, Points::rows, {}, nu_c, nu_c_error)));
      phi_c.count(r, "phi_c", iso.phi_c);
      phi_v.count(r, "phi_v", iso.phi_v);
    }
    phi_c.expect_as_claimed("phi_c", allowance(correlation));
    phi_v.expect_as_claimed("phi_v", allowance(correlation));
  }
}

TEST(PackingFits, ErrorsOfPressureCoverTheTruth) {
  const PackingSeries clean = branch(iso, 0.82, 0.67, 100);
  for (const double correlation : correlations) {
    SCOPED_TRACE(correlation);
    Noise noise(14);
    Coverage p0, gamma_p, nu_c;
    for (int i = 0; i < replicates; ++i) {
      const PackingSeries data =
          noisy(clean, noise, correlation, [](PackingState& s, double z) { s.P += 2e-4 * z; });
      const FitResult r = fit(few_starts(pressure_problem({data}, Points::rows, {})));
      p0.count(r, "p0", iso.p0);
      gamma_p.count(r, "gamma_p", iso.gamma_p);
      nu_c.count(r, "nu_c", iso.nu_c);
    }
    p0.expect_as_claimed("p0", allowance(correlation));
    gamma_p.expect_as_claimed("gamma_p", allowance(correlation));
    nu_c.expect_as_claimed("nu_c", allowance(correlation));
  }
}

TEST(PackingFits, ScatterOverSeedsCoversTheTruth) {
  // Each seed has a jamming density of its own, which its own rows cannot tell; the mean over seeds is the
  // truth.
  Noise noise(15);
  Coverage p0, nu_c;
  for (int i = 0; i < replicates; ++i) {
    std::vector<PackingSeries> seeds;
    for (int seed = 0; seed < 4; ++seed) {
      Row row = iso;
      row.nu_c += 1e-3 * noise.one();
      row.p0 += 3e-4 * noise.one();
      seeds.push_back(branch(row, 0.82, 0.68, 40));
      seeds.back().group = std::to_string(seed);
    }
    const FitResult r = fit(few_starts(pressure_problem(seeds, Points::rows, {})));
    ASSERT_EQ(r.stderr_from, "scatter over seeds");
    p0.count(r, "p0", iso.p0);
    nu_c.count(r, "nu_c", iso.nu_c);
  }
  p0.expect_as_claimed("p0");
  nu_c.expect_as_claimed("nu_c");
}

/// Seeds that jam at these volume fractions, each with rows from 0.003 above its own on.
std::vector<PackingSeries> seeds_jamming_at(const std::vector<double>& nu_c) {
  std::vector<PackingSeries> seeds;
  for (const double at : nu_c) {
    Row row = iso;
    row.nu_c_contacts = row.nu_c = at;
    seeds.push_back(branch(row, 0.82, at + 3e-3, 60));
    seeds.back().group = std::to_string(seeds.size());
  }
  return seeds;
}

TEST(PackingFits, ASeedThatJamsLaterIsNotHeldBelowTheLowestRowOfAll) {
  // All rows together bound nu_c by 0.663, the lowest row of the first seed; the error needs what each seed
  // says by itself: 0.660, 0.662, 0.664, whose mean has the standard error 0.002/sqrt(3).
  const auto seeds = seeds_jamming_at({0.660, 0.662, 0.664});
  const FitResult contacts = fit(contacts_problem(seeds, Points::rows, {}));
  EXPECT_NEAR(*contacts["nu_c_contacts"].stderr_, 0.002 / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(contacts.stderr_from, "scatter over seeds");
  // A law through the rows of all would be bent; each seed alone lies on its own.
  expect_value(contacts, "nu_c_contacts", 0.662);
  expect_value(contacts, "C1", iso.C1);
  expect_value(contacts, "alpha", iso.alpha);
  EXPECT_LT(contacts.rms, 1e-6);
  const FitResult pressure = fit(pressure_problem(seeds, Points::rows, {}));
  EXPECT_NEAR(*pressure["nu_c"].stderr_, 0.002 / std::sqrt(3.0), 1e-6);
}

TEST(PackingFits, TheErrorOfAHeldValueIsNotAveragedOverSeeds) {
  // phi_r depends on nu_c only through phi_v nu/nu_c, phi_c exp(phi_v): an error of nu_c shifts phi_v by as
  // much.
  const auto seeds = seeds_jamming_at({0.662, 0.662, 0.662, 0.662});
  const FitResult r = fit(rattlers_problem(seeds, Points::rows, {}, 0.662, 0.662e-3));
  ASSERT_EQ(r.stderr_from, "scatter over seeds");
  EXPECT_NEAR(*r["phi_v"].stderr_, 1e-3 * iso.phi_v, 1e-5 * iso.phi_v);
  EXPECT_NEAR(*r["phi_c"].stderr_, 1e-3 * iso.phi_c * iso.phi_v, 1e-4 * iso.phi_c * iso.phi_v);
}

TEST(PackingFits, ASeedThatSaysLittleCountsLittle) {
  // The fourth has only states far from jamming, with an error in C* that grows there: its C0 is far off, and
  // it knows.
  auto seeds = seeds_jamming_at({0.660, 0.662, 0.664, 0.662});
  Noise noise(3);
  for (PackingSeries& seed : seeds)
    for (PackingState& s : seed.states) s.C_star += (seed.group == "4" ? 0.1 : 0.002) * noise.one();
  const FitResult r = fit(contacts_problem(seeds, Points::rows, {{"C0", 6}}, true));
  EXPECT_THAT(r.exit, testing::StartsWith("converged for each of 4 seeds alone"));
  EXPECT_NEAR(r.value("C0"), 6, 3 * *r["C0"].stderr_);
  EXPECT_LT(*r["C0"].stderr_, 0.03);
}

TEST(PackingFits, ASeedOnABoundIsLeftOutWhereThreeRemain) {
  auto seeds = seeds_jamming_at({0.660, 0.661, 0.662, 0.663});
  for (PackingState& s : seeds[3].states) s.P *= 1 - 8 * std::log(s.nu / 0.663);
  const FitResult r = fit(pressure_problem(seeds, Points::rows, {}));
  EXPECT_THAT(r.exit, testing::HasSubstr("3 seeds alone"));
  EXPECT_THAT(r.exit, testing::HasSubstr("(seed 4 rests on a bound and is left out)"));
  expect_value(r, "nu_c", 0.661);
}

TEST(PackingFits, ASeedOnABoundIsNamed) {
  // The third seed's pressure bends so much that gamma_p runs into its bound, 5.
  std::vector<PackingSeries> seeds = seeds_jamming_at({0.660, 0.661, 0.662});
  for (PackingState& s : seeds[2].states) s.P *= 1 - 8 * std::log(s.nu / 0.662);
  const FitResult r = fit(pressure_problem(seeds, Points::rows, {}));
  EXPECT_THAT(r.stderr_from, testing::StartsWith("scatter over seeds (a lower bound; at bounds: "));
  EXPECT_THAT(r.stderr_from, testing::HasSubstr("gamma_p of seed 3"));
}

TEST(PackingFits, ErrorsOverSteadyStatesCoverTheTruth) {
  // One state per run: two seeds at each of eight volume fractions, whose own error is known to 20 %.
  const Row d2 = table[2];
  const PackingSeries clean = branch(d2, 0.80, 0.675, 8);
  Noise noise(16);
  Coverage p0, nu_c, C1;
  for (int i = 0; i < replicates; ++i) {
    std::vector<PackingSeries> runs;
    for (const PackingState& state : clean.states) {
      for (const char* seed : {"1", "2"}) {
        PackingState s = state;
        s.P += 3e-4 * noise.one();
        s.C_star += 0.015 * noise.one();
        s.P_error = 3e-4 * std::exp(0.2 * noise.one());
        s.C_star_error = 0.015 * std::exp(0.2 * noise.one());
        runs.push_back({"d2", seed, {s}});
      }
    }
    const FitResult p = fit(few_starts(pressure_problem(runs, Points::runs, {})));
    p0.count(p, "p0", d2.p0);
    nu_c.count(p, "nu_c", d2.nu_c);
    C1.count(fit(few_starts(contacts_problem(runs, Points::runs, {}))), "C1", d2.C1);
  }
  p0.expect_as_claimed("p0");
  nu_c.expect_as_claimed("nu_c");
  C1.expect_as_claimed("C1");
}

TEST(PackingFits, HoldWhatTooFewVolumeFractionsLeaveOpen) {
  const KnownValues known{{"C1", 8.2720},    {"alpha", 0.5814}, {"nu_c_contacts", 0.6646}, {"phi_c", 0.1216},
                          {"phi_v", 15.895}, {"p0", 0.04172},   {"gamma_p", 0.06228},      {"nu_c", 0.6649}};
  PackingSeries two = branch(iso, 0.76, 0.70, 2);
  PackingFit fit = fit_packing({two}, Points::runs, known);
  EXPECT_FALSE(fit.contacts["alpha"].determined);
  EXPECT_EQ(fit.contacts.value("alpha"), 0.5814);
  EXPECT_NE(fit.contacts["alpha"].reason.find("2 different x for 3 parameters"), std::string::npos)
      << fit.contacts["alpha"].reason;
  EXPECT_TRUE(fit.contacts["C1"].determined) << "the rest goes on";
  EXPECT_NEAR(fit.contacts.value("C1"), 8.2720, 1e-6);
  EXPECT_FALSE(fit.pressure["gamma_p"].determined);
  EXPECT_NEAR(fit.pressure.value("p0"), 0.04172, 1e-8);

  // Without known values, what cannot be fitted is not a number, and nothing else is made up for it.
  fit = fit_packing({two}, Points::runs, {});
  EXPECT_TRUE(std::isnan(fit.contacts.value("C1")));
  EXPECT_FALSE(fit.rattlers.ran);
  EXPECT_THAT(fit.rattlers["phi_c"].reason, testing::HasSubstr("nu_c_contacts"));

  fit = fit_packing({}, Points::rows, known);
  for (const FitEstimate& e : fit.pressure.parameters) {
    EXPECT_FALSE(e.determined);
    EXPECT_EQ(e.reason, "no data");
    EXPECT_EQ(e.value, known.at(e.name).value);
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
