// The tables of docs/model.md, Memory, that compare the law of our own numbers (data/grains/w-3-memory.json)
// with grains: where reversals unjam, strains to jam and to jam again, shear to and fro, tiny cycles. What
// grains do stands in docs/memory-data.md.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/light/light_law.hpp"
#include "grainlaw/model/parameters.hpp"
#include "memory_fixture.hpp"

namespace grainlaw::model {
namespace {

const Law& own_law() {
  static const Law law =
      make_law(ParameterSet::load(GRAINLAW_DATA_DIR "/grains/w-3-memory.json"), Form::memory);
  return law;
}
/// An isotropic packing that jams at phi_H and has been compressed to phi_max.
State packing(double nu, double phi_H, double phi_max) {
  return isotropic(nu, phi_H, phi_max, std::get<Memory>(own_law()));
}

void shear(State& state, double eps_dev) {
  static const LightLaw light(own_law(), {1e-9, 1e-12});
  const Status status = light.update(state, 0, eps_dev);
  ASSERT_FALSE(status.failed()) << status.message;
}

/// Shears in steps of `step` until the packing is jammed or not, as asked; says the strain, the largest where
/// it does not come to that.
double strain_until(bool jammed, State& state, double step, double largest) {
  double strain = 0;
  for (; state.jammed != jammed && strain < largest; strain += std::abs(step)) shear(state, step);
  return strain;
}

bool reversal_unjams(double nu, double phi_H) {
  State state = packing(nu, phi_H, 0.82);
  shear(state, 1);
  strain_until(false, state, -1e-3, 0.3);
  return !state.jammed;
}

/// The law has no number for it. Grains after 0.82: 0.6629 +- 0.0003, and no sharp density.
TEST(MemoryTables, WhereReversalsUnjam) {
  for (const auto& [phi_H, phi_cr] : {std::pair{0.6637, 0.6628}, {0.6650, 0.6633}, {0.6660, 0.6636}}) {
    double low = 0.659, high = phi_H;
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (low + high);
      (reversal_unjams(middle, phi_H) ? low : high) = middle;
    }
    EXPECT_NEAR(low, phi_cr, 6e-5) << phi_H;
  }
}

TEST(MemoryTables, StrainsToJam) {
  struct Row {
    double nu, first, again;
  };
  for (const Row& row : {Row{0.6585, 0.138, 0.33},
                         {0.66, 0.086, 0.215},
                         {0.6615, 0.061, 0.160},
                         {0.6625, 0.046, 0.130},
                         {0.663, 0.040, 0.112}}) {
    SCOPED_TRACE(row.nu);
    State state = packing(row.nu, 0.6650, 0.82);
    EXPECT_NEAR(strain_until(true, state, 5e-4, 1), row.first, 1.1e-3);
    shear(state, 1);
    const double unjammed = strain_until(false, state, -5e-4, 0.3);
    EXPECT_NEAR(unjammed + strain_until(true, state, -5e-4, 1), row.again, 2e-3);
  }
}

/// phi_J after cycles of shear at nu = 0.68 from isotropy.
double tapped(State state, double size, int times) {
  for (int i = 0; i < times; ++i)
    for (const double step : {size, -2 * size, size}) shear(state, step);
  return state.phi_J;
}

TEST(MemoryTables, ShearToAndFro) {
  const State once = packing(0.68, 0.6597, 0.68), thrice = packing(0.68, 0.6661, 0.82);
  struct Row {
    double size;
    int times;
    double after_once, after_thrice;
  };
  for (const Row& row : {Row{0.02, 1, 0.6606, 0.6657},
                         {0.02, 3, 0.6615, 0.6659},
                         {0.02, 10, 0.6621, 0.6660},
                         {0.08, 3, 0.6634, 0.6650},
                         {0.005, 10, 0.6606, 0.6660},
                         {0.005, 50, 0.6612, 0.6661}}) {
    SCOPED_TRACE(testing::Message() << row.size << " x " << row.times);
    EXPECT_NEAR(tapped(once, row.size, row.times), row.after_once, 6e-5);
    EXPECT_NEAR(tapped(thrice, row.size, row.times), row.after_thrice, 6e-5);
  }
  for (State state : {once, thrice}) {
    shear(state, 0.3);
    EXPECT_NEAR(state.phi_J, 0.6599, 6e-5);
  }
}

/// A length of 0.1 in all of tiny cycles against steady shear takes as much of P at any size.
TEST(MemoryTables, TinyCycles) {
  State steady = packing(0.711, 0.6650, 0.82);
  shear(steady, 0.3);
  for (const double size : {1e-2, 1e-3, 1e-4}) {
    State state = steady;
    for (double length = 0; length < 0.1 - size; length += 2 * size)
      for (const double step : {-size, size}) shear(state, step);
    EXPECT_NEAR(state.P / steady.P - 1, -0.041, 1.1e-3) << size;
  }
}

}  // namespace
}  // namespace grainlaw::model
