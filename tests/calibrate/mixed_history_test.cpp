// Volume after far shear, which no fit has read: packings of 4000 grains sheared by 0.3 at nu = 0.68 and
// 0.72, then decompressed, dipped, compressed anew (data/records/mixed, three packings), and those of 9261
// grains (data/records/volumetric). The form with memory of data/grains/w-3-memory.json follows their strain,
// row by row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/element/median.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/start.hpp"

namespace grainlaw::calibrate {
namespace {

const model::ParameterSet& set() {
  static const auto parameters = model::ParameterSet::load(GRAINLAW_DATA_DIR "/grains/w-3-memory.json");
  return parameters;
}

Record record_of(const std::string& test) {
  return Record::read_csv(GRAINLAW_DATA_DIR "/records/" + test + "/record.csv",
                          {"segment", "eps_vol", "eps_dev", "nu", "P"});
}

/// A segment of a test: the jamming densities that P next to jamming says, of grains and of the law.
struct Leg {
  std::vector<double> grains, law;
};

struct Followed {
  double error_of_P = 0;  ///< relative L2
  double end = 0;         ///< P of the law over that of the grains, less 1, at the end
  std::map<int, Leg> legs;
};

/// The law along `shear`, from the phi_J that its first P has, up to its segment `last`, and on along `then`.
Followed follow(const std::string& shear, int last, const std::string& then) {
  const auto law = model::make_law(set(), model::Form::memory);
  const auto& pressure_law = std::get<model::Memory>(law).laws.pressure;
  const model::LightLaw light(law, {1e-8, 1e-11});
  const Record first = record_of(shear), second = record_of(then);
  Path path;
  path.start.nu = first["nu"].front();
  path.start.P = first["P"].front();
  model::State state = model::start_of(set(), path, {model::Form::memory, {}}).state;
  Followed out;
  double wrong = 0, all = 0;
  const auto along = [&](const Record& record, bool compare) {
    for (std::size_t i = 1; i < record.rows() && (compare || record["segment"][i] <= last); ++i) {
      const auto status = light.update(state, std::log(record["nu"][i] / state.nu),
                                       record["eps_dev"][i] - record["eps_dev"][i - 1]);
      ASSERT_FALSE(status.failed()) << status.message;
      if (!compare) continue;
      const double nu = record["nu"][i], P = record["P"][i];
      wrong += std::pow(state.P - P, 2);
      all += P * P;
      out.end = state.P / P - 1;
      if (!(P > 2e-4 && P < 0.012)) continue;
      Leg& leg = out.legs[static_cast<int>(record["segment"][i])];
      leg.grains.push_back(model::jamming_density_from_pressure(pressure_law, nu, P).value());
      leg.law.push_back(state.phi_J);
    }
  };
  along(first, false);
  along(second, true);
  out.error_of_P = std::sqrt(wrong / all);
  return out;
}

/// Mean over the packings of the jamming density along a segment.
struct Mean {
  double grains = 0, law = 0;
};
Mean mean_of(const std::string& shear, const std::string& then, int segment) {
  Mean mean;
  for (const std::string seed : {"1", "2", "3"}) {
    const Followed one =
        follow("mixed/records/" + shear + "-s" + seed, 1, "mixed/records/" + then + "-s" + seed);
    const Leg& leg = one.legs.at(segment);
    mean.grains += median(leg.grains) / 3;
    mean.law += median(leg.law) / 3;
  }
  return mean;
}

/// Decompression leaves phi_J where steady shear had it, and so does what comes back up: it is shear that
/// takes memory and compression that gives it back.
TEST(MixedHistory, DecompressionAndDipsLeaveTheJammingDensity) {
  const Mean down = mean_of("far-0.68", "small-0.68", 0), up = mean_of("far-0.68", "small-0.68", 1),
             dipped = mean_of("far-0.68", "dip-0.68", 4);
  EXPECT_NEAR(down.grains, 0.6601, 1e-4);
  EXPECT_NEAR(up.grains, down.grains, 1e-4);
  EXPECT_LT(dipped.grains - down.grains, 6e-4);
  EXPECT_NEAR(down.law, down.grains, 4e-4);
  EXPECT_NEAR(up.law, up.grains, 6e-4);
  EXPECT_NEAR(dipped.law, dipped.grains, 6e-4);
}

/// Small compressions give back little, those beyond the density of the shear what first compressions do.
TEST(MixedHistory, CompressionGivesBackWhatShearTook) {
  for (const int unloading : {2, 4, 6}) {
    const Mean small = mean_of("far-0.68", "small-0.68", unloading);
    EXPECT_LT(small.grains, 0.6616) << unloading;
    EXPECT_NEAR(small.law, small.grains, 6e-4) << unloading;
  }
  const Mean once = mean_of("far-0.68", "large-0.68", 2), thrice = mean_of("far-0.68", "large-0.68", 6);
  EXPECT_NEAR(once.grains, 0.6652, 1e-4);  // 0.6648 without the shear before
  EXPECT_NEAR(thrice.grains, 0.6668, 1e-4);
  // The law's own first compression to 0.82 leaves 1.1e-3 less than these packings have
  // (docs/memory-data.md).
  EXPECT_NEAR(once.law, once.grains, 2e-3);
  EXPECT_NEAR(thrice.law, thrice.grains, 2e-3);
  EXPECT_GT(once.law, 0.6630);
  EXPECT_GT(thrice.law, once.law + 5e-4);
}

/// The table of docs/model.md, Volume after shear.
TEST(MixedHistory, JammingDensitiesUnloadingAfterUnloading) {
  struct Cell {
    int segment;
    double grains, law;
  };
  const std::pair<const char*, std::vector<Cell>> rows[] = {
      {"small-0.68", {{0, 0.6601, 0.6599}, {2, 0.6610, 0.6606}, {4, 0.6611, 0.6611}, {6, 0.6614, 0.6615}}},
      {"dip-0.68", {{0, 0.6600, 0.6599}, {2, 0.6603, 0.6605}, {4, 0.6606, 0.6608}}},
      {"up-0.68", {{1, 0.6634, 0.6621}, {3, 0.6646, 0.6630}, {5, 0.6649, 0.6638}}},
      {"large-0.68", {{0, 0.6601, 0.6599}, {2, 0.6652, 0.6637}, {4, 0.6664, 0.6651}, {6, 0.6668, 0.6662}}}};
  for (const auto& [test, cells] : rows)
    for (const Cell& cell : cells) {
      SCOPED_TRACE(std::string(test) + ", segment " + std::to_string(cell.segment));
      const Mean mean = mean_of("far-0.68", test, cell.segment);
      EXPECT_NEAR(mean.grains, cell.grains, 6e-5);
      EXPECT_NEAR(mean.law, cell.law, 6e-5);
    }
}

/// Relative L2 error of P, mean over the packings.
TEST(MixedHistory, TheLawFollowsThePressure) {
  const std::map<std::string, double> errors{{"small-0.68", 0.065},
                                             {"dip-0.68", 0.060},
                                             {"up-0.68", 0.020},
                                             {"large-0.68", 0.014},
                                             {"down-0.72", 0.033}};
  for (const auto& [test, error] : errors) {
    double mean = 0;
    for (const std::string seed : {"1", "2", "3"}) {
      const std::string far = "mixed/records/far-" + test.substr(test.size() - 4) + "-s" + seed;
      mean += follow(far, 1, "mixed/records/" + test + "-s" + seed).error_of_P / 3;
    }
    EXPECT_NEAR(mean, error, 0.002) << test;
  }
}

/// 9261 grains after D2 to 0.05, 0.15 and 0.4, means over two packings: compression is followed within 1.5 %;
/// at the end of a decompression P is 1, 6 and 30 % too high at nu = 0.75, 0.711 and 0.685, where it is a
/// pressure of 2e-3 next to jamming.
TEST(MixedHistory, NineThousandGrainsLikewise) {
  const auto mean = [](const std::string& way, const std::string& nu, int last, auto of) {
    static const std::vector<std::string> amounts{"0.05", "0.15", "0.4"};
    double sum = 0;
    for (const std::string seed : {"4", "5"})
      sum += of(follow("volumetric/records/d2-" + nu + "-s" + seed, last,
                       "volumetric/records/" + way + "-" + nu + "-" +
                           amounts[static_cast<std::size_t>(last)] + "-s" + seed));
    return sum / 2;
  };
  for (const auto& [nu, end] : {std::pair{"0.685", 0.30}, {"0.711", 0.06}, {"0.75", 0.01}}) {
    SCOPED_TRACE(nu);
    for (int last = 0; last < 3; ++last)
      EXPECT_LT(mean("up", nu, last, [](const Followed& f) { return f.error_of_P; }), 0.016);
    EXPECT_NEAR(mean("down", nu, 2, [](const Followed& f) { return f.end; }), end, 0.02);
    EXPECT_LT(mean("down", nu, 2, [](const Followed& f) { return f.error_of_P; }), end / 3 + 0.01);
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
