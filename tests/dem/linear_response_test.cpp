// Stiffness from the contact network: against strains that are applied, closed forms and symmetries.
#include "grainlaw/dem/stiffness/linear_response.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/symmetry_class.hpp"
#include "lattices.hpp"
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
  const double h = 1e-7;
  for (std::size_t b = 0; b < 6; ++b) {
    const Sym6 plus = stress_at(packing, b, h), minus = stress_at(packing, b, -h);
    for (std::size_t a = 0; a < 6; ++a)
      EXPECT_NEAR((plus[a] - minus[a]) / (2 * h), response.stress[a][b],
                  1e-4 * std::abs(response.stress[a][b]))
          << a << b;
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

/// Where the stress deviator lies along D2, P and sigma_dev alone decide: A1 gains -(2/9) sigma_dev, A2
/// (2/3) sigma_dev, so that A2/A1 = (3 A1 + (4/3) sigma_dev)/(2 A1 - (4/9) sigma_dev), bare A1.
TEST(LinearResponse, RatioUnderPrestressAlongTheAxis) {
  const LinearResponse response = response_of(sheared());
  const double P = trace(response.prestress) / 3, sigma_dev = deviator_along(response.prestress, d2);
  ASSERT_GT(sigma_dev, 0.01 * P);
  const Sym6 along{P - sigma_dev / std::sqrt(3.0), P + sigma_dev / std::sqrt(3.0), P, 0, 0, 0};
  const Moduli bare = moduli_of(response.energy, d2),
               whole = moduli_of(derivative_of_stress(response.energy, along), d2);
  EXPECT_NEAR(whole.A1 - bare.A1, -2.0 / 9 * sigma_dev, 1e-12 * bare.B);
  EXPECT_NEAR(whole.A2 - bare.A2, 2.0 / 3 * sigma_dev, 1e-12 * bare.B);
  EXPECT_NEAR(whole.A2 / whole.A1, (3 * bare.A1 + 4.0 / 3 * sigma_dev) / (2 * bare.A1 - 4.0 / 9 * sigma_dev),
              1e-9);
}

/// What is left of an affine network when its prestress is taken out is a sum of nnnn: all permutations of
/// indices are alike (Cauchy's relations), and the isotropic part has mu/K = 3/5, G_oct/B = 6/5.
TEST(LinearResponse, AffineNetworkWithoutPrestressHasCauchysRelations) {
  const LinearResponse response = response_of(sheared());
  const Sym6& s = response.prestress;
  Stiffness c = response.affine;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;  // yz, xz, xy
    c[k][k] += s[k];
    c[k + 3][k + 3] += 0.25 * (s[i] + s[j]);
    for (const std::size_t other : {i, j}) {
      const std::size_t shear = component(k, other);  // xx with xy: (1/2) s_xy
      c[k][shear] += 0.5 * s[shear];
      c[shear][k] += 0.5 * s[shear];
    }
    for (const std::size_t other : {i, j}) c[k + 3][other + 3] += 0.25 * s[component(k, other)];
  }
  const double error = 1e-10 * c[0][0];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    EXPECT_NEAR(c[i][j], c[k + 3][k + 3], error);                          // C_yyzz = C_yzyz
    EXPECT_NEAR(c[k][k + 3], c[component(k, i)][component(k, j)], error);  // C_xxyz = C_xyxz
    EXPECT_NEAR(c[k][component(k, i)], c[component(k, i)][k], error);
  }
  const Moduli moduli = moduli_of(isotropic_part(c), d2);
  EXPECT_NEAR(moduli.G_oct, 1.2 * moduli.B, error);
}

TEST(LinearResponse, FaceCentredCubicLatticeHasItsClosedForm) {
  const double d = 1.9, k = 1e5, f = k * (2 - d), root = std::sqrt(2.0);
  StaticPacking packing(Material{}, test::fcc(d, 3));
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

/// About any axis, with the box tilted.
TEST(LinearResponse, TurnsWithTheFrame) {
  const StaticPacking packing = sheared();
  const Mat3 turn = test::rotation({1, 2, 3}, 0.7);
  State turned = packing.state();
  for (Vec3& x : turned.position) x = turn * x;
  turned.box = turn * turned.box;
  const LinearResponse before = response_of(packing), after = response_of(StaticPacking(Material{}, turned));
  const Rotation rotation{turn.row(0), turn.row(1), turn.row(2)};
  const double size = grainlaw::norm(before.energy);
  for (const auto& [from, to] : {std::pair{before.energy, after.energy},
                                 {before.stress, after.stress},
                                 {before.affine, after.affine}}) {
    const Stiffness expected = rotated(from, rotation);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) EXPECT_NEAR(to[a][b], expected[a][b], 1e-9 * size) << a << b;
  }
  const Sym6 left = eigenvalues(before.energy), right = eigenvalues(after.energy);
  for (std::size_t a = 0; a < 6; ++a) EXPECT_NEAR(left[a], right[a], 1e-9 * size);
}

/// Spheres that touch along three axes: C_xxxx = k/d, and nothing resists shear. Under load the shear
/// stiffness is what the prestress makes of it, -f/(2 d^2): less than none.
TEST(LinearResponse, SimpleCubicLatticeHasItsClosedFormAndNoShearStiffness) {
  const double k = 1e5;
  for (const double d : {2.0, 1.9}) {
    StaticPacking packing(Material{}, test::simple_cubic(d, 5));
    const LinearResponse response = linear_response(packing);
    EXPECT_EQ(response.contacts, 3 * packing.count());
    const double c44 = -k * (2 - d) / (2 * d * d);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b)
        EXPECT_NEAR(response.energy[a][b], a != b ? 0 : a < 3 ? k / d : c44, 1e-9 * k) << a << b;
    EXPECT_NEAR(eigenvalues(response.energy)[2], 2 * c44, 1e-9 * k);
    EXPECT_NEAR(eigenvalues(response.energy)[3], k / d, 1e-9 * k);
  }
}

TEST(LinearResponse, HasNoneBelowIsostatic) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 60, 3, 0.62));
  packing.find_contacts();
  ASSERT_GT(packing.backbone().grains(), 0u);
  ASSERT_LT(packing.backbone().contacts(), packing.backbone().isostatic());
  try {
    linear_response(packing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("isostatic"));
  }
}

TEST(LinearResponse, HasNoneWhereNothingBearsLoad) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 50, 3, 0.3));
  ASSERT_EQ(minimise(packing).outcome, Outcome::unjammed);
  EXPECT_THROW(linear_response(packing), Error);
}

}  // namespace
}  // namespace grainlaw::dem
