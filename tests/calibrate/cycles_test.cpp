// Cycles of D2 between +-0.1 near jamming and between +-0.4 of a third packing, and of UNI through jamming
// and back. Errors of the forms with the numbers of data/grains/w-3.json, whose exponent and strain of
// Eq. 5.3 are of first loadings; what a reversal does (eps0_R_P, eps_r, phi_pack, hold) is fitted to P and
// F_dev of the small cycles here, and no number to the others.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/dem/scene/scene.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/model/predict_minimal.hpp"

namespace grainlaw::calibrate {
namespace {

/// Relative L2 errors along a test.
struct Errors {
  double P, sigma_dev, F_dev;
};

Errors errors_of(const std::string& test, const std::string& form,
                 const std::function<void(model::MemoryLaws&)>& change = {}) {
  const std::string dir = std::string(GRAINLAW_DATA_DIR "/records/") + test;
  const auto scene = dem::Scene::read(Reader(load_json(dir + "/scene.json"), dir), dir);
  const Record record = Record::read_csv(dir + "/record.csv",
                                         {"segment", "eps_vol", "eps_dev", "nu", "P", "sigma_dev", "F_dev"});
  Path path = scene.path;
  path.start.nu = record["nu"].front();
  auto parameters = model::ParameterSet::load(GRAINLAW_DATA_DIR "/grains/w-3.json");
  if (change) change(*parameters.memory);
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

/// Three cycles of +-0.1, along which P of grains sinks: a reversal gives back what shear took, denser.
TEST(SmallCycles, MemoryFollowsThePressure) {
  for (const auto& [nu, gain] : {std::pair{"0.685", 6.5}, {"0.711", 2.5}}) {
    const std::string test = std::string("small-cycles/records/d2-0.1-") + nu + "-s4";
    SCOPED_TRACE(test);
    const Errors coupled = errors_of(test, "coupled"), memory = errors_of(test, "memory");
    EXPECT_LT(memory.P, coupled.P / gain);
    EXPECT_LT(memory.P, 0.0145);
    EXPECT_LT(memory.sigma_dev, coupled.sigma_dev);
  }
}

/// Without the packed part P of the law does not sink as that of grains does.
TEST(SmallCycles, ShearToAndFroPacks) {
  for (const std::string nu : {"0.685", "0.711"}) {
    const std::string test = "small-cycles/records/d2-0.1-" + nu + "-s4";
    EXPECT_LT(
        errors_of(test, "memory").P,
        0.85 * errors_of(test, "memory", [](model::MemoryLaws& memory) { memory.pack_rate->value = 0; }).P)
        << nu;
  }
}

/// A reversal slows the fabric by more than Eq. 4.16 has it.
TEST(SmallCycles, AReversalHoldsTheFabric) {
  for (const std::string nu : {"0.685", "0.711"}) {
    const std::string test = "small-cycles/records/d2-0.1-" + nu + "-s4";
    const Errors free = errors_of(test, "memory", [](model::MemoryLaws& memory) { memory.hold.reset(); });
    EXPECT_LT(errors_of(test, "memory").F_dev, 0.8 * free.F_dev) << nu;
    EXPECT_NEAR(free.F_dev, errors_of(test, "coupled").F_dev, 1e-6) << nu;  // both are Eq. 4.16
  }
}

TEST(SmallCycles, MemoryPassesTinyOnes) {
  const std::string test = "small-cycles/records/d2-tiny-0.711-s4";
  EXPECT_LT(errors_of(test, "memory").P, errors_of(test, "coupled").P / 3);
}

TEST(UniCycles, MemoryHoldsThePressure) {
  for (const std::string seed : {"4", "5"}) {
    const std::string test = "uni-cycles/records/uni-cycles-s" + seed;
    SCOPED_TRACE(test);
    const Errors coupled = errors_of(test, "coupled"), memory = errors_of(test, "memory"),
                 minimal = errors_of(test, model::minimal_name);
    EXPECT_LT(memory.P, 0.0115);
    EXPECT_GT(coupled.P, 3 * memory.P);
    EXPECT_GT(minimal.P, 2 * memory.P);
  }
}

/// D2 between +-0.4 at nu = 0.75 of three packings that differ in nothing but their seed.
const std::vector<std::string>& packings() {
  static const std::vector<std::string> dirs{"base/records/d2-cycle-0.75-s1", "base/records/d2-cycle-0.75-s2",
                                             "third-cycle/d2-cycle-0.75-s3"};
  return dirs;
}

std::vector<double> pressure_of(const std::string& test) {
  return Record::read_csv(GRAINLAW_DATA_DIR "/records/" + test + "/record.csv", {"P"})["P"];
}

/// How far the mean of the two others is from this one, row by row.
double error_of_the_others(std::size_t packing) {
  const auto &a = pressure_of(packings()[(packing + 1) % 3]), &b = pressure_of(packings()[(packing + 2) % 3]);
  std::vector<double> mean(a.size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (a[i] + b[i]) / 2;
  return relative_distance(mean, pressure_of(packings()[packing]));
}

/// At this density P on the cycle is a packing's own: two packings foretell the third less well than the law
/// does, and neither is five times better than the coupled form.
TEST(ThirdCycle, TwoPackingsSayLessOfAThirdThanMemory) {
  double others = 0, memory = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(packings()[i]);
    const double coupled = errors_of(packings()[i], "coupled").P;
    EXPECT_GT(coupled / error_of_the_others(i), 1.5);
    EXPECT_LT(coupled / error_of_the_others(i), 2.2);
    EXPECT_LT(errors_of(packings()[i], "memory").P, 0.9 * error_of_the_others(i));
    others += error_of_the_others(i) / 3;
    memory += errors_of(packings()[i], "memory").P / 3;
  }
  EXPECT_NEAR(others, 0.0058, 1e-4);
  EXPECT_NEAR(memory, 0.0047, 1e-4);
}

/// At the other densities a packing that came after the fit: what the law foretells of it.
TEST(ThirdCycle, MemoryForetellsAPackingThatCameLater) {
  for (const auto& [nu, least_gain, most_error] :
       {std::tuple{"0.685", 6.0, 0.029}, std::tuple{"0.711", 4.8, 0.0105}}) {
    const std::string test = std::string("third-cycle/d2-cycle-") + nu + "-s3";
    SCOPED_TRACE(test);
    const Errors coupled = errors_of(test, "coupled"), memory = errors_of(test, "memory");
    EXPECT_GT(coupled.P, least_gain * memory.P);
    EXPECT_LT(memory.P, most_error);
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
