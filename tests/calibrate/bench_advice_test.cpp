// What bench dem recommends, in words: the value for each wanted error, its cost, and what was excused.
#include "grainlaw/calibrate/bench_advice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace grainlaw::calibrate {
namespace {

BenchError line(double rate, const std::string& quantity, double error, double band, double core_s,
                bool finest = false) {
  BenchError e{};
  e.knob = Knob::rate;
  e.test = BenchTest::d2;
  e.value = rate;
  e.quantity = quantity;
  e.particle_steps = 1 / rate;
  e.core_s = core_s;
  e.comparison = {error, band, 0};
  e.packings = std::nan("");
  e.finest = finest;
  return e;
}

TEST(BenchAdvice, NamesTheValueForEachErrorItsCostAndWhatIsExcused) {
  std::vector<BenchError> errors{line(3, "P", 0.0045, 0, 1.5),  line(3, "F_dev", 0.08, 0.045, 1.5),
                                 line(1, "P", 0.0023, 0, 4),    line(1, "F_dev", 0.002, 0.045, 4),
                                 line(0.3, "P", 0.0009, 0, 12), line(0.3, "F_dev", 0.05, 0.045, 12),
                                 line(0.1, "P", 0, 0, 35, true)};
  EXPECT_EQ(bench_advice(errors),
            "cheapest setting for a wanted error of means over many tests, and what it takes of a core:\n"
            "  rate      0.1 %   x 0.3, 12 s; F_dev of d2 by 5 %, within what chance makes\n"
            "  rate      0.25 %  x 1, 4 s\n"
            "  rate      0.5 %   x 3, 1.5 s; F_dev of d2 by 8 %, within what chance makes\n"
            "  rate      1 %     x 3, 1.5 s; F_dev of d2 by 8 %, within what chance makes");
  for (BenchError& e : errors) e.packings = 0.1;
  EXPECT_THAT(bench_advice(errors),
              testing::StartsWith(
                  "cheapest setting for a wanted error of one test, and what it takes of a core:\n"
                  "  rate      0.1 %   x 3, 1.5 s; F_dev of d2 by 8 %, within what packings differ\n"));
}

}  // namespace
}  // namespace grainlaw::calibrate
