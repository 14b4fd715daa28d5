// Why the thesis's G is smaller than ours (docs/moduli.md), by the packings in data/moduli.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "grainlaw/element/moduli_table.hpp"

namespace grainlaw {
namespace {

constexpr const char* densities[] = {"0.68", "0.705", "0.725", "0.75", "0.81"};

Record table_of(const std::string& kind, const std::string& nu, int seed) {
  return read_moduli(GRAINLAW_DATA_DIR "/moduli/" + kind + "-" + nu + "-s" + std::to_string(seed) + ".csv");
}

/// Sums over the densities and the states, by linear response, of one packing with begin < eps_dev < end.
struct ShearSums {
  double ratio = 0;                ///< of G_oct/B to the thesis's Eq. 4.14, mean
  double ratio_of_invariants = 0;  ///< the same of d sqrt(3 J2)/d eps_dev
  double G = 0, G_of_invariants = 0;
  double G_by_angle = 0;  ///< G_oct sigma_dev/sqrt(3 J2): had the stress changed along the axis alone
};

ShearSums initial_shear(int seed, double begin, double end) {
  ShearSums sum;
  double n = 0;
  for (const char* nu : densities) {
    const Record r = table_of("start", nu, seed);
    for (std::size_t k = 0; k < r.rows(); ++k) {
      if (r["amplitude"][k] != 0 || r["eps_dev"][k] < begin || r["eps_dev"][k] > end) continue;
      const double thesis = r["B"][k] * 0.51 * (1 - std::exp(-(r["F_v"][k] - 4.2) / 1.9));
      sum.ratio += r["G_oct"][k] / thesis;
      sum.ratio_of_invariants += r["G_oct_inv"][k] / thesis;
      sum.G += r["G_oct"][k];
      sum.G_of_invariants += r["G_oct_inv"][k];
      sum.G_by_angle += r["G_oct"][k] * r["sigma_dev"][k] / r["sigma_dev_inv"][k];
      n += 1;
    }
  }
  sum.ratio /= n;
  sum.ratio_of_invariants /= n;
  return sum;
}

/// Over three packings.
struct Mean {
  double value = 0, error = 0;
  double off(double other) const { return (value - other) / error; }
};

template <class OfSeed>
Mean mean_over_packings(const OfSeed& of_seed) {
  const std::array<double, 3> values{of_seed(1), of_seed(2), of_seed(3)};
  const double mean = (values[0] + values[1] + values[2]) / 3;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / 6)};
}

constexpr double isotropic_to = 0.0045;                       // eps_dev
constexpr double ruled_to = 0.0085;                           // the thesis's rule: eps_dev <= 0.008
constexpr double sheared_from = 0.0055, sheared_to = 0.0125;  // "nearly isotropic" states

/// docs/moduli.md, "Why the thesis's G is smaller": our definition lies above, by the thesis's own rule for
/// states, too.
TEST(InitialShear, AlongTheAxisLiesAboveTheThesisByItsRule) {
  const Mean isotropic =
      mean_over_packings([](int seed) { return initial_shear(seed, 0, isotropic_to).ratio; });
  EXPECT_NEAR(isotropic.value, 1.060, 5e-4);
  EXPECT_NEAR(isotropic.error, 0.008, 5e-4);
  EXPECT_GT(isotropic.off(1), 4);
  const Mean ruled = mean_over_packings([](int seed) { return initial_shear(seed, 0, ruled_to).ratio; });
  EXPECT_NEAR(ruled.value, 1.046, 5e-4);
  EXPECT_NEAR(ruled.error, 0.014, 5e-4);
  EXPECT_GT(ruled.off(1), 3);
  const Mean sheared =
      mean_over_packings([](int seed) { return initial_shear(seed, sheared_from, sheared_to).ratio; });
  EXPECT_NEAR(sheared.value, 1.029, 5e-4);
  EXPECT_NEAR(sheared.error, 0.025, 5e-4);
  EXPECT_LT(std::abs(sheared.off(1)), 2);
  const Mean change = mean_over_packings([](int seed) {
    return initial_shear(seed, sheared_from, sheared_to).ratio / initial_shear(seed, 0, isotropic_to).ratio;
  });
  EXPECT_LT(std::abs(change.off(1)), 2);  // likely, not shown
}

/// By sqrt(3 J2) G is smaller in each packing, as much as the angle between the stress and the axis says, and
/// how much depends on strain: it tends to 1 as the stress turns to the axis.
TEST(InitialShear, InvariantsMakeTheInitialShearModulusSmaller) {
  const auto lessened = [](double begin, double end) {
    return [=](int seed) {
      const ShearSums shear = initial_shear(seed, begin, end);
      EXPECT_LT(shear.G_of_invariants, shear.G) << seed;
      EXPECT_NEAR(shear.G_of_invariants / shear.G, shear.G_by_angle / shear.G, 0.025) << seed;
      return shear.G_of_invariants / shear.G;
    };
  };
  const Mean factor = mean_over_packings(lessened(sheared_from, sheared_to));
  EXPECT_NEAR(factor.value, 0.926, 5e-4);
  EXPECT_NEAR(factor.error, 0.021, 5e-4);
  const Mean early = mean_over_packings(lessened(0.003, isotropic_to)),
             late = mean_over_packings(lessened(0.0115, sheared_to));
  EXPECT_NEAR(early.value, 0.73, 5e-3);
  EXPECT_NEAR(late.value, 0.966, 5e-4);
  EXPECT_LT(early.value + 2 * early.error, late.value - 2 * late.error);
  const Mean ratio = mean_over_packings(
      [](int seed) { return initial_shear(seed, sheared_from, sheared_to).ratio_of_invariants; });
  EXPECT_NEAR(ratio.value, 0.954, 5e-4);
  EXPECT_NEAR(ratio.error, 0.017, 5e-4);
  EXPECT_LT(ratio.off(1), -2);  // below the thesis: more than it takes
}

/// G_oct by sqrt(3 J2) over G_oct along the axis in sheared states, eps_dev > 0.04, nu = 0.75.
double lessened_by_invariants_in_shear(int seed) {
  const Record r = table_of(seed == 3 ? "d2" : "late", "0.75", seed);
  double G = 0, of_invariants = 0;
  for (std::size_t k = 0; k < r.rows(); ++k) {
    if (r["amplitude"][k] != 0 || r["eps_dev"][k] < 0.04) continue;
    G += r["G_oct"][k];
    of_invariants += r["G_oct_inv"][k];
  }
  return of_invariants / G;
}

/// g_I of one packing: slope of (G/B)_ini - factor G/B over sigma_dev F_dev through the origin, of the states
/// with eps_dev > 0.04; (G/B)_ini is the mean of this column over B in the packing's "nearly isotropic"
/// states.
double slope_of_shear(int seed, const char* column, double factor) {
  double products = 0, squares = 0;
  for (const char* nu : densities) {
    const Record first = table_of("start", nu, seed), r = table_of("d2", nu, seed);
    double initial = 0, n = 0;
    for (std::size_t k = 0; k < first.rows(); ++k) {
      if (first["amplitude"][k] != 0 || first["eps_dev"][k] < sheared_from) continue;
      initial += first[column][k] / first["B"][k];
      n += 1;
    }
    for (std::size_t k = 0; k < r.rows(); ++k) {
      if (r["amplitude"][k] != 0 || r["eps_dev"][k] < 0.04 || std::isnan(r["G_oct"][k])) continue;
      const double x = r["sigma_dev"][k] * r["F_dev"][k];
      products += x * (initial / n - factor * r["G_oct"][k] / r["B"][k]);
      squares += x * x;
    }
  }
  return products / squares;
}

/// Table 4.1: g_I = 86 +- 3. Along the axis ours differs by less than its scatter where (G/B)_ini is that of
/// these states, not by the rule of the thesis; by sqrt(3 J2) it is but half of that.
TEST(InitialShear, DecreaseOfShearModulusIsTheThesisAlongTheAxisButNotByInvariants) {
  const Mean factor = mean_over_packings(lessened_by_invariants_in_shear);
  EXPECT_NEAR(factor.value, 0.9975, 5e-4);
  EXPECT_NEAR(factor.error, 0.002, 5e-4);
  const Mean axis = mean_over_packings([](int seed) { return slope_of_shear(seed, "G_oct", 1); });
  EXPECT_NEAR(axis.value, 103, 0.5);
  EXPECT_NEAR(axis.error, 16, 0.5);
  EXPECT_LT(std::abs(axis.value - 86), 2 * std::hypot(axis.error, 3));
  const Mean invariants =
      mean_over_packings([&](int seed) { return slope_of_shear(seed, "G_oct_inv", factor.value); });
  EXPECT_NEAR(invariants.value, 42, 0.5);
  EXPECT_NEAR(invariants.error, 8, 0.5);
  EXPECT_LT(invariants.value, 86 - 4 * std::hypot(invariants.error, 3));
}

}  // namespace
}  // namespace grainlaw
