// Errors of a bench against closed forms, and that chance alone stays within its band.
#include "grainlaw/calibrate/bench_errors.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <sstream>

#include "grainlaw/element/file.hpp"
#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {
namespace {

namespace fs = std::filesystem;

TEST(BenchErrors, CompareGivesDeviationAndOffset) {
  const Groups reference{{{2, 4}}}, runs{{{2.6, 3.4}}};
  const Comparison c = compare(runs, reference, {0, 0}, {0, 0});
  EXPECT_NEAR(c.error, std::sqrt((0.36 + 0.36) / (4 + 16)), 1e-12);
  EXPECT_NEAR(c.offset, 0, 1e-12);
  EXPECT_EQ(c.band, 0);
  EXPECT_NEAR(compare({{{2.2, 4.4}}}, reference, {0, 0}, {0, 0}).offset, 0.1, 1e-12);
}

TEST(BenchErrors, CompareTakesPackingsApart) {
  // Packings differ by 10, the setting moves each by 1: the error is that of the setting.
  const Groups reference{{{1, 1}, {3, 3}}, {{11, 11}, {13, 13}}};
  const Groups runs{{{2, 2}, {4, 4}}, {{12, 12}, {14, 14}}};
  const Series variance = pooled_variance({&reference, &runs});
  EXPECT_EQ(variance, (Series{2, 2}));  // four pairs that are 2 apart
  const Comparison c = compare(runs, reference, variance, variance);
  EXPECT_NEAR(c.error, 1.0 / 7, 1e-12);
  EXPECT_NEAR(c.band, std::sqrt(2 * (0.25 + 0.25)) / 7, 1e-12);
}

TEST(BenchErrors, ChanceComesFromBothSides) {
  // Four runs of variance 3 against two of variance 1, at a mean of 2: sqrt(3/4 + 1/2)/2.
  const Groups runs{{{2}, {2}, {2}, {2}}}, reference{{{2}, {2}}};
  EXPECT_NEAR(compare(runs, reference, {3}, {1}).band, std::sqrt(0.75 + 0.5) / 2, 1e-12);
}

TEST(BenchErrors, ARowWithoutValueIsLeftOut) {
  const Comparison c = compare({{{2, std::nan("")}}}, {{{1, std::nan("")}}}, {0, std::nan("")}, {0, 0});
  EXPECT_NEAR(c.error, 1, 1e-12);
}

TEST(BenchErrors, OneRunPerGroupSaysNothingOfChance) {
  const Groups one{{{1, 2}}};
  EXPECT_TRUE(std::isnan(pooled_variance({&one})[0]));
}

/// Runs that differ by chance alone.
Groups noise(std::mt19937& generator, std::size_t groups, std::size_t runs) {
  std::normal_distribution<double> normal(1, 0.1);
  Groups all(groups, std::vector<Series>(runs, Series(400)));
  for (auto& group : all)
    for (Series& run : group)
      for (double& x : run) x = normal(generator);
  return all;
}

TEST(BenchErrors, ChanceAloneMakesAnErrorAsLargeAsTheBand) {
  std::mt19937 generator(1);
  const Groups a = noise(generator, 2, 3), b = noise(generator, 2, 3);
  const Series variance = pooled_variance({&a, &b});
  const Comparison c = compare(a, b, variance, variance);
  // 400 rows: the ratio scatters by 1/sqrt(800) from the error and by less from the band.
  EXPECT_NEAR(c.error / c.band, 1, 0.15);
  EXPECT_NEAR(c.band, 0.1 * std::sqrt(1.0 / 6 + 1.0 / 6), 0.005);
}

TEST(BenchErrors, ARunScattersAboutAllPackingsByBothVariances) {
  const Groups two{{{1}, {3}}, {{11}, {13}}};  // means 2 and 12: 50 between them; 2 within
  EXPECT_NEAR(variance_over_groups(two)[0], 50 + 0.5 * 2, 1e-12);
  const Groups one{{{1}, {3}}};
  EXPECT_TRUE(std::isnan(variance_over_groups(one)[0]));
}

TEST(BenchErrors, ScatterOverPackingsIsThatOfTheNoiseItIsMadeOf) {
  std::mt19937 generator(2);
  std::normal_distribution<double> packing(0, 0.3);
  Groups all = noise(generator, 40, 2);
  for (auto& group : all)
    for (std::size_t i = 0; i < 400; ++i) {
      const double shift = packing(generator);
      for (Series& run : group) run[i] += shift;
    }
  const Series variance = variance_over_groups(all);
  double mean = 0;
  for (const double x : variance) mean += x / 400;
  // 39 degrees of freedom in each of 400 rows: the mean scatters by sqrt(2/39/400) = 1.1 %.
  EXPECT_NEAR(mean, 0.3 * 0.3 + 0.1 * 0.1, 0.04 * 0.1);
}

BenchError line(Knob knob, double value, double cost, double error, bool finest = false) {
  BenchError e{};
  e.knob = knob;
  e.value = value;
  e.particle_steps = cost;
  e.quantity = "P";
  e.comparison = {error, 0.01, 0};
  e.finest = finest;
  return e;
}

TEST(BenchErrors, RecommendsTheCheapestWithinTwoBands) {
  const auto best = recommend({line(Knob::time_step, 5, 1, 0.03), line(Knob::time_step, 10, 2, 0.019),
                               line(Knob::time_step, 20, 4, 0.01), line(Knob::time_step, 200, 40, 0, true)},
                              Judge::chance, 1e-3);
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best[0].value, 10);
  EXPECT_EQ(best[0].excused, 0.019);  // within two bands of 0.01
  EXPECT_EQ(best[0].quantity, "P");
}

TEST(BenchErrors, AnErrorBelowTheWantedOneIsGoodEnough) {
  auto quiet = line(Knob::time_step, 5, 1, 9e-4);
  quiet.comparison.band = 1e-9;
  const std::vector<BenchError> lines{quiet, line(Knob::time_step, 200, 40, 0, true)};
  EXPECT_EQ(recommend(lines, Judge::chance, 1e-3).at(0).value, 5);
  EXPECT_EQ(recommend(lines, Judge::chance, 1e-3).at(0).quantity, "");  // nothing to excuse
  EXPECT_EQ(recommend(lines, Judge::chance, 8e-4).at(0).value, 200);
}

TEST(BenchErrors, ARecommendationSaysWhatOneRunOfEachTestTakes) {
  std::vector<BenchError> lines{line(Knob::rate, 1, 3, 0.01), line(Knob::rate, 1, 3, 0.01),
                                line(Knob::rate, 1, 3, 0.01), line(Knob::rate, 0.1, 30, 0, true)};
  lines[0].test = lines[1].test = BenchTest::d2;  // two quantities of one
  lines[0].core_s = lines[1].core_s = 4;
  lines[2].test = BenchTest::iso;
  lines[2].core_s = 1.5;
  EXPECT_EQ(recommend(lines, Judge::chance, 0.01).at(0).core_s, 5.5);
  lines[2].core_s = std::nan("");
  EXPECT_TRUE(std::isnan(recommend(lines, Judge::chance, 0.01).at(0).core_s));
}

TEST(BenchErrors, OneBadQuantityIsEnough) {
  auto bad = line(Knob::rate, 3, 1, 0.05);
  bad.quantity = "F_dev";
  const auto best = recommend(
      {line(Knob::rate, 3, 1, 0.001), bad, line(Knob::rate, 1, 3, 0.002), line(Knob::rate, 0.1, 30, 0, true)},
      Judge::chance, 1e-3);
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best[0].value, 1);
}

TEST(BenchErrors, FewerGrainsAreNotRecommendedForScatteringMore) {
  std::vector<BenchError> lines{line(Knob::count, 250, 1, 0.015), line(Knob::count, 4000, 16, 0, true)};
  for (BenchError& e : lines) e.packings = 0.05;
  EXPECT_TRUE(recommend(lines, Judge::one_packing, 1e-3).empty());
  EXPECT_EQ(recommend(lines, Judge::chance, 1e-3).at(0).value, 250);
}

TEST(BenchErrors, AMethodIsNotRecommended) {
  std::vector<BenchError> lines{line(Knob::method, 1e-4, 1, 0.005), line(Knob::method, 0, 16, 0, true)};
  for (BenchError& e : lines) e.packings = 0.05;
  for (const Judge judge : {Judge::chance, Judge::one_packing})
    EXPECT_TRUE(recommend(lines, judge, 1e-3).empty());
}

TEST(BenchErrors, OneTestIsHeldAgainstTheScatterOfPackings) {
  std::vector<BenchError> lines{line(Knob::rate, 3, 1, 0.06), line(Knob::rate, 1, 3, 0.04),
                                line(Knob::rate, 0.3, 10, 0.01), line(Knob::rate, 0.1, 30, 0, true)};
  for (BenchError& e : lines) e.packings = 0.05;
  const auto best = recommend(lines, Judge::one_packing, 1e-3);
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best[0].value, 1);
  EXPECT_EQ(recommend(lines, Judge::chance, 1e-3).at(0).value, 0.3);  // within two bands of 0.01
  for (BenchError& e : lines) e.packings = std::nan("");              // of one packing nothing is known
  EXPECT_TRUE(recommend(lines, Judge::one_packing, 1e-3).empty());
}

/// The table of data/bench, as bench dem wrote it.
std::vector<BenchError> table_of(const fs::path& csv) {
  std::map<std::string, Knob> knobs;
  for (const Knob knob : all_knobs()) knobs[name_of(knob)] = knob;
  const auto number = [](const std::string& cell) { return cell.empty() ? std::nan("") : std::stod(cell); };
  std::istringstream lines(read_file(csv));
  std::string text;
  std::getline(lines, text);  // names
  std::vector<BenchError> table;
  while (std::getline(lines, text)) {
    std::vector<std::string> cells;
    std::istringstream words(text);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    cells.resize(12);  // the last one may be empty
    BenchError e = line(knobs.at(cells[0]), number(cells[1]), number(cells[5]), number(cells[7]));
    e.test = cells[2] == "iso" ? BenchTest::iso : cells[2] == "d2" ? BenchTest::d2 : BenchTest::preparation;
    e.quantity = cells[3];
    e.core_s = number(cells[6]);
    e.comparison.band = number(cells[8]);
    e.packings = number(cells[11]);
    e.finest = cells[7].empty();
    if (e.finest) e.comparison = {};
    table.push_back(e);
  }
  return table;
}

/// What is measured stands in data/bench/dem-9261; a scene that says nothing follows it.
TEST(BenchErrors, DefaultsOfASceneAreTheCheapestForAQuarterOfAPercent) {
  const std::vector<BenchError> table = table_of(GRAINLAW_DATA_DIR "/bench/dem-9261/speed-against-error.csv");
  const BenchSetting defaults;  // those of a scene: Bench.OneOfTheValuesIsTheDefault
  const auto cheapest = [&](Judge judge, double wanted) {
    std::map<Knob, double> best;
    for (const Recommendation& one : recommend(table, judge, wanted)) best[one.knob] = one.value;
    return best;
  };
  for (const Judge judge : {Judge::chance, Judge::one_packing}) {
    EXPECT_EQ(cheapest(judge, wanted_errors[1]),
              (std::map<Knob, double>{{Knob::time_step, defaults.steps}, {Knob::rate, defaults.rate}}));
    // Who wants less has to go slower, and who allows more may go faster.
    EXPECT_EQ(cheapest(judge, wanted_errors[0])[Knob::rate], 0.3);
    EXPECT_EQ(cheapest(judge, wanted_errors[2])[Knob::rate], 3);
  }
}

class BenchFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder.dir = fs::temp_directory_path() / ("grainlaw-bench-errors-" + std::to_string(::getpid()));
    fs::remove_all(folder.dir);
  }
  void TearDown() override { fs::remove_all(folder.dir); }

  /// A record whose quantities are all `value`.
  void write(const std::string& name, double value) const {
    fs::create_directories(folder.record(name));
    Record record(record_columns());
    for (int i = 0; i <= Bench::rows; ++i) {
      std::vector<double> row(record_columns().size(), value);
      row[0] = 0;     // segment
      row[3] = 0.75;  // nu
      record.append(row);
    }
    record.write_csv(folder.record(name) / "record.csv");
    write_file(folder.record(name) / "provenance.json", Json{{"particle_steps", 1000}}.dump());
    write_file(folder.record(name) / core_time_file, Json{{"core_s", 0.5}}.dump());
  }

  RunFolder folder;
};

TEST_F(BenchFolder, ReadsWhatIsThereAndLeavesOutWhatIsNot) {
  Bench bench;
  bench.knobs = {Knob::time_step};
  const Sweep d2 = sweeps(bench).back();
  ASSERT_EQ(d2.test, BenchTest::d2);
  for (std::size_t i = 1; i < d2.variants.size(); ++i)  // the first is not there
    for (const auto& group : d2.variants[i].records)
      for (const auto& name : group) write(name, i == 1 ? 0.55 : 0.5);
  const auto errors = bench_errors(bench, folder);
  ASSERT_EQ(errors.size(), 4 * (d2.variants.size() - 1));  // four quantities; nothing of the ISO test
  EXPECT_EQ(errors[0].value, d2.variants[1].value);
  EXPECT_NEAR(errors[0].comparison.error, 0.1, 1e-9);
  EXPECT_EQ(errors[0].runs, 4u);
  EXPECT_EQ(errors[0].particle_steps, 1000);
  EXPECT_EQ(errors[0].core_s, 0.5);
  EXPECT_NEAR(errors[1].comparison.error, 0, 1e-9);
  const std::string csv = to_csv(errors);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + static_cast<long>(errors.size()));
}

TEST_F(BenchFolder, SaysWhatPackingsScatter) {
  Bench bench;
  bench.knobs = {Knob::time_step};
  const Sweep iso = sweeps(bench).front();
  for (const Variant& variant : iso.variants) {
    const double twins[2][2] = {{0.01, 0.03}, {0.11, 0.13}};
    for (std::size_t p = 0; p < 2; ++p)
      for (std::size_t t = 0; t < 2; ++t) write(variant.records[p][t], twins[p][t]);
  }
  const auto errors = bench_errors(bench, folder);
  EXPECT_NEAR(errors.at(0).packings, std::sqrt(51.0) / 7, 1e-12);
  EXPECT_NEAR(errors[0].scatter, std::sqrt(2.0) / 7, 1e-12);
  EXPECT_NE(to_csv(errors).find(",scatter,packings\n"), std::string::npos);
  EXPECT_NE(to_csv(errors).find(",0.202031,1.0202\n"), std::string::npos);
  EXPECT_NEAR(to_json(errors).at(0).at("packings").get<double>(), std::sqrt(51.0) / 7, 1e-12);
}

TEST_F(BenchFolder, FewAndManyGrainsScatterEachByThemselves) {
  Bench bench;
  bench.seeds = 3;
  bench.knobs = {Knob::count};
  const Sweep iso = sweeps(bench).front();
  for (const Variant& variant : iso.variants) {
    const double apart = &variant == &iso.variants.back() ? 0.05 : 0.1;
    for (std::size_t k = 0; k < 3; ++k)
      write(variant.records[0][k], 0.5 + apart * (static_cast<double>(k) - 1));
  }
  const auto errors = bench_errors(bench, folder);
  EXPECT_NEAR(errors.at(0).comparison.band, std::sqrt((4 + 1) / 3.0) / 10, 1e-12);
  EXPECT_NEAR(errors[0].packings, 0.2, 1e-12);  // its packings are what it compares
}

TEST_F(BenchFolder, SecondsAreTheMedianOfTheRunsThatSay) {
  Bench bench;
  bench.knobs = {Knob::time_step};
  const Sweep iso = sweeps(bench).front();
  const Variant& finest = iso.variants.back();
  for (const auto& group : finest.records)
    for (const auto& name : group) write(name, 0.5);
  const auto seconds = [&](std::size_t packing, std::size_t twin, double core_s) {
    write_file(folder.record(finest.records[packing][twin]) / core_time_file,
               Json{{"core_s", core_s}}.dump());
  };
  seconds(0, 0, 1), seconds(0, 1, 100), seconds(1, 0, 2), seconds(1, 1, 4);
  EXPECT_EQ(bench_errors(bench, folder).at(0).core_s, 3);
  fs::remove(folder.record(finest.records[1][1]) / core_time_file);  // of a run that was killed
  EXPECT_EQ(bench_errors(bench, folder).at(0).core_s, 2);
  for (const auto& group : finest.records)
    for (const auto& name : group) fs::remove(folder.record(name) / core_time_file);
  EXPECT_TRUE(std::isnan(bench_errors(bench, folder).at(0).core_s));
}

TEST_F(BenchFolder, WithoutTheFinestThereIsNoError) {
  Bench bench;
  bench.knobs = {Knob::time_step};
  const std::vector<Sweep> all = sweeps(bench);
  for (const auto& group : all.back().variants.front().records)
    for (const auto& name : group) write(name, 0.5);
  EXPECT_TRUE(bench_errors(bench, folder).empty());
}

}  // namespace
}  // namespace grainlaw::calibrate
