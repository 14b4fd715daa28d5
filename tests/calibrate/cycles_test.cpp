// Cycles that no fit has read: D2 between +-0.1 near jamming, and UNI through jamming and back, the mixed
// test of memory. Errors of the forms with the numbers of data/grains/w-3.json.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/dem/scene.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/predict_minimal.hpp"

namespace grainlaw::calibrate {
namespace {

/// Relative L2 errors along a test.
struct Errors {
  double P, sigma_dev, F_dev;
};

Errors errors_of(const std::string& test, const std::string& form, bool holds = true) {
  const std::string dir = std::string(GRAINLAW_DATA_DIR "/records/") + test;
  const auto scene = dem::Scene::read(Reader(load_json(dir + "/scene.json"), dir), dir);
  const Record record = Record::read_csv(dir + "/record.csv",
                                         {"segment", "eps_vol", "eps_dev", "nu", "P", "sigma_dev", "F_dev"});
  Path path = scene.path;
  path.start.nu = record["nu"].front();
  auto parameters = model::ParameterSet::load(GRAINLAW_DATA_DIR "/grains/w-3.json");
  if (!holds) parameters.memory->hold.reset();
  const auto samples = model::samples_of(record, path, *path.start.nu);
  const auto predicted = form == model::minimal_name
                             ? model::predict_minimal(parameters, path, samples)
                             : model::predict(parameters, path, samples, {model::form_of(form)});
  EXPECT_FALSE(predicted.status.failed()) << predicted.status.message;
  const auto error = [&](const char* column) {
    return relative_distance(predicted.record[column], record[column]);
  };
  return {error("P"), error("sigma_dev"), error("F_dev")};
}

/// On a test, with the memory holding the fabric (held) and not (free).
void expect_held_is_best(const std::string& test, double gain_of_P) {
  SCOPED_TRACE(test);
  const Errors coupled = errors_of(test, "coupled"), free = errors_of(test, "memory", false),
               held = errors_of(test, "memory");
  EXPECT_LT(held.P, gain_of_P * coupled.P);
  EXPECT_LT(held.P, 0.88 * free.P);
  EXPECT_LT(held.F_dev, 0.78 * free.F_dev);
  EXPECT_NEAR(free.F_dev, coupled.F_dev, 1e-6);  // both are Eq. 4.16
  EXPECT_LT(held.sigma_dev, coupled.sigma_dev);
}

TEST(SmallCycles, WhatIsRememberedHoldsTheFabric) {
  expect_held_is_best("small-cycles/records/d2-0.1-0.685-s4", 0.77);
  expect_held_is_best("small-cycles/records/d2-0.1-0.711-s4", 0.95);
}

TEST(SmallCycles, MemoryPassesTinyOnes) {
  const std::string test = "small-cycles/records/d2-tiny-0.711-s4";
  EXPECT_LT(errors_of(test, "memory").P, errors_of(test, "coupled").P / 2);
}

TEST(UniCycles, MemoryHoldsThePressure) {
  for (const std::string seed : {"4", "5"}) {
    const std::string test = "uni-cycles/records/uni-cycles-s" + seed;
    SCOPED_TRACE(test);
    const Errors coupled = errors_of(test, "coupled"), memory = errors_of(test, "memory"),
                 minimal = errors_of(test, model::minimal_name);
    EXPECT_LT(memory.P, 0.02);
    EXPECT_GT(coupled.P, 2 * memory.P);
    EXPECT_GT(minimal.P, 2 * memory.P);
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
