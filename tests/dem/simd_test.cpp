// What the instruction set changes of a result: at first roundings, later what
// the chaos of the flow makes of them, and nothing else.
#include "grainlaw/dem/numbers/simd.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/numbers/random.hpp"
#include "grainlaw/element/tensor.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

// Instruction sets add in orders of their own: at first by rounding, later as far apart as chaos takes them.
TEST(Targets, GoApartByRoundingOnly) {
  const Material m;
  const State start = test::squeezed(m, 500, 6, 0.7, 0.1);
  const auto after = [&](std::int64_t target, int steps) {
    hwy::SetSupportedTargetsForTest(target);
    Dynamics dynamics(m, start);
    dynamics.start(time_step(m, dynamics.grains().smallest_radius(), 0.1), {});
    for (int n = 0; n < steps; ++n) dynamics.step();
    hwy::SetSupportedTargetsForTest(0);
    return dynamics.state();
  };
  const State plain = after(HWY_SCALAR, 50);
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    const State other = after(target, 50);
    double worst = 0;
    for (std::size_t i = 0; i < plain.count(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(other.position[i][c] - plain.position[i][c]));
    EXPECT_LT(worst,
              1e-11);  // mm; a rounding is 2e-15 mm, and grows by 1e3 in five contact durations at most
    EXPECT_GT(worst, 0);
  }
}

/// P (in units of k), s_dev and F_dev, row by row.
using Rows = std::array<std::vector<double>, 3>;
const std::array<std::string, 3> quantities{"P", "s_dev", "F_dev"};

constexpr std::size_t elastic_rows = 10, flow_rows = 40;
constexpr double elastic_end = 1e-3, flow_end = 0.05;  // eps_dev
constexpr double d2_rate = 2.839e-5;                   // 1/us, the default of a scene
constexpr double nudge = 1e-7;                         // mm

/// 200 grains in balance at nu = 0.75.
State jammed(const Material& m) {
  StaticPacking packing(m, test::squeezed(m, 200, 6, 0.75));
  minimise(packing, {});
  return packing.state();
}

/// Shears from eps_dev = `from` to `to`, measured from a box with these edges, in `count` rows.
template <class AfterRow>
void shear(Dynamics& dynamics, const Mat3& start, double from, double to, std::size_t count,
           const AfterRow& after_row) {
  const double rate = d2_rate / std::sqrt(3.0), row = (to - from) / static_cast<double>(count);
  const double longest = time_step(dynamics.material(), dynamics.material().r_min(), 0.2);
  const int steps = static_cast<int>(std::ceil(row / d2_rate / longest));
  dynamics.start(row / d2_rate / steps, {rate, -rate, 0});
  for (std::size_t r = 0; r < count; ++r) {
    for (int n = 1; n <= steps; ++n) {
      const double strain = (from + row * (static_cast<double>(r) + 1.0 * n / steps)) / std::sqrt(3.0);
      dynamics.step({start(0, 0) * std::exp(strain), start(1, 1) * std::exp(-strain), start(2, 2)},
                    {rate, -rate, 0});
    }
    after_row(dynamics.measure());
  }
}

/// P (in units of k), s_dev and F_dev.
std::array<double, 3> row_of(const Material& m, const Measurement& now) {
  const double pressure = trace(now.stress) / 3;
  return {pressure / m.k, deviator_along(now.stress, {-1, 1, 0, 0, 0, 0}) / pressure,
          deviator_along(now.fabric, {-1, 1, 0, 0, 0, 0})};
}

/// Every grain moved by about so many mm, each seed another way.
State nudged(State state, double by, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& x : state.position)
    for (double& component : x) component += by * random.normal();
  return state;
}

/// A D2 test at the defaults, with every grain moved by about 1e-7 mm.
Rows d2_test(const Material& m, const State& start, std::int64_t target, std::uint64_t seed) {
  hwy::SetSupportedTargetsForTest(target);
  Dynamics dynamics(m, nudged(start, nudge, seed));
  Rows rows;
  const auto keep = [&](const Measurement& now) {
    for (std::size_t q = 0; q < rows.size(); ++q) rows[q].push_back(row_of(m, now)[q]);
  };
  shear(dynamics, start.box, 0, elastic_end, elastic_rows, keep);
  shear(dynamics, start.box, elastic_end, flow_end, flow_rows, keep);
  hwy::SetSupportedTargetsForTest(0);
  return rows;
}

/// How far the means of two sets of runs lie apart, over what chance makes of that if all are twins, s
/// sqrt(1/n + 1/m) with the pooled s; of several rows the root mean squares.
double apart(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  const auto mean = [](const auto& runs, std::size_t row) {
    double sum = 0;
    for (const auto& run : runs) sum += run[row];
    return sum / static_cast<double>(runs.size());
  };
  double far = 0, scatter = 0;
  for (std::size_t row = 0; row < a.front().size(); ++row) {
    const double of_a = mean(a, row), of_b = mean(b, row);
    far += std::pow(of_a - of_b, 2);
    for (const auto& run : a) scatter += std::pow(run[row] - of_a, 2) / (n + m - 2);
    for (const auto& run : b) scatter += std::pow(run[row] - of_b, 2) / (n + m - 2);
  }
  return std::sqrt(far / (scatter * (1 / n + 1 / m)));
}

std::vector<double> part(const std::vector<double>& rows, std::size_t begin, std::size_t end) {
  return {rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.begin() + static_cast<std::ptrdiff_t>(end)};
}

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

/// Student's t of ten degrees of freedom, which a number exceeds in size once in 1e5.
constexpr double student = 8.15;
constexpr std::uint64_t many = 8, few = 4;

std::vector<Rows> d2_tests(const Material& m, const State& start, std::int64_t target,
                           std::uint64_t first_seed, std::uint64_t count) {
  std::vector<Rows> tests;
  for (std::uint64_t i = 0; i < count; ++i) tests.push_back(d2_test(m, start, target, first_seed + i));
  return tests;
}

// Eight runs on one target and four on another, all told apart by 1e-7 mm: do they scatter about one mean?
// Asked of each row of the elastic beginning, where the network answers to the nudge alone, so that a factor
// 1.01 on all forces, which leaves every balance where it is, shows by how far the flow lags behind it; and,
// where avalanches part the runs, of the mean over the flow and of all its rows together. Rows of a flow
// depend on each other, so their root mean square is held to the same t, as if they were a single number.
TEST(Targets, ScatterAboutOneMean) {
  const Material m;
  const State start = jammed(m);
  std::vector<std::int64_t> others{HWY_SCALAR};
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3})
    if ((hwy::SupportedTargets() & target) != 0) others.push_back(target);
  const std::vector<Rows> best = d2_tests(m, start, others.back(), 1, many);
  others.pop_back();
  if (others.empty()) others.push_back(HWY_SCALAR);  // a machine of one set: further runs on the same
  std::uint64_t seed = 1 + many;
  for (const std::int64_t target : others) {
    const std::vector<Rows> other = d2_tests(m, start, target, seed, few);
    seed += few;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      SCOPED_TRACE(quantities[q] + " on " + hwy::TargetName(target));
      const auto compare = [&](const auto& of) {
        std::vector<std::vector<double>> a, b;
        for (const Rows& run : best) a.push_back(of(run[q]));
        for (const Rows& run : other) b.push_back(of(run[q]));
        return apart(a, b);
      };
      for (std::size_t row = 0; row < elastic_rows; ++row)
        EXPECT_LT(compare([&](const auto& rows) { return part(rows, row, row + 1); }), student) << row;
      const auto flow = [](const auto& rows) { return part(rows, elastic_rows, rows.size()); };
      EXPECT_LT(compare([&](const auto& rows) { return std::vector{mean(flow(rows))}; }), student);
      EXPECT_LT(compare(flow), student);
    }
  }
}

/// A piece of the flow: 0.005 of eps_dev in five rows.
constexpr double piece = 0.005;
constexpr std::size_t piece_rows = 5, pieces = 10, twins = 4;
constexpr double rounding = 1e-15;  // mm, of a place in a box of some ten mm
constexpr double chaos = 1e-7;      // mm; from there on runs are not compared

struct Followed {
  std::vector<double> log_P, s_dev;
  std::vector<std::vector<Vec3>> places;
  State end;
};

/// From eps_dev = `from`, in a box that began with these edges.
Followed follow_piece(const Material& m, const State& state, const Mat3& start, double from,
                      std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  Dynamics dynamics(m, state);
  Followed followed;
  shear(dynamics, start, from, from + piece, piece_rows, [&](const Measurement& now) {
    const auto row = row_of(m, now);
    followed.log_P.push_back(std::log(row[0]));
    followed.s_dev.push_back(row[1]);
    followed.places.push_back(dynamics.state().position);
  });
  followed.end = dynamics.state();
  hwy::SetSupportedTargetsForTest(0);
  return followed;
}

/// Median distance between the places of a grain in two runs, mm.
double distance(const Followed& a, const Followed& b, std::size_t row) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < a.places[row].size(); ++i) {
    const Vec3 &x = a.places[row][i], &y = b.places[row][i];
    distances.push_back(norm({x[0] - y[0], x[1] - y[1], x[2] - y[2]}));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

/// Root mean square over the twins of what differs in a row; not below what a last digit makes.
double scatter_of(const std::vector<Followed>& twins_of, const Followed& best,
                  std::vector<double> Followed::*of, std::size_t row) {
  double squares = 0;
  for (const Followed& twin : twins_of) squares += std::pow((twin.*of)[row] - (best.*of)[row], 2);
  return std::max(std::sqrt(squares / static_cast<double>(twins_of.size())), rounding);
}

// A flow on the best target, piece by piece. Each piece is run again from the same state on the other
// targets, and on the same one with every place off by a rounding: before chaos has taken the runs apart,
// another target must do what a rounding does, no more. Distances of the grains, from 1e-14 mm at first to
// 1e-7 mm where grains rearrange, are compared with those of four twins, as a geometric mean over the rows:
// over twelve packings 0.5 to 1.5 times as far, and 2.4 to 11 times if the places are off by a hundred
// roundings. P and s_dev of a row differ by at most 28 times the scatter of the twins. On one target,
// distances that are off by 1e-14 of themselves, all forces by 1e-10 or the damping by 1e-9 fail this.
TEST(Targets, GoApartLikeTwinsOfOneAllAlongTheFlow) {
  const Material m;
  State state = jammed(m);
  const Mat3 start = state.box;
  std::vector<std::int64_t> targets = {HWY_SCALAR};
  for (const std::int64_t target : {HWY_AVX2, HWY_AVX3})
    if ((hwy::SupportedTargets() & target) != 0) targets.push_back(target);
  const std::int64_t best_target = targets.back();
  targets.pop_back();
  std::vector<double> log_of_ratio(targets.size());
  std::size_t rows = 0;
  for (std::size_t k = 0; k < pieces; ++k) {
    const double from = piece * static_cast<double>(k);
    const Followed best = follow_piece(m, state, start, from, best_target);
    std::vector<Followed> twin, other;
    for (std::uint64_t seed = 1; seed <= twins; ++seed)
      twin.push_back(follow_piece(m, nudged(state, rounding, seed), start, from, best_target));
    for (const std::int64_t target : targets) other.push_back(follow_piece(m, state, start, from, target));
    for (std::size_t row = 0; row < piece_rows; ++row) {
      double log_of_twins = 0;
      for (const Followed& run : twin)
        log_of_twins += std::log(distance(run, best, row)) / static_cast<double>(twins);
      if (log_of_twins > std::log(chaos)) break;
      ++rows;
      for (std::size_t t = 0; t < targets.size(); ++t) {
        SCOPED_TRACE(std::string(hwy::TargetName(targets[t])) + ", row " + std::to_string(row) +
                     " of piece " + std::to_string(k));
        log_of_ratio[t] += std::log(distance(other[t], best, row)) - log_of_twins;
        for (const auto of : {&Followed::log_P, &Followed::s_dev})
          EXPECT_LT(std::abs((other[t].*of)[row] - (best.*of)[row]), 100 * scatter_of(twin, best, of, row));
      }
    }
    state = best.end;
  }
  EXPECT_GT(rows, 30u);
  for (std::size_t t = 0; t < targets.size(); ++t)
    EXPECT_LT(std::abs(log_of_ratio[t]) / static_cast<double>(rows), std::log(4))
        << hwy::TargetName(targets[t]);
}

}  // namespace
}  // namespace grainlaw::dem
