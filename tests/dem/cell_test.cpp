// The box: its lattice against brute force, and packings in tilted boxes against the same packings told
// otherwise.
#include "grainlaw/dem/packing/cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "grainlaw/dem/drive/drive.hpp"
#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

Mat3 simple_shear(double gamma) { return {{1, gamma, 0}, {0, 1, 0}, {0, 0, 1}}; }

/// A box of edges about 5 that is sheared in all planes, by up to `tilt`.
Mat3 sheared_box(Random& random, double tilt) {
  const Mat3 x{{1, tilt * (2 * random.uniform() - 1), tilt * (2 * random.uniform() - 1)},
               {0, 1, tilt * (2 * random.uniform() - 1)},
               {0, 0, 1}};
  return x * (Mat3::diagonal({4, 5, 6}) + test::random_matrix(random, 1));
}

/// All lattice vectors up to so many of the reduced edges away, without zero.
std::vector<Vec3> lattice(const Cell& cell, int most) {
  std::vector<Vec3> list;
  const Mat3 edges = cell.edges() * cell.basis();
  for (int a = -most; a <= most; ++a)
    for (int b = -most; b <= most; ++b)
      for (int c = -most; c <= most; ++c)
        if (a != 0 || b != 0 || c != 0)
          list.push_back(edges *
                         Vec3{static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)});
  return list;
}

TEST(Cell, ReducedEdgesAreTheShortestOfTheSameLattice) {
  Random random(4);
  for (const double tilt : {0.3, 1.0, 3.0, 30.0})
    for (int k = 0; k < 20; ++k) {
      const Cell cell(sheared_box(random, tilt));
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(cell.basis()(r, c), std::round(cell.basis()(r, c)));
      EXPECT_NEAR(determinant(cell.basis()), 1, 1e-6);
      const Mat3 reduced = cell.edges() * cell.basis();
      Vec3 edge;
      for (std::size_t c = 0; c < 3; ++c) edge[c] = norm(reduced.column(c));
      double shortest = 1e9;
      for (const Vec3& x : lattice(cell, 4)) shortest = std::min(shortest, norm(x));
      EXPECT_NEAR(std::min({edge[0], edge[1], edge[2]}), shortest, 1e-8 * shortest);
      EXPECT_LE(cell.narrowest(), shortest * (1 + 1e-9));  // no grain is nearer to its own image
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_GE(cell.heights()[c], edge[c] / std::numbers::sqrt2 * (1 - 1e-8));
        const Vec3 a = reduced.column((c + 1) % 3), b = reduced.column((c + 2) % 3);
        const Vec3 normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        EXPECT_NEAR(cell.heights()[c], cell.volume() / norm(normal), 1e-9);
      }
    }
}

TEST(Cell, SimpleShearReturnsToTheCube) {
  Cell cell(Mat3::diagonal({6, 6, 6}));
  cell = cell.moved(simple_shear(2) * cell.edges(), {});
  EXPECT_TRUE(cell.tilted());
  EXPECT_NEAR(cell.narrowest(), 6 / std::sqrt(5.0), 1e-12);  // before it is reduced
  cell.reduce();
  EXPECT_EQ(cell.basis(), simple_shear(-2));
  EXPECT_NEAR(cell.narrowest(), 6, 1e-12);
  cell = cell.moved(Mat3::diagonal({6, 6, 6}), {});
  EXPECT_TRUE(cell.tilted());  // its images still are
  cell.reduce();
  EXPECT_FALSE(cell.tilted());
}

TEST(Cell, WrapsIntoTheReducedBox) {
  Random random(5);
  for (int k = 0; k < 50; ++k) {
    const Cell cell(sheared_box(random, 2));
    Vec3 x;
    for (double& component : x) component = 60 * random.uniform() - 30;
    const Vec3 inside = cell.wrap(x), part = cell.fractions(inside);
    const Vec3 away = inverse(cell.edges()) * Vec3{x[0] - inside[0], x[1] - inside[1], x[2] - inside[2]};
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GE(part[c], -1e-13);
      EXPECT_LT(part[c], 1 + 1e-13);
      EXPECT_NEAR(away[c], std::round(away[c]), 1e-11);
    }
  }
}

TEST(Cell, NearestImageIsTheNearest) {
  Random random(6);
  for (int k = 0; k < 50; ++k) {
    const Cell cell(sheared_box(random, 2));
    Vec3 d;
    for (double& component : d) component = 20 * random.uniform() - 10;
    const Vec3 nearest = cell.nearest_image(d);
    double least = norm(cell.wrap(d));
    for (const Vec3& x : lattice(cell, 3)) {
      const Vec3 inside = cell.wrap(d);
      least = std::min(least, norm({inside[0] - x[0], inside[1] - x[1], inside[2] - x[2]}));
    }
    EXPECT_NEAR(norm(nearest), least, 1e-11);
  }
}

TEST(Cell, StrainIsLogarithmic) {
  const Cell cube(Mat3::diagonal({6, 6, 6}));
  const Sym6 axes = Cell(Mat3::diagonal({3, 12, 6})).strain_from(cube.edges());
  EXPECT_DOUBLE_EQ(axes[0], std::log(2));
  EXPECT_DOUBLE_EQ(axes[1], -std::log(2));
  // Simple shear: stretches e^(+-asinh(gamma/2)) along axes that turn.
  const Sym6 shear = cube.moved(simple_shear(2) * cube.edges(), {}).strain_from(cube.edges());
  EXPECT_NEAR(trace(shear), 0, 1e-14);
  EXPECT_NEAR(deviator_magnitude(shear), std::sqrt(3.0) * std::asinh(1), 1e-13);
  EXPECT_LT(shear[5], 0);  // extends along (1, 1, 0)
  EXPECT_LT(shear[0], 0);
  // A turned box is not strained.
  const Mat3 turn = test::rotation({1, 2, 3}, 0.7);
  for (const double e : cube.moved(turn * cube.edges(), {}).strain_from(cube.edges()))
    EXPECT_NEAR(e, 0, 1e-15);
}

TEST(Cell, LeastStretchIsABound) {
  Random random(7);
  for (int k = 0; k < 200; ++k) {
    const Mat3 f = Mat3::identity() + test::random_matrix(random, 0.1);
    const Vec3 squares = spectrum(transposed(f) * f).value;
    const double least = std::sqrt(std::min({squares[0], squares[1], squares[2]}));
    EXPECT_LE(least_stretch(f), least);
    EXPECT_GE(least_stretch(f), 0.6);  // or the list would never live
  }
  EXPECT_NEAR(least_stretch(simple_shear(1e-3)), std::exp(-std::asinh(0.5e-3)), 1e-6);
  EXPECT_NEAR(least_stretch(test::rotation({1, 2, 3}, 0.7)), 1, 1e-15);
}

TEST(Cell, RefusesEdgesThatSpanNoBox) {
  EXPECT_THROW(Cell(Mat3({1, 1, 0}, {1, 1, 0}, {0, 0, 1})), Error);
  EXPECT_THROW(Cell(Mat3({0, 1, 0}, {1, 0, 0}, {0, 0, 1})), Error);  // left-handed
}

/// The same packing, with other edges of the same lattice as its box.
State with_edges(State state, const Mat3& basis) {
  state.box = state.box * basis;
  return state;
}

void expect_near(const Sym6& is, const Sym6& should, double tolerance) {
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(is[c], should[c], tolerance * std::abs(should[0])) << c;
}

/// Steps of a flow with a constant velocity gradient that begins at this state.
Dynamics flown(const Material& m, const State& state, const Mat3& gradient, int steps) {
  Dynamics dynamics(m, state);
  const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.05);
  dynamics.start_flow(dt, gradient);
  for (int n = 1; n <= steps; ++n) dynamics.step(test::deformation(gradient, n * dt) * state.box, gradient);
  return dynamics;
}

const Mat3 d2_flow = Mat3::diagonal({1e-3, -1e-3, 0});

TEST(TiltedCell, OtherEdgesOfTheSameLatticeGiveTheSameForces) {
  const Material m;
  const State state = test::squeezed(m, 100, 31, 0.75);
  const State twin = with_edges(state, {{1, 2, -3}, {0, 1, 1}, {0, 0, 1}});
  ASSERT_FALSE(Dynamics(m, state).cell().tilted());
  ASSERT_TRUE(Dynamics(m, twin).cell().tilted());
  const Dynamics a = flown(m, state, d2_flow, 1), b = flown(m, twin, d2_flow, 1);
  const auto contacts = test::listed(a), same = test::listed(b);
  ASSERT_EQ(contacts.size(), same.size());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    EXPECT_NEAR(std::get<2>(contacts[c]), std::get<2>(same[c]), 1e-13);
  std::vector<Vec3> force(state.count());
  for (std::size_t i = 0; i < state.count(); ++i) {
    const Quad& f = a.grains().force[i];
    force[a.grains().id[i]] = {f.x, f.y, f.z};
  }
  for (std::size_t i = 0; i < state.count(); ++i) {
    const Quad& f = b.grains().force[i];
    const Vec3& should = force[b.grains().id[i]];
    EXPECT_NEAR(f.x, should[0], 1e-7);  // of forces of order 1e4
    EXPECT_NEAR(f.y, should[1], 1e-7);
    EXPECT_NEAR(f.z, should[2], 1e-7);
  }
  expect_near(b.measure().stress, a.measure().stress, 1e-12);
}

TEST(TiltedCell, ATurnedPackingHasTheTurnedStress) {
  const Material m;
  const State state = test::squeezed(m, 100, 32, 0.75);
  const Mat3 turn = test::rotation({0, 0, 1}, std::numbers::pi / 4);
  const Measurement here = Dynamics(m, state).measure();
  const Measurement there = Dynamics(m, test::turned(state, turn)).measure();
  expect_near(there.stress, test::turned(here.stress, turn), 1e-12);
  expect_near(there.kinetic_stress, test::turned(here.kinetic_stress, turn), 1e-12);
  expect_near(there.fabric, test::turned(here.fabric, turn), 1e-12);
  EXPECT_EQ(there.contacts, here.contacts);
  EXPECT_NEAR(there.nu, here.nu, 1e-14);
}

TEST(TiltedCell, D2IsPureShearInAFrameTurnedBy45Degrees) {
  // The whole motion, with viscous forces, m G v and lists: the orthorhombic and the tilted kernels.
  const Material m;
  const State state = test::squeezed(m, 100, 33, 0.75);
  const Mat3 turn = test::rotation({0, 0, 1}, std::numbers::pi / 4);
  const Mat3 shear = turn * d2_flow * transposed(turn);
  EXPECT_NEAR(shear(0, 1), 1e-3, 1e-18);
  EXPECT_NEAR(shear(0, 0), 0, 1e-18);
  const Measurement here = flown(m, state, d2_flow, 200).measure();
  const Measurement there = flown(m, test::turned(state, turn), shear, 200).measure();
  expect_near(there.stress, test::turned(here.stress, turn), 1e-9);
  expect_near(there.kinetic_stress, test::turned(here.kinetic_stress, turn), 1e-9);
  EXPECT_NEAR(trace(there.stress) / trace(here.stress), 1, 1e-10);
  EXPECT_NEAR(deviator_magnitude(there.stress) / deviator_magnitude(here.stress), 1, 1e-8);
}

TEST(TiltedCell, ALegOfD2IsOneOfShearComponentsInATurnedFrame) {
  const Material m;
  const State state = test::squeezed(m, 100, 35, 0.75);
  const Mat3 turn = test::rotation({0, 0, 1}, std::numbers::pi / 4);
  Leg d2{};
  d2.strain = {-0.01, 0.01, 0};
  d2.duration = 3;
  Leg shear = d2;
  shear.strain = {0, 0, 0, 0, 0, -0.01};
  Dynamics here(m, state), there(m, test::turned(state, turn));
  const StepPlan plan = plan_steps(d2, 0.01, 1);
  drive(here, d2, plan);
  drive(there, shear, plan);
  const Measurement a = here.measure(), b = there.measure();
  expect_near(b.stress, test::turned(a.stress, turn), 1e-9);
  EXPECT_NEAR(deviator_magnitude(b.stress) / deviator_magnitude(a.stress), 1, 1e-8);
  EXPECT_NEAR(b.nu, a.nu, 1e-14);
  // The strain of a leg is what the box says, in a box of any shape.
  Dynamics skew(m, with_edges(state, {{1, 2, -3}, {0, 1, 1}, {0, 0, 1}}));
  Leg any = d2;
  any.strain = {0.01, -0.02, 0.005, 0.01, -0.03, 0.02};
  const Mat3 before = skew.cell().edges();
  drive(skew, any, plan);
  const Sym6 strain = skew.cell().strain_from(before);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(strain[c], any.strain[c], 1e-13) << c;
}

TEST(TiltedCell, ALegOfSimpleShear) {
  const Material m;
  const State state = with_edges(test::squeezed(m, 100, 36, 0.75), {{1, 2, -3}, {0, 1, 1}, {0, 0, 1}});
  const Path path = Path::read(Reader(
      parse_json(R"({"segments": [{"mode": "simple_shear", "amount": 0.02, "duration": 3}]})", "p.json"),
      "p.json"));
  const Leg leg = path.leg(0, Waypoint(0.75));
  Dynamics driven(m, state);
  drive(driven, leg, plan_steps(leg, 0.01, 1));
  const Sym6 strain = driven.cell().strain_from(state.box);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(strain[c], leg.strain[c], 1e-14) << c;
  EXPECT_NEAR(driven.cell().volume() / determinant(state.box), 1, 1e-13);
  // The flow with that velocity gradient.
  Dynamics flowing(m, state);
  const Mat3 gradient{{0, 0.02 / 3, 0}, {0, 0, 0}, {0, 0, 0}};
  const StepPlan plan = plan_steps(leg, 0.01, 1);
  flowing.start_flow(plan.dt, gradient);
  for (std::uint64_t n = 1; n <= plan.steps; ++n)
    flowing.step(test::deformation(gradient, static_cast<double>(n) * plan.dt) * state.box, gradient);
  expect_near(driven.measure().stress, flowing.measure().stress, 1e-9);
}

TEST(TiltedCell, AxisPermutation) {
  // x' = y, y' = z, z' = x of a packing in a box without any right angle, in a flow without any symmetry.
  const Material m;
  State state = test::squeezed(m, 100, 34, 0.75);
  const Mat3 tilt{{1, 0.4, -0.2}, {0.1, 1, 0.3}, {0.05, 0, 1}};
  state = test::turned(state, tilt);  // not a rotation: a homogeneous deformation
  const Mat3 swap{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  const Mat3 flow{{1e-3, 2e-3, -1e-3}, {0, -1e-3, 5e-4}, {1e-3, 0, 0}};
  const Measurement here = flown(m, state, flow, 100).measure();
  const Measurement there =
      flown(m, test::turned(state, swap), swap * flow * transposed(swap), 100).measure();
  expect_near(there.stress, test::turned(here.stress, swap), 1e-9);
  EXPECT_EQ(there.contacts, here.contacts);
}

TEST(TiltedCell, GrainsFlyStraightThroughSimpleShear) {
  // True velocities u = v + G x of grains that touch nothing: du/dt = G G x, which simple shear takes to
  // zero.
  Material m;
  m.gamma = m.gamma_b = 0;
  State state = test::two_grains(0.05, 0.05, 0);
  state.position = {{3, 4, 5}, {13, 14, 15}};
  state.velocity = {{0.01, -0.02, 0.03}, {-0.02, 0.01, 0}};
  const Mat3 shear{{0, 5e-3, 0}, {0, 0, 0}, {0, 0, 0}};
  Dynamics dynamics(m, state);
  const double dt = 0.05;
  dynamics.start_flow(dt, shear);
  const int steps = 8000;  // to gamma = 2
  for (int n = 1; n <= steps; ++n) dynamics.step(simple_shear(5e-3 * dt * n) * state.box, shear);
  const State end = dynamics.state();
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 &x = state.position[i], &v = state.velocity[i];
    Vec3 u = dynamics.cell().affine_velocity(x);
    for (std::size_t c = 0; c < 3; ++c) u[c] += v[c];
    const double t = dt * steps;
    const Vec3 off = dynamics.cell().nearest_image({end.position[i][0] - x[0] - u[0] * t,
                                                    end.position[i][1] - x[1] - u[1] * t,
                                                    end.position[i][2] - x[2] - u[2] * t});
    EXPECT_LT(norm(off), 1e-6);
    EXPECT_NEAR(end.velocity[i][0], v[0] - 2 * v[1], 1e-9);
    EXPECT_NEAR(end.velocity[i][1], v[1], 1e-12);
  }
}

TEST(TiltedCell, BackgroundDoesNotHoldBackTheFlow) {
  Material m;
  m.gamma_b = 1e4;
  State state = test::two_grains(1, 1, 0);
  state.position = {{3, 5, 7}, {13, 15, 17}};
  const Mat3 flow{{1e-3, 2e-3, 0}, {5e-4, -2e-3, 1e-3}, {0, 1e-3, 1e-3}};
  Dynamics dynamics(m, state);
  dynamics.start_flow(0.05, flow);
  for (int n = 1; n <= 2000; ++n) dynamics.step(test::deformation(flow, 0.05 * n) * state.box, flow);
  const State end = dynamics.state();
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 at = test::deformation(flow, 100) * state.position[i], &is = end.position[i];
    EXPECT_LT(norm(dynamics.cell().nearest_image({is[0] - at[0], is[1] - at[1], is[2] - at[2]})), 1e-10);
  }
}

TEST(TiltedCell, WorkOfTheBoxIsThatOfTheTotalStress) {
  // dE/dt = -V (sigma + sigma_kinetic) : G, without any damping, with shear and spin in G.
  Material m;
  m.gamma = m.gamma_b = 0;
  const State start = test::crystal(0.97, 0.03);
  const Mat3 flow{{1e-3, 2e-3, 0}, {-5e-4, -2e-3, 1e-3}, {1e-3, 0, -5e-4}};
  std::vector<double> error;
  for (const int steps : {200, 400, 800}) {
    Dynamics dynamics(m, start);
    const double dt = 10.0 / steps;
    dynamics.start_flow(dt, flow);
    const auto power = [&](const Measurement& now) {
      const Sym6 &s = now.stress, &k = now.kinetic_stress;
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum -= flow(c, c) * (s[c] + k[c]);
      sum -= (flow(1, 2) + flow(2, 1)) * (s[3] + k[3]) + (flow(0, 2) + flow(2, 0)) * (s[4] + k[4]) +
             (flow(0, 1) + flow(1, 0)) * (s[5] + k[5]);
      return sum * dynamics.cell().volume();
    };
    Measurement now = dynamics.measure();
    const double energy = now.kinetic + now.elastic;
    double work = 0, power_before = power(now);
    for (int n = 1; n <= steps; ++n) {
      dynamics.step(test::deformation(flow, n * dt) * start.box, flow);
      now = dynamics.measure();
      ASSERT_EQ(now.contacts, 192u);
      work += 0.5 * dt * (power_before + power(now));
      power_before = power(now);
    }
    error.push_back(std::abs((now.kinetic + now.elastic - energy) / work - 1));
  }
  EXPECT_LT(error[2], 1e-4);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.2);
}

}  // namespace
}  // namespace grainlaw::dem
