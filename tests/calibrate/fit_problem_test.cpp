#include "grainlaw/calibrate/fit_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fit_noise.hpp"
#include "grainlaw/calibrate/fit_law.hpp"
#include "grainlaw/calibrate/fit_minimise.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_shear.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

struct Line {
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    return p[0] + p[1] * at.x;
  }
};

FitParameter parameter(const std::string& name, double initial, double low, double high, double scale = 1) {
  FitParameter p;
  p.name = name;
  p.initial = initial;
  p.low = low;
  p.high = high;
  p.scale = scale;
  return p;
}

FitProblem line_through(const std::vector<FitPoint>& points) {
  FitProblem problem;
  problem.law = differentiable<2>(Line{});
  problem.parameters = {parameter("a", 0, -100, 100), parameter("b", 0, -100, 100)};
  problem.series = {{"line", "1", points}};
  return problem;
}

TEST(FitProblem, IndependentRunsGiveTheTextbookErrorsOfALine) {
  // x = 0..4: slope error s/sqrt(10), intercept error s sqrt(1/5 + 4/10), s^2 = sum r^2/3, worked by hand.
  FitProblem problem = line_through({{0, 1.1}, {1, 2.9}, {2, 5.2}, {3, 6.8}, {4, 9.0}});
  problem.points = Points::runs;
  const FitResult r = fit(problem);
  EXPECT_NEAR(r.value("b"), 1.97, 1e-9);
  EXPECT_NEAR(r.value("a"), 1.06, 1e-9);
  double square = 0;
  const double y[] = {1.1, 2.9, 5.2, 6.8, 9.0};
  for (int i = 0; i < 5; ++i) square += std::pow(y[i] - 1.06 - 1.97 * i, 2);
  const double s = std::sqrt(square / 3);
  EXPECT_NEAR(*r["b"].stderr_, s / std::sqrt(10.0), 1e-9);
  EXPECT_NEAR(*r["a"].stderr_, s * std::sqrt(0.2 + 0.4), 1e-9);
  EXPECT_EQ(r.degrees_of_freedom, 3);
  EXPECT_NEAR(r["b"].interval95->second, 1.97 + 3.182446305 * s / std::sqrt(10.0), 1e-8);  // t_0.975 of 3
  EXPECT_NEAR(r.rms, std::sqrt(square / 5), 1e-12);
  EXPECT_EQ(r.stderr_from, "scatter over runs");
}

TEST(FitProblem, ConditionIsThatOfTheScaledJacobian) {
  // Columns (1, 1) and (-1, 1) times the scales 1 and 100: condition 100.
  FitProblem problem = line_through({{-1, 0}, {1, 0}, {-1, 1}, {1, 1}});
  problem.parameters[1].scale = 100;
  EXPECT_NEAR(fit(problem).condition, 100, 1e-6);
}

TEST(FitProblem, ErrorBeyondTheKnownOnesIsSharedByAllPoints) {
  // Errors far below the scatter: without the extra scatter the first two points alone would make the line.
  FitProblem problem = line_through(
      {{0, 0, 0, 1e-6}, {1, 0.1, 0, 1e-6}, {2, -0.1, 0, 1e-3}, {3, 0.1, 0, 1e-3}, {4, 0, 0, 1e-3}});
  problem.points = Points::runs;
  const FitResult r = fit(problem);
  EXPECT_GT(r.extra_scatter, 0.05);
  EXPECT_LT(r.extra_scatter, 0.2);
  EXPECT_LT(std::abs(r.value("b")), 0.05);
}

TEST(FitProblem, SingularDirectionIsReportedAndTheRestGoesOn) {
  // Only the product u v matters.
  FitProblem problem;
  problem.law = [](std::span<const double> p, const FitPoint& at, std::span<double> g) {
    if (!g.empty()) {
      g[0] = p[1];
      g[1] = p[0];
      g[2] = at.x;
    }
    return p[0] * p[1] + p[2] * at.x;
  };
  problem.parameters = {parameter("u", 1, 0.1, 10), parameter("v", 1, 0.1, 10), parameter("slope", 0, -9, 9)};
  problem.series = {{"t", "1", {{0, 2}, {1, 5}, {2, 8}, {3, 11}, {4, 14}, {5, 17.001}}}};
  FitResult r = fit(problem);
  EXPECT_FALSE(r["u"].determined);
  EXPECT_FALSE(r["v"].determined);
  EXPECT_FALSE(r["u"].stderr_);
  EXPECT_TRUE(r["slope"].determined);
  EXPECT_NEAR(r.value("slope"), 3, 1e-3);
  EXPECT_GT(r.condition, 1e7);

  problem.parameters[1].fallback = 4;  // now v can be held, and u is what the data leave
  r = fit(problem);
  EXPECT_FALSE(r["v"].determined);
  EXPECT_EQ(r.value("v"), 4);
  EXPECT_TRUE(r["u"].determined);
  EXPECT_NEAR(r.value("u"), 0.5, 1e-3);
}

TEST(FitProblem, AParameterWithoutANaturalSizeIsJudgedByItsValue) {
  // Slopes of 50 and 0.1, both with an error of about 0.3.
  for (const double slope : {50.0, 0.1}) {
    FitProblem problem =
        line_through({{0, 0}, {1, slope + 1}, {2, 2 * slope - 1}, {3, 3 * slope + 1}, {4, 4 * slope}});
    problem.points = Points::runs;
    problem.parameters[1].scale = 0.2;
    EXPECT_FALSE(fit(problem)["b"].determined) << "by a natural size of 0.2";
    problem.parameters[1].judged_by_value = true;
    const FitEstimate b = fit(problem)["b"];
    EXPECT_EQ(b.determined, slope == 50) << b.value << " +- " << *b.stderr_;
  }
}

TEST(FitProblem, BoundsAreKeptAndReported) {
  FitProblem problem = line_through({{0, 5}, {1, 6}, {2, 7.1}, {3, 8}});
  problem.parameters[0].high = 4;
  const FitResult r = fit(problem);
  EXPECT_TRUE(r["a"].at_bound);
  EXPECT_DOUBLE_EQ(r.value("a"), 4);
  EXPECT_FALSE(r["a"].determined);
  EXPECT_NE(r["a"].reason.find("bound 4"), std::string::npos) << r["a"].reason;
  EXPECT_FALSE(r["a"].stderr_);
  EXPECT_TRUE(r["b"].determined);
}

TEST(FitProblem, NothingLeftToFitIsNoFit) {
  // Both are open and can be held: what remains is said, not fitted.
  FitProblem problem = line_through({{0, 1}});
  for (FitParameter& p : problem.parameters) p.fallback = 2;
  FitResult r = fit(problem);
  EXPECT_FALSE(r.ran);
  EXPECT_EQ(r.value("a"), 2);
  EXPECT_FALSE(r["b"].reason.empty());
  problem.parameters[0].held = problem.parameters[1].held = true;
  r = fit(problem);
  EXPECT_FALSE(r.ran);
  EXPECT_TRUE(r.determined()) << "given values are not in question";
}

TEST(FitProblem, ErrorOfAHeldParameterGoesIntoTheOthers) {
  // a held at 1 +- 0.3: with x = 1, 2, 3, 4 the slope moves by -0.3 sum(x)/sum(x^2).
  FitProblem problem = line_through({{1, 3}, {2, 5}, {3, 7}, {4, 9}});
  problem.parameters[0].held = true;
  problem.parameters[0].initial = 1;
  problem.parameters[0].held_error = 0.3;
  const FitResult r = fit(problem);
  EXPECT_NEAR(*r["b"].stderr_, 0.3 * 10 / 30, 1e-6);
}

TEST(FitProblem, SeveralStartsFindTheLowestOfSeveralMinima) {
  // cos(p x) through cos(7 x): the minima beside it hold a descent from 1.
  FitProblem problem;
  problem.law = [](std::span<const double> p, const FitPoint& at, std::span<double> g) {
    if (!g.empty()) g[0] = -at.x * std::sin(p[0] * at.x);
    return std::cos(p[0] * at.x);
  };
  problem.parameters = {parameter("frequency", 1, 0.5, 20, 5)};
  FitSeries series{"t", "1", {}};
  for (int i = 0; i < 60; ++i) series.points.push_back({0.1 * i, std::cos(0.7 * i)});
  problem.series = {series};
  EXPECT_GT(std::abs(fit(problem).value("frequency") - 7), 0.5) << "one start ends in a side minimum";
  problem.starts = 40;
  const FitResult r = fit(problem);
  EXPECT_NEAR(r.value("frequency"), 7, 1e-8);
  EXPECT_EQ(r.starts, 40);
  EXPECT_GE(r.best_found, 1);
  EXPECT_LT(r.best_found, 40);
}

TEST(FitProblem, SameDataGiveTheSameDigits) {
  FitProblem problem = line_through({{0, 1.1}, {1, 2.9}, {2, 5.2}, {3, 6.8}});
  problem.starts = 10;
  const FitResult first = fit(problem), second = fit(problem);
  EXPECT_EQ(first.value("a"), second.value("a"));
  EXPECT_EQ(first.value("b"), second.value("b"));
  EXPECT_EQ(*first["b"].stderr_, *second["b"].stderr_);
}

TEST(FitProblem, RefusesWhatMakesNoSense) {
  FitProblem problem = line_through({{0, 1}, {1, std::nan("")}, {2, 3}});
  EXPECT_THROW(fit(problem), Error);
  problem = line_through({{0, 1}, {1, 2}, {2, 3}});
  problem.parameters[0].initial = 1000;
  EXPECT_THROW(fit(problem), Error);
}

TEST(LatinHypercube, HasOnePointInEverySliceOfEveryDimension) {
  const auto points = latin_hypercube(16, 3, 5);
  for (std::size_t d = 0; d < 3; ++d) {
    std::set<int> slices;
    for (const auto& p : points) slices.insert(static_cast<int>(p[d] * 16));
    EXPECT_EQ(slices.size(), 16u);
  }
  EXPECT_EQ(points, latin_hypercube(16, 3, 5));
  EXPECT_NE(points, latin_hypercube(16, 3, 6));
}

/// Largest relative difference between a law's gradient and its central difference with relative step h.
double gradient_error(const FitProblem& problem, const FitPoint& at, double h) {
  std::vector<double> p;
  for (const FitParameter& x : problem.parameters) p.push_back(x.initial == 0 ? 0.1 * x.scale : x.initial);
  std::vector<double> gradient(p.size());
  problem.law(p, at, gradient);
  double worst = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    std::vector<double> up = p, down = p;
    up[i] *= 1 + h;
    down[i] *= 1 - h;
    const double slope = (problem.law(up, at, {}) - problem.law(down, at, {})) / (up[i] - down[i]);
    worst = std::max(worst, std::abs(slope - gradient[i]) / std::abs(gradient[i]));
  }
  return worst;
}

TEST(Laws, GradientsShowTheVOfACentralDifference) {
  // The error of a central difference falls as h^2 until rounding makes it rise as 1/h: only a correct
  // gradient shows both.
  const PackingSeries state{"t", "1", {{0.7, 0.02, 7, 7.3, 0.05}, {0.8, 0.07, 9, 9.2, 0.01}}};
  const FitProblem problems[] = {
      contacts_problem({state}, Points::rows, {}, true), rattlers_problem({state}, Points::rows, {}, 0.66, 0),
      pressure_problem({state}, Points::rows, {}), approach_problem({"t", "1", 0.7, {0.1}, {0.1}}),
      density_problem(ShearQuantity::s_max, {}, 0.66, 0, {})};
  const FitPoint points[] = {{0.75, 0, 0}, {0.75, 0, 0}, {0.75, 0, 8}, {0.02, 0, 0}, {0.72, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    SCOPED_TRACE(i);
    const double coarse = gradient_error(problems[i], points[i], 4e-3),
                 half = gradient_error(problems[i], points[i], 2e-3);
    EXPECT_NEAR(coarse / half, 4, 0.3) << "second order";
    const double best = gradient_error(problems[i], points[i], 1e-5);
    EXPECT_LT(best, 2e-8);
    EXPECT_GT(gradient_error(problems[i], points[i], 1e-12), 100 * best);
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
