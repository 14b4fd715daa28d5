// Fits of whole paths: known parameters come back from the law's own paths; what paths cannot tell is said;
// and a few records of real grains.
#include "grainlaw/calibrate/fit_paths.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_fixture.hpp"
#include "fit_noise.hpp"
#include "grainlaw/calibrate/path_account.hpp"
#include "grainlaw/calibrate/path_errors.hpp"
#include "grainlaw/calibrate/path_problem.hpp"

namespace grainlaw::calibrate {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

model::ParameterSet thesis() { return model::ParameterSet::load(thesis_file()); }

model::PredictOptions options() {
  model::PredictOptions o;
  o.rtol = 1e-8;
  o.atol = 1e-12;
  o.rows_per_leg = 20;
  o.method = model::Method::adams;
  return o;
}

/// A D2 test at nu that the law itself has written.
PathSeries series_of(const model::ParameterSet& set, double nu, const std::string& mode = "d2") {
  PathSeries series;
  series.test = mode + "-" + to_text(nu);
  series.seeds = 3;
  series.path =
      Path::read(Reader(parse_json(R"({"start": {"nu": )" + to_text(nu) + R"(}, "segments": [{"mode": ")" +
                                       mode + R"(", "controls": {"eps_dev": 0.3}}]})",
                                   "path"),
                        "path"));
  for (int i = 0; i <= 20; ++i) series.samples.push_back({0, i * i / 400.0});
  const Record record = model::predict(set, series.path, series.samples, options()).record;
  for (std::size_t q = 0; q < path_columns.size(); ++q) {
    series.measured[q] = record[path_columns[q]];
    for (const double value : series.measured[q]) series.error[q] += 0.01 * std::abs(value) / 21;
  }
  return series;
}

std::vector<PathSeries> several(const model::ParameterSet& set) {
  return {series_of(set, 0.685), series_of(set, 0.711), series_of(set, 0.75)};
}

const std::vector<std::string> four{"moduli.a_I", "moduli.GB_max", "shear.s_max.Q_v", "shear.beta_F.Q_v"};

model::ParameterSet moved(const std::vector<std::string>& names, double factor) {
  model::ParameterSet set = thesis();
  for (const auto& name : names) set.parameter(name).value *= factor;
  return set;
}

TEST(FitPaths, KnownParametersComeBack) {
  for (const double factor : {0.7, 1.4}) {
    const PathProblem problem(moved(four, factor), four, several(thesis()), options());
    const PathMinimum best = problem.minimise(problem.start(), {1, 1, 1}, {});
    EXPECT_TRUE(best.converged) << best.exit;
    for (std::size_t k = 0; k < four.size(); ++k) {
      const double truth = thesis().parameter(four[k]).value;
      EXPECT_NEAR(best.values[k], truth, 1e-4 * truth) << four[k];
    }
  }
}

TEST(FitPaths, TheJacobianIsTheDerivativeOfTheResiduals) {
  const PathProblem problem(moved(four, 1.1), four, several(thesis()), options());
  const auto at = problem.evaluate(problem.start(), {1, 2, 3}, true);
  ASSERT_TRUE(at);
  for (std::size_t k = 0; k < four.size(); ++k) {
    auto up = problem.start(), down = problem.start();
    up[k] += 1e-4 * problem.scales()[k];
    down[k] -= 1e-4 * problem.scales()[k];
    const Eigen::VectorXd difference =
        (problem.evaluate(up, {1, 2, 3}, false)->values - problem.evaluate(down, {1, 2, 3}, false)->values) /
        2e-4;
    const auto column = at->jacobian.col(static_cast<Eigen::Index>(k));
    EXPECT_LT((difference - column).norm(), 1e-4 * column.norm()) << four[k];
  }
}

TEST(FitPaths, ComparesOnlyWhatItIsAsked) {
  const auto series = several(thesis());
  const PathProblem all(moved(four, 1.1), four, series, options());
  const PathProblem fabric(moved(four, 1.1), four, series, options(), {false, false, true});
  const auto whole = all.evaluate(all.start(), {1, 2, 3}, true),
             part = fabric.evaluate(all.start(), {1, 2, 3}, true);
  ASSERT_TRUE(whole && part);
  ASSERT_EQ(part->values.size() * 3, whole->values.size());
  EXPECT_EQ(fabric.run_lengths().size(), series.size());
  Eigen::Index row = 0;
  for (const PathSeries& s : series) {
    const auto n = static_cast<Eigen::Index>(s.samples.size());
    EXPECT_EQ(part->values.segment(row, n), whole->values.segment(3 * row + 2 * n, n));
    EXPECT_EQ(part->jacobian.middleRows(row, n), whole->jacobian.middleRows(3 * row + 2 * n, n));
    row += n;
  }
  EXPECT_TRUE(std::isnan(misfits_of(fabric, fabric.start()).stress));
  EXPECT_EQ(misfits_of(fabric, fabric.start()).fabric, misfits_of(all, all.start()).fabric);
}

TEST(FitPaths, SaysWhatPathsCannotTell) {
  // Without volume change A2 does nothing; at one density only Q_v exp(-alpha (nu/nu_c - 1)) shows.
  const std::vector<std::string> names{"moduli.a_II", "moduli.a_I", "shear.beta_F.Q_v", "shear.beta_F.alpha"};
  const PathProblem problem(thesis(), names, {series_of(thesis(), 0.711)}, options());
  const auto at = problem.evaluate(problem.start(), {1, 1, 1}, true);
  ASSERT_TRUE(at);
  const Blind blind = blind_parameters(problem, at->jacobian);
  EXPECT_EQ(blind.numbers.size(), 2U);
  EXPECT_THAT(blind.numbers, Contains(0U));
  EXPECT_EQ(blind.reasons[0], "the paths do not depend on it");
  EXPECT_EQ(blind.reasons[1], "");
  EXPECT_THAT(blind.reasons[2] + blind.reasons[3], HasSubstr("only a combination of it with shear.beta_F."));
}

TEST(FitPaths, StandardErrorsAndProfilesHoldTheTruth) {
  // Independent noise of one error on every row: errors and profiles of a law that is linear across them are
  // the same, and 1.96 of them hold the truth in 95 % of the cases.
  Noise noise(7);
  int held = 0, cases = 0;
  for (int trial = 0; trial < 25; ++trial) {
    auto series = several(thesis());
    for (auto& s : series)
      for (std::size_t q = 0; q < path_columns.size(); ++q)
        for (double& value : s.measured[q]) value += s.error[q] * noise.one();
    const PathProblem problem(thesis(), four, series, options());
    const PathMinimum best = problem.minimise(problem.start(), {1, 1, 1}, {});
    const auto at = problem.evaluate(best.values, {1, 1, 1}, true);
    const PathErrors errors = path_errors(problem, *at, {});
    EXPECT_NEAR(errors.variance, 1, 0.4);
    for (std::size_t k = 0; k < four.size(); ++k, ++cases)
      held += std::abs(best.values[k] - problem.start()[k]) < 1.96 * errors.errors[k];
    if (trial > 0) continue;
    const Profile profile = profile_of(problem, best, errors, {1, 1, 1}, {}, 1);
    ASSERT_TRUE(profile.low && profile.high);
    EXPECT_NEAR(*profile.high - *profile.low, 2 * 1.96 * errors.errors[1], 0.3 * errors.errors[1]);
  }
  // Binomial: 100 cases, standard deviation 2.2.
  EXPECT_GE(held, 88) << "of " << cases;
}

TEST(FitPaths, ALawThatDoesNotComeAlongIsAnOutcome) {
  model::ParameterSet set = thesis();
  set.shear->s_max->Q_max.value = -0.5;
  const PathProblem problem(set, four, several(thesis()), options());
  const PathMinimum best = problem.minimise(problem.start(), {1, 1, 1}, {});
  EXPECT_FALSE(best.converged);
  EXPECT_THAT(best.exit, StartsWith("failed: the law does not come along"));
  EXPECT_THAT(best.exit, HasSubstr("s_max is -"));
  EXPECT_EQ(best.values, problem.start());
}

TEST(FitPaths, StaysWithinTheBoundsOfTheLaw) {
  // Data of a G/B that would be negative: Q of a GB_max > 0 rests on the bound.
  auto series = several(thesis());
  for (auto& s : series) std::fill(s.measured[1].begin(), s.measured[1].end(), 0.0);
  const PathProblem problem(thesis(), {"moduli.GB_max"}, series, options());
  const PathMinimum best = problem.minimise(problem.start(), {0, 1, 0}, {});
  EXPECT_GT(best.values[0], 0);
  EXPECT_LT(best.values[0], 0.02);
}

/// Three tests of real grains.
class FewRecords : public testing::Test {
 protected:
  FewRecords() {
    for (const char* name :
         {"d2-0.7-s1", "d2-0.7-s2", "d2-0.75-s1", "d2-0.75-s2", "d2-0.78-s1", "d2-0.78-s2"})
      fs::copy(fs::path(GRAINLAW_DATA_DIR) / "records/quick/records" / name, scratch_.dir() / name);
  }
  Scratch scratch_;
};

TEST_F(FewRecords, ArePolished) {
  PolishOptions o;
  o.names = {"moduli.a_I", "shear.s_max.Q_v", "moduli.a_II"};
  o.selection.rows_per_leg = 12;
  const PolishOutput out = polish(scratch_.dir(), thesis(), o);
  const Json& account = out.account;
  EXPECT_THAT(account["exit"].get<std::string>(), StartsWith("converged"));
  EXPECT_EQ(account["data"].size(), 3U);
  EXPECT_EQ(account["data"][0]["seeds"], 2);
  EXPECT_LT(account["misfit_after"]["stress"].get<double>(),
            account["misfit_before"]["stress"].get<double>());
  EXPECT_EQ(account["parameters"][2]["reason"], "the paths do not depend on it");
  EXPECT_EQ(out.parameters.moduli->a_II.value, thesis().moduli->a_II.value);
  EXPECT_EQ(out.parameters.moduli->a_II.source, "thesis");
  const model::Parameter& a_I = out.parameters.moduli->a_I;
  EXPECT_EQ(a_I.source, "fit");
  EXPECT_GT(*a_I.stderr_, 0);
  EXPECT_EQ(account["parameters"][0]["value"], a_I.value);
  // More weight on fabric never makes its misfit larger, nor that of stress smaller.
  const Json& sweep = account["trade_off"];
  ASSERT_EQ(sweep.size(), 7U);
  for (std::size_t i = 1; i < sweep.size(); ++i) {
    EXPECT_LE(sweep[i]["fabric"].get<double>(), sweep[i - 1]["fabric"].get<double>() * (1 + 1e-3));
    EXPECT_GE(sweep[i]["stress"].get<double>(), sweep[i - 1]["stress"].get<double>() * (1 - 1e-3));
  }
  // What is written can be read again.
  const auto again = model::ParameterSet::read(Reader(out.parameters.to_json(), "polished.json"));
  EXPECT_EQ(again.moduli->a_I.value, a_I.value);
}

TEST_F(FewRecords, RefuseNamesAndModesThatAreNotThere) {
  PolishOptions o;
  o.names = {"moduli.a_III"};
  EXPECT_THROW(polish(scratch_.dir(), thesis(), o), Error);
  o.names = {};
  o.selection.modes = {"uni"};
  EXPECT_THROW(polish(scratch_.dir(), thesis(), o), Error);
}

}  // namespace
}  // namespace grainlaw::calibrate
