// The moduli that stand in data/moduli (docs/moduli.md).
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grainlaw/element/record.hpp"

namespace grainlaw {
namespace {

/// Slopes of A1/B and A2/B over F_dev, of the rows by linear response.
struct Slopes {
  double A1 = 0, A2 = 0;
  std::size_t states = 0;
};

Slopes slopes_of(const std::string& nu) {
  const Record r = Record::read_csv(GRAINLAW_DATA_DIR "/moduli/d2-" + nu + "-s1.csv");
  Slopes slopes;
  double squares = 0;
  for (std::size_t k = 0; k < r.rows(); ++k) {
    if (r["amplitude"][k] != 0) continue;
    const double x = r["F_dev"][k];
    slopes.A1 += x * r["A1"][k] / r["B"][k];
    slopes.A2 += x * r["A2"][k] / r["B"][k];
    squares += x * x;
    ++slopes.states;
  }
  slopes.A1 /= squares;
  slopes.A2 /= squares;
  return slopes;
}

TEST(Moduli, RatioOfA2ToA1RisesWithDensity) {
  double before = 1.5;
  for (const char* nu : {"0.68", "0.705", "0.725", "0.75", "0.81"}) {
    const Slopes slopes = slopes_of(nu);
    EXPECT_EQ(slopes.states, 21u);
    EXPECT_GT(slopes.A2 / slopes.A1, before) << nu;
    before = slopes.A2 / slopes.A1;
  }
  EXPECT_NEAR(before, 2.15, 0.01);
}

/// Where they change no contact, strains of 1e-6 measure what linear response says.
TEST(Moduli, ProbesAgreeWithLinearResponse) {
  for (const char* nu : {"0.68", "0.705", "0.725", "0.75", "0.81"}) {
    const Record r = Record::read_csv(GRAINLAW_DATA_DIR "/moduli/d2-" + std::string(nu) + "-s1.csv");
    std::size_t response = 0, elastic = 0;
    for (std::size_t k = 0; k < r.rows(); ++k) {
      if (r["amplitude"][k] == 0) response = k;
      if (r["amplitude"][k] == 0 || r["contacts_changed"][k] > 0) continue;
      ++elastic;
      for (const char* modulus : {"B", "A1", "A2", "G_oct"})
        EXPECT_NEAR(r[modulus][k], r[modulus][response], 2e-3 * r["B"][response])
            << nu << " " << modulus << " " << k;
    }
    EXPECT_GT(elastic, 20u) << nu;
  }
}

}  // namespace
}  // namespace grainlaw
