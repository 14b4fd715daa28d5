#include "grainlaw/dem/balance/minimise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "grainlaw/dem/balance/newton_krylov.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

MinimiseOptions with(Minimiser method, double residual) {
  MinimiseOptions options;
  options.method = method;
  options.residual = residual;
  return options;
}

State balanced(std::int64_t count, std::uint64_t seed, double nu) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, count, seed, nu));
  EXPECT_TRUE(minimise(packing, with(Minimiser::fire, 1e-11)).converged());
  return packing.state();
}

/// Every grain moved by `size` in a random direction.
State shaken(State state, double size, std::uint64_t seed) {
  Random random(seed);
  for (auto& x : state.position)
    for (double& component : x) component += size * random.normal();
  return state;
}

class Minimise : public testing::TestWithParam<Minimiser> {
 protected:
  static Minimiser method() { return GetParam(); }
};

TEST_P(Minimise, BringsAJammedPackingIntoBalance) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 2, 0.74));
  const MinimiseResult result = minimise(packing, with(method(), 1e-10));
  EXPECT_EQ(result.outcome, Outcome::balanced) << result.text();
  EXPECT_LE(result.balance.residual, 1e-10);
  EXPECT_GT(packing.backbone().grains(), 150u);
  // Net and mean force again, from all pairs through all images of the state that is handed on.
  const State state = packing.state();
  std::vector<Vec3> net(state.count(), Vec3{});
  double mean = 0, energy = 0;
  for (const auto& [i, j, overlap] : test::brute_force(state)) {
    const double f = 1e5 * overlap;
    mean += f;
    energy += 0.5 * f * overlap;
    const Cell cell(state.box);
    Vec3 l{};
    for (std::size_t c = 0; c < 3; ++c) l[c] = state.position[i][c] - state.position[j][c];
    l = cell.nearest_image(l);
    for (std::size_t c = 0; c < 3; ++c) {
      net[i][c] += f * l[c] / norm(l);
      net[j][c] -= f * l[c] / norm(l);
    }
  }
  mean /= static_cast<double>(packing.network().count);
  for (const Vec3& f : net) EXPECT_LT(norm(f), 2e-10 * mean);
  EXPECT_NEAR(result.energy, energy, 1e-10 * energy);
}

TEST_P(Minimise, StressIsTheDerivativeOfTheMinimalEnergy) {
  const State rest = balanced(200, 3, 0.76);
  StaticPacking packing(Material{}, rest);
  const Sym6 stress = packing.measure().stress;
  const double h = 1e-6;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double difference = 0;
    for (const double side : {1.0, -1.0}) {
      StaticPacking strained(Material{}, rest);
      Vec3 length = rest.box.diagonal();
      length[axis] *= std::exp(-side * h);
      strained.deform(Mat3::diagonal(length));
      const MinimiseResult result = minimise(strained, with(method(), 1e-9));
      ASSERT_TRUE(result.converged()) << result.text();
      difference += side * result.energy;
    }
    EXPECT_NEAR(difference / (2 * h * packing.cell().volume()), stress[axis], 1e-6 * stress[axis]);
  }
}

TEST_P(Minimise, ComesBackToTheSameMinimum) {
  const State rest = balanced(200, 4, 0.76);
  StaticPacking before(Material{}, rest);
  before.find_contacts();
  StaticPacking packing(Material{}, shaken(rest, 1e-5, 7));
  const MinimiseResult result = minimise(packing, with(method(), 1e-10));
  EXPECT_TRUE(result.converged()) << result.text();
  EXPECT_NEAR(result.energy, before.network().energy, 1e-11 * result.energy);
}

TEST_P(Minimise, TwoGrainsPartAndThatIsNoBalanceOfForces) {
  State state = test::two_grains(1, 0.5, 0);
  state.position[0][1] += 0.05;
  StaticPacking packing(Material{}, state);
  const MinimiseResult result = minimise(packing, with(method(), 1e-8));
  EXPECT_EQ(result.outcome, Outcome::unjammed) << result.text();
  EXPECT_LE(result.energy, 2 * 0.5 * 1e5 * 1e-18);
  const State end = packing.state();
  const Vec3 apart{end.position[0][0] - end.position[1][0], end.position[0][1] - end.position[1][1],
                   end.position[0][2] - end.position[1][2]};
  EXPECT_GE(norm(apart), 1.5 - 2e-9);
}

TEST_P(Minimise, ACrystalFindsItsLattice) {
  const double tightness = 0.97, overlap = 2 * (1 - tightness);
  StaticPacking packing(Material{}, shaken(test::crystal(tightness, 0), 5e-3, 5));
  const MinimiseResult result = minimise(packing, with(method(), 1e-10));
  EXPECT_TRUE(result.converged()) << result.text();
  EXPECT_EQ(packing.network().count, 192u);
  EXPECT_NEAR(result.energy, 192 * 0.5 * 1e5 * overlap * overlap, 1e-9 * result.energy);
  EXPECT_NEAR(result.balance.mean_force, 1e5 * overlap, 1e-7);
}

TEST_P(Minimise, AnUnjammedPackingEndsWithoutEnergyAndSaysSo) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 5, 0.5));
  packing.find_contacts();
  EXPECT_GT(packing.network().energy, 1);
  const MinimiseResult result = minimise(packing, with(method(), 1e-8));
  EXPECT_EQ(result.outcome, Outcome::unjammed) << result.text();
  EXPECT_TRUE(result.converged());
  EXPECT_FALSE(result.balance.jammed);
  EXPECT_LT(result.energy, 1e-9);
  EXPECT_THAT(result.text(), testing::HasSubstr("no grain bears load"));
}

TEST_P(Minimise, SaysThatItGaveUp) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 2, 0.74));
  MinimiseOptions options = with(method(), 1e-10);
  options.most_passes = 100;
  const MinimiseResult result = minimise(packing, options);
  EXPECT_EQ(result.outcome, Outcome::gave_up);
  EXPECT_FALSE(result.converged());
  EXPECT_THAT(result.text(), testing::StartsWith("not in balance after "));
  StaticPacking again(Material{}, packing.state());
  again.find_contacts();
  EXPECT_NEAR(result.balance.residual, again.balance().residual, 1e-9);
  EXPECT_GT(result.balance.residual, 1e-10);
}

TEST_P(Minimise, SaysThatRoundingIsInTheWay) {
  StaticPacking packing(Material{}, balanced(200, 3, 0.76));
  const MinimiseResult result = minimise(packing, with(method(), 1e-18));
  EXPECT_EQ(result.outcome, Outcome::rounding) << result.text();
  EXPECT_FALSE(result.converged());
  EXPECT_LT(result.balance.residual, 1e-11);
}

TEST_P(Minimise, LeavesRattlersWithoutForce) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 300, 6, 0.68));
  const MinimiseResult result = minimise(packing, with(method(), 1e-9));
  ASSERT_EQ(result.outcome, Outcome::balanced) << result.text();
  EXPECT_LT(packing.backbone().grains(), 295u);
  const ContactNetwork& network = packing.network();
  for (std::size_t c = 0; c < network.count; ++c)
    if (!packing.backbone().joins(network, c)) {
      EXPECT_LT(network.force[c], 1e-6 * result.balance.mean_force) << c;
    }
}

TEST_P(Minimise, IsTheSameToTheLastBitEachTime) {
  const auto run = [] {
    StaticPacking packing(Material{}, test::squeezed(Material{}, 150, 9, 0.72));
    minimise(packing, with(method(), 1e-8));
    return packing.state();
  };
  EXPECT_EQ(run(), run());
}

TEST_P(Minimise, MeasurementsBelongToThePlacesItLeaves) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 150, 9, 0.72));
  const MinimiseResult result = minimise(packing, with(method(), 1e-8));
  const StaticPacking again(Material{}, packing.state());
  const Measurement now = packing.measure(), fresh = again.measure();
  EXPECT_EQ(now.contacts, fresh.contacts);
  EXPECT_EQ(now.kinetic, 0);
  EXPECT_NEAR(now.elastic, result.energy, 1e-12 * result.energy);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(now.stress[c], fresh.stress[c], 1e-11 * now.stress[0]);
}

INSTANTIATE_TEST_SUITE_P(Methods, Minimise, testing::Values(Minimiser::fire, Minimiser::newton_krylov),
                         [](const auto& instance) {
                           return std::string(instance.param == Minimiser::fire ? "fire" : "newton_krylov");
                         });

TEST(NewtonKrylov, EnergyNeverRises) {
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 2, 0.74));
  packing.find_contacts();
  NewtonKrylov newton(packing);
  double before = packing.network().energy;
  int rough = 0;
  for (int n = 0; n < 60; ++n) {
    newton.step(1e-9);
    EXPECT_LE(packing.network().energy, before * (1 + 1e-13)) << n;
    before = packing.network().energy;
    rough += newton.smooth() ? 0 : 1;
  }
  EXPECT_GT(rough, 3);  // grains did rearrange on the way
}

TEST(NewtonKrylov, NeedsFewStepsNearAMinimum) {
  StaticPacking packing(Material{}, shaken(balanced(200, 4, 0.8), 1e-7, 7));
  const MinimiseResult result = minimise(packing, with(Minimiser::newton_krylov, 1e-10));
  EXPECT_TRUE(result.converged());
  EXPECT_LE(result.iterations, 8u);
}

}  // namespace
}  // namespace grainlaw::dem
