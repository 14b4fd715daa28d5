// Stiffness from the contact network: against strains that are applied, closed forms and symmetries.
#include "grainlaw/dem/linear_response.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grainlaw/dem/minimise.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

constexpr Sym6 d2{-1, 1, 0, 0, 0, 0}, d3{-0.5, -0.5, 1, 0, 0, 0};

StaticPacking in_balance(const State& state, double residual = 1e-12) {
  StaticPacking packing(Material{}, state);
  MinimiseOptions options;
  options.residual = residual;
  const auto outcome = minimise(packing, options).outcome;
  EXPECT_TRUE(outcome == Outcome::balanced || outcome == Outcome::rounding);
  return packing;
}

/// Sheared, so that stress and fabric have a direction, and back in balance.
StaticPacking sheared() {
  StaticPacking packing = in_balance(test::squeezed(Material{}, 200, 3, 0.75));
  const Mat3 edges = packing.cell().edges();
  for (int n = 1; n <= 20; ++n) {
    packing.deform(Mat3::diagonal({std::exp(2e-3 * n), std::exp(-2e-3 * n), 1}) * edges);
    minimise(packing, {});
  }
  return in_balance(packing.state());
}

LinearResponse response_of(StaticPacking packing) {
  LinearResponseOptions options;
  options.residual = 1e-9;
  return linear_response(packing, options);
}

Sym6 stress_at(const StaticPacking& start, std::size_t component, double size) {
  Sym6 strain{};
  strain[component] = component < 3 ? size : 0.5 * size;
  StaticPacking packing = start;
  packing.deform((Mat3::identity() + -1.0 * matrix_of(strain)) * packing.cell().edges());
  MinimiseOptions options;
  options.residual = 1e-13;
  minimise(packing, options);
  return packing.measure().stress;
}

TEST(LinearResponse, IsTheDerivativeOfTheStressOfBalancedPackings) {
  const StaticPacking packing = sheared();
  const LinearResponse response = response_of(packing);
  EXPECT_EQ(response.unstable, 0);
  double largest = 0;
  for (const Sym6& row : response.stress)
    for (const double c : row) largest = std::max(largest, std::abs(c));
  const double h = 1e-7;
  for (std::size_t b = 0; b < 6; ++b) {
    const Sym6 plus = stress_at(packing, b, h), minus = stress_at(packing, b, -h);
    for (std::size_t a = 0; a < 6; ++a)
      EXPECT_NEAR((plus[a] - minus[a]) / (2 * h), response.stress[a][b], 1e-5 * largest) << a << b;
  }
}

TEST(LinearResponse, PrestressIsTheStressOfTheBackbone) {
  const StaticPacking packing = sheared();
  const Sym6 sigma = packing.measure().stress, prestress = response_of(packing).prestress;
  for (std::size_t a = 0; a < 6; ++a) EXPECT_NEAR(prestress[a], sigma[a], 1e-10 * trace(sigma));
}

TEST(LinearResponse, FreedomSoftensAndTheEnergyIsSymmetric) {
  const LinearResponse response = response_of(sheared());
  const Moduli free = moduli_of(response.energy, d2), held = moduli_of(response.affine, d2);
  EXPECT_LT(free.B, held.B);
  EXPECT_LT(free.G_oct, held.G_oct);
  EXPECT_GT(free.G_oct, 0);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) EXPECT_EQ(response.energy[a][b], response.energy[b][a]);
}

/// Only 2/3 of sigma_dev does work on eps_dev, so that bare A2/A1 = 3/2; prestress adds to each what follows
/// from its direction.
TEST(LinearResponse, RatioOfA2ToA1) {
  const LinearResponse response = response_of(sheared());
  for (const Sym6& axis : {d2, d3}) {
    const Moduli bare = moduli_of(response.energy, axis), whole = moduli_of(response.stress, axis);
    EXPECT_NEAR(bare.A2, 1.5 * bare.A1, 1e-12 * bare.B);
    EXPECT_NEAR(whole.B - bare.B, 2.0 / 3 * trace(response.prestress) / 3, 1e-10 * bare.B);
  }
  const Sym6& s = response.prestress;
  const Moduli bare = moduli_of(response.energy, d2), whole = moduli_of(response.stress, d2);
  EXPECT_NEAR(whole.A1 - bare.A1, (s[0] - s[1]) / (3 * std::sqrt(3.0)), 1e-10 * bare.B);
  EXPECT_NEAR(whole.G_oct - bare.G_oct, -(s[0] + s[1]) / 2, 1e-10 * bare.B);
}

/// Equal spheres at a distance d, d < 2 r, in cubes of edge a = sqrt(2) d.
State fcc(double d, int cubes) {
  State state;
  const double a = std::sqrt(2.0) * d;
  state.box = a * cubes * Mat3::identity();
  for (int x = 0; x < cubes; ++x)
    for (int y = 0; y < cubes; ++y)
      for (int z = 0; z < cubes; ++z)
        for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0}, Vec3{0.5, 0, 0.5}, Vec3{0, 0.5, 0.5}})
          state.position.push_back({a * (x + p[0]), a * (y + p[1]), a * (z + p[2])});
  state.velocity.resize(state.position.size());
  state.radius.assign(state.position.size(), 1.0);
  return state;
}

TEST(LinearResponse, FaceCentredCubicLatticeHasItsClosedForm) {
  const double d = 1.9, k = 1e5, f = k * (2 - d), root = std::sqrt(2.0);
  StaticPacking packing(Material{}, fcc(d, 3));
  const LinearResponse response = linear_response(packing);
  EXPECT_EQ(response.contacts, 6 * packing.count());
  const double c11 = root / d * (k - f / d), c12 = (k + f / d) / (root * d), c44 = (k - f / d) / (root * d);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) {
      const double expected = a != b ? (a < 3 && b < 3 ? c12 : 0) : a < 3 ? c11 : c44;
      EXPECT_NEAR(response.energy[a][b], expected, 1e-9 * k) << a << b;
    }
}

TEST(LinearResponse, TurnsWithTheAxes) {
  const StaticPacking packing = sheared();
  State turned = packing.state();  // x -> y -> z -> x
  const auto turn = [](const Vec3& v) { return Vec3{v[2], v[0], v[1]}; };
  for (Vec3& x : turned.position) x = turn(x);
  turned.box = Mat3::diagonal(turn(turned.box.diagonal()));
  const Stiffness before = response_of(packing).stress,
                  after = response_of(StaticPacking(Material{}, turned)).stress;
  constexpr std::array<std::size_t, 6> from{2, 0, 1, 5, 3, 4};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b)
      EXPECT_NEAR(after[a][b], before[from[a]][from[b]], 1e-9 * before[0][0]) << a << b;
}

TEST(LinearResponse, HasNoneWhereNothingBearsLoad) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 50, 3, 0.3));
  ASSERT_EQ(minimise(packing).outcome, Outcome::unjammed);
  EXPECT_THROW(linear_response(packing), Error);
}

}  // namespace
}  // namespace grainlaw::dem
