// Jamming densities and strains that obey Eqs. 5.1, 5.2, 5.5 and 5.13 give their parameters back; what data
// cannot tell apart is said, not made up.
#include "grainlaw/calibrate/fit_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_noise.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::calibrate {
namespace {

const model::OverCompression thesis{0.6567, 1, 0.3, 0.02, 0.3};
const KnownValues thesis_values{{"phi_SJ", {0.6567, 5e-4}},
                                {"mu", 1},
                                {"beta", 0.3},
                                {"alpha_max", {0.02, 4e-4}},
                                {"alpha_phi", 0.3},
                                {"alpha", {1.37, 0.01}},
                                {"eps0", {0.102, 1e-3}},
                                {"eps0_R", {0.17, 2e-3}}};
constexpr double amplitudes[] = {0.66, 0.67, 0.68, 0.70, 0.73, 0.77, 0.82, 0.90};

CycleDensity cycle(double phi_max, double M, const std::string& seed, double phi_J) {
  CycleDensity c;
  c.test = "oc-" + std::to_string(phi_max) + "-s" + seed;
  c.group = seed;
  c.phi_max = phi_max;
  c.M = M;
  c.from_P = {phi_J, 1e-5};
  return c;
}

/// Cycles by the model, which shares no code with the fits.
std::vector<CycleDensity> cycles_of(const model::OverCompression& law, int most, int seeds = 3) {
  std::vector<CycleDensity> all;
  for (int seed = 1; seed <= seeds; ++seed)
    for (const double phi_max : amplitudes)
      for (int M = 1; M <= most; ++M)
        all.push_back(cycle(phi_max, M, std::to_string(seed), model::jamming_density_after(law, phi_max, M)));
  return all;
}

void expect_value(const FitResult& fit, const std::string& name, double truth, double tolerance) {
  EXPECT_NEAR(fit.value(name), truth, tolerance) << name;
  EXPECT_TRUE(fit[name].determined) << name << ": " << fit[name].reason;
}

TEST(MemoryFits, OverCompressionGivesItsFiveNumbersBack) {
  const FitResult result =
      fit(over_compression_problem(cycles_of(thesis, 20), Growth::stretched, thesis_values));
  // Rounding of phi_J (1e-16) times the condition of the problem (below 1e5).
  expect_value(result, "phi_SJ", 0.6567, 1e-7);
  expect_value(result, "alpha_max", 0.02, 1e-6);
  expect_value(result, "alpha_phi", 0.3, 1e-5);
  expect_value(result, "mu", 1, 1e-4);
  expect_value(result, "beta", 0.3, 1e-5);
}

TEST(MemoryFits, OneCycleEachSaysNothingAboutTheGrowth) {
  const FitResult result =
      fit(over_compression_problem(cycles_of(thesis, 1), Growth::stretched, thesis_values));
  // share(M = 1) is one number: mu, beta and alpha_max cannot all be had.
  EXPECT_TRUE(result["mu"].held) << result["mu"].value;
  EXPECT_FALSE(result["mu"].determined);
  EXPECT_EQ(result.value("mu"), 1);
}

TEST(MemoryFits, CyclesThatDidNotJamAreLeftOut) {
  std::vector<CycleDensity> cycles = cycles_of(thesis, 5);
  const FitProblem all = over_compression_problem(cycles, Growth::stretched, thesis_values);
  cycles[3].from_P = {};
  const FitProblem fewer = over_compression_problem(cycles, Growth::stretched, thesis_values);
  EXPECT_EQ(all.series.front().points.size(), 5u);
  EXPECT_EQ(fewer.series.front().points.size(), 4u);
}

TEST(MemoryFits, NoSlopeIsInfiniteAtTheEdges) {
  const FitProblem problem = over_compression_problem(cycles_of(thesis, 3), Growth::stretched, thesis_values);
  std::vector<double> gradient(5);
  const double p[] = {0.6567, 0.02, 0.3, 1, 0.3};
  for (const FitPoint& at : {FitPoint{0.82, 0, 0, 0}, FitPoint{0.6567, 0, 1, 0}, FitPoint{0.65, 0, 1, 0}}) {
    EXPECT_EQ(problem.law(p, at, gradient), 0.6567);  // M = 0, and phi_max at and below phi_SJ
    for (const double slope : gradient) EXPECT_TRUE(std::isfinite(slope));
  }
  EXPECT_LT(problem.parameters[0].high, 0.66);  // below every phi_max, where the slope would be infinite
}

TEST(MemoryFits, GrowthLawsStartAtNothingAndEndAtOne) {
  for (const Growth growth : growths) {
    EXPECT_EQ(grown(growth, 0, 1, 0.5), 0) << name_of(growth);
    EXPECT_LT(grown(growth, 1, 1, 0.5), grown(growth, 2, 1, 0.5)) << name_of(growth);
    EXPECT_NEAR(grown(growth, 1e300, 1, 5), 1, 2e-3) << name_of(growth);
  }
  EXPECT_NEAR(grown(Growth::stretched, 1, 1, 0.3), 1 - std::exp(-1.0), 1e-15);
}

/// Central differences: their error falls with the square of the step, then rises by rounding. A wrong
/// derivative would leave it flat.
TEST(MemoryFits, DerivativesOfTheGrowthLawsFormAV) {
  for (const Growth growth : growths) {
    const FitProblem problem = growth_problem(cycles_of(thesis, 4, 1), growth, 0.6567);
    std::vector<double> p, gradient(problem.parameters.size());
    for (const FitParameter& parameter : problem.parameters) p.push_back(parameter.initial);
    const FitPoint at{2, 0, 3, 0};
    problem.law(p, at, gradient);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const auto error = [&](double step) {
        std::vector<double> up = p, down = p;
        up[i] += step;
        down[i] -= step;
        return std::abs((problem.law(up, at, {}) - problem.law(down, at, {})) / (2 * step) - gradient[i]);
      };
      EXPECT_NEAR(error(1e-2) / error(1e-3), 100, 20) << name_of(growth) << i;
      EXPECT_GT(error(1e-12), error(1e-4)) << name_of(growth) << i;
    }
    EXPECT_EQ(gradient[4], grown(growth, 3, p[0], p[1]));  // linear in the amplitude of record 2
    EXPECT_EQ(gradient[3], 0);
  }
}

TEST(MemoryFits, TheLawThatMadeTheCyclesIsPreferred) {
  for (const Growth truth : growths) {
    std::vector<CycleDensity> cycles;
    Noise noise(7);
    for (const double phi_max : amplitudes) {
      const double amplitude = 0.02 * (phi_max - 0.65) * (1 + 0.3 * noise.one());  // each record its own
      for (int M = 1; M <= 40; ++M)
        cycles.push_back(
            cycle(phi_max, M, "1", 0.6567 + amplitude * grown(truth, M, 1.5, 0.4) + 2e-7 * noise.one()));
    }
    const auto comparison = compare_growths(cycles, 0.6567);
    ASSERT_EQ(comparison.size(), 3u);
    for (const GrowthComparison& c : comparison) {
      if (c.growth == truth) {
        EXPECT_EQ(c.delta_AIC, 0) << name_of(truth);
        EXPECT_NEAR(c.beta, 0.4, 0.02) << name_of(truth);
      } else {
        EXPECT_GT(c.delta_AIC, 10) << name_of(truth) << " against " << name_of(c.growth);
      }
    }
  }
}

TEST(MemoryFits, SaysWhichParametersAreEntangled) {
  const FitProblem problem =
      over_compression_problem(cycles_of(thesis, 20), Growth::stretched, thesis_values);
  const auto pairs = entanglement(problem, fit(problem));
  ASSERT_EQ(pairs.size(), 10u);
  for (const Entanglement& e : pairs) EXPECT_LE(std::abs(e.correlation), 1 + 1e-12) << e.first << e.second;
  // A straight line: its two numbers are entangled by minus the mean over the root mean square of x.
  FitProblem line;
  line.law = [](std::span<const double> p, const FitPoint& at, std::span<double> gradient) {
    if (!gradient.empty()) {
      gradient[0] = 1;
      gradient[1] = at.x;
    }
    return p[0] + p[1] * at.x;
  };
  line.parameters = {known_parameter({}, "a", 0, -9, 9, 1), known_parameter({}, "b", 0, -9, 9, 1)};
  line.series = {{"", "", {{1, 1}, {2, 2}, {3, 3.5}}}};
  const auto of_line = entanglement(line, fit(line));
  ASSERT_EQ(of_line.size(), 1u);
  EXPECT_NEAR(of_line[0].correlation, -2 / std::sqrt(14.0 / 3), 1e-12);
}

ShearJamming sheared(double nu, double phi_J0, std::size_t reversals, double strain) {
  ShearJamming run;
  run.test = "sj-" + std::to_string(nu) + std::to_string(phi_J0);
  run.group = "1";
  run.phi_max = 0.82;
  run.M = 1;
  run.phi_J0 = {phi_J0, 1e-5};
  run.nu = nu;
  run.reversals = reversals;
  run.jammed_before = reversals > 0;
  run.strain = {strain, strain, strain};
  run.longest = 0.28;
  return run;
}

double eps_SJ(double phi, double phi_J, double eps0) {
  return eps0 * std::pow(-std::log((phi - 0.6567) / (phi_J - 0.6567)), 1 / 1.37);
}

std::vector<ShearJamming> shear_runs() {
  std::vector<ShearJamming> runs;
  for (const double phi_J0 : {0.6610, 0.6632, 0.6652})
    for (double nu = 0.6575; nu < phi_J0; nu += 0.8e-3)
      runs.push_back(sheared(nu, phi_J0, 0, eps_SJ(nu, phi_J0, 0.102)));
  for (double nu = 0.6575; nu < 0.6645; nu += 0.8e-3)
    runs.push_back(sheared(nu, 0.6652, 1, nu < 0.6618 ? eps_SJ(nu, 0.6618, 0.17) : 0.0));
  return runs;
}

TEST(MemoryFits, ShearJammingGivesItsThreeNumbersBack) {
  const FitResult result = fit(shear_jamming_problem(shear_runs(), {0.6567, 5e-4}, thesis_values));
  expect_value(result, "phi_SJ_sheared", 0.6567, 1e-7);
  expect_value(result, "alpha", 1.37, 1e-4);
  expect_value(result, "eps0", 0.102, 1e-5);
}

TEST(MemoryFits, PackingsJammedBeforeShearSayNothingAboutIt) {
  std::vector<ShearJamming> runs = shear_runs();
  const std::size_t n = fit(shear_jamming_problem(runs, 0.6567, thesis_values)).n;
  runs.push_back(sheared(0.666, 0.6652, 0, 0.05));                                       // above phi_J0
  runs.push_back(sheared(0.6580, 0.6652, 0, std::numeric_limits<double>::quiet_NaN()));  // never jammed
  EXPECT_EQ(fit(shear_jamming_problem(runs, 0.6567, thesis_values)).n, n);
}

TEST(MemoryFits, ReversalGivesItsTwoNumbersBack) {
  const FitResult result = fit(reversal_problem(shear_runs(), 0.6567, 1.37, thesis_values));
  expect_value(result, "eps0_R", 0.17, 1e-5);
  expect_value(result, "phi_cr", 0.6618, 1e-6);
  EXPECT_TRUE(result["alpha"].held);
}

TEST(MemoryFits, ReversalsOfOnePackingCountOnce) {
  std::vector<ShearJamming> runs = shear_runs();
  const FitProblem first = reversal_problem(runs, 0.6567, 1.37, thesis_values);
  for (std::size_t reversals = 2; reversals < 8; ++reversals)  // about the first, mean as before
    for (const ShearJamming& run : shear_runs())
      if (run.reversals == 1)
        runs.push_back(
            sheared(run.nu, 0.6652, reversals, run.strain[0] + (reversals % 2 == 0 ? 0.01 : -0.01)));
  const FitProblem all = reversal_problem(runs, 0.6567, 1.37, thesis_values);
  ASSERT_EQ(all.series.size(), first.series.size());
  for (std::size_t i = 0; i < all.series.size(); ++i)
    EXPECT_NEAR(all.series[i].points.at(0).y, first.series[i].points.at(0).y, 1e-12);
  const FitResult result = fit(all);
  expect_value(result, "eps0_R", 0.17, 1e-5);
  expect_value(result, "phi_cr", 0.6618, 1e-6);
}

TEST(MemoryFits, WithoutRunsTheKnownValuesStandMarkedAsHeld) {
  const MemoryFit result = fit_memory(cycles_of(thesis, 6), {}, thesis_values);
  EXPECT_TRUE(result.over_compression["phi_SJ"].determined);
  EXPECT_TRUE(result.shear["eps0"].held);
  EXPECT_FALSE(result.shear["eps0"].determined);
  EXPECT_EQ(result.shear.value("eps0"), 0.102);
  EXPECT_FALSE(result.reversal["phi_cr"].determined);
}

TEST(MemoryFits, AnAmplitudeThatOftenLeavesPackingsLooseIsNoFairSample) {
  std::vector<CycleDensity> cycles = cycles_of(thesis, 20);
  const double one = cycles.back().phi_max;
  const std::size_t all = over_compression_problem(cycles, Growth::stretched, thesis_values).series.size();
  const auto lose = [&](std::size_t count) {
    for (CycleDensity& c : cycles)
      if (c.phi_max == one && c.M <= static_cast<double>(count)) c.from_P = {};
    return over_compression_problem(cycles, Growth::stretched, thesis_values).series;
  };
  EXPECT_EQ(lose(2).size(), all);
  EXPECT_EQ(lose(2).back().points.size(), 18u);
  EXPECT_EQ(lose(3).size(), all - 3);  // of three seeds
  EXPECT_LT(lose(3).back().points.front().x, one);
}

TEST(MemoryFits, RelaxedStatesTellTheLimitWithTheOthers) {
  const Estimate at_rest(0.6569, 1e-4);
  const MemoryFit result = fit_memory(cycles_of(thesis, 6), shear_runs(), thesis_values, at_rest);
  // Data without noise: what the laws say is certain, to rounding, and outweighs the relaxed states.
  EXPECT_EQ(result.phi_SJ.by_rest.value, 0.6569);
  EXPECT_NEAR(result.phi_SJ.value, 0.6567, 1e-6);
  EXPECT_TRUE(result.over_compression["phi_SJ"].held);
  // Without runs it is theirs, and the law of cycles stands at it.
  const MemoryFit alone = fit_memory({}, {}, thesis_values, at_rest);
  EXPECT_NEAR(alone.phi_SJ.value, 0.6569, 1e-12);
  EXPECT_NEAR(alone.phi_SJ.error, 1e-4, 1e-12);
}

/// Packings differ by an offset of phi_J each: the errors must come from that, and hold the truth as often as
/// Student's t says.
TEST(MemoryFits, ErrorsComeFromTheScatterOverSeeds) {
  Noise noise(11);
  int within = 0;
  constexpr int replicates = 30;
  for (int k = 0; k < replicates; ++k) {
    std::vector<CycleDensity> cycles = cycles_of(thesis, 8, 4);
    double of_seed = 0;
    std::string seed;
    for (CycleDensity& c : cycles) {
      if (c.group != seed) of_seed = 5e-4 * noise.one();
      seed = c.group;
      c.from_P.value += of_seed + 1e-5 * noise.one();
    }
    FitProblem problem = over_compression_problem(cycles, Growth::stretched, thesis_values);
    for (FitParameter& p : problem.parameters)
      if (p.name == "mu" || p.name == "beta" || p.name == "alpha_phi") {
        p.held = true;
        p.initial = thesis_values.at(p.name).value;
      }
    const FitResult result = fit(problem);
    EXPECT_EQ(result.stderr_from, "scatter over seeds");
    const auto interval = *result["phi_SJ"].interval95;
    within += interval.first <= 0.6567 && 0.6567 <= interval.second ? 1 : 0;
  }
  EXPECT_GE(within, 25);  // 28.5 expected of 30, less three standard deviations
}

}  // namespace
}  // namespace grainlaw::calibrate
