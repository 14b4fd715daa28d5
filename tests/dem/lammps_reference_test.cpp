// Against LAMMPS (pair_style granular, hooke, damping velocity) on the same packing. Its side is committed
// in data/reference/lammps, with the input that made it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "lammps_file.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

const std::filesystem::path folder = std::filesystem::path(GRAINLAW_DATA_DIR) / "reference/lammps";
constexpr double duration = 4.56;  // us, that of every run

using Table = std::vector<std::vector<double>>;

/// The numbers of a table without its header line.
Table read_csv(const std::string& name) {
  std::ifstream file(folder / name);
  EXPECT_TRUE(file) << name;
  Table rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

/// The packing that LAMMPS began with.
State read_packing() {
  std::ifstream file(folder / "packing.data");
  return test::read_lammps(file);
}

/// Our run of a case: edges move at constant speed, x grows and y shrinks by `strain`.
State flow(double gamma, double gamma_b, int steps, double strain) {
  Material m;
  m.gamma = gamma;
  m.gamma_b = gamma_b;
  const State start = read_packing();
  Dynamics dynamics(m, start);
  const double speed = strain / duration, dt = duration / steps;
  dynamics.start(dt, {speed, -speed, 0});
  for (int n = 1; n <= steps; ++n) {
    const double x = 1 + speed * n * dt, y = 1 - speed * n * dt;
    dynamics.step({start.box(0, 0) * x, start.box(1, 1) * y, start.box(2, 2)}, {speed / x, -speed / y, 0});
  }
  return dynamics.state();
}

/// From where `reference` (rows id, x, y, z) has each grain to where it is in ours, mm.
std::vector<Vec3> differences(const State& ours, const Table& reference) {
  EXPECT_EQ(reference.size(), ours.count());
  std::vector<Vec3> list;
  for (const auto& row : reference) {
    const auto& x = ours.position.at(static_cast<std::size_t>(row[0]) - 1);
    list.push_back(Cell(ours.box).nearest_image({x[0] - row[1], x[1] - row[2], x[2] - row[3]}));
  }
  return list;
}

double largest(const std::vector<Vec3>& list) {
  double most = 0;
  for (const Vec3& d : list) most = std::max(most, norm(d));
  return most;
}

double root_mean_square(const std::vector<Vec3>& list) {
  double sum = 0;
  for (const Vec3& d : list) sum += dot(d, d);
  return std::sqrt(sum / static_cast<double>(list.size()));
}

/// The differences from LAMMPS's places extrapolated to a step of 0, as an error of first order has it, from
/// those of one step and of half that step.
std::vector<Vec3> extrapolated(const State& ours, const Table& coarse, const Table& fine) {
  auto list = differences(ours, fine);
  const auto before = differences(ours, coarse);
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) list[i][c] = 2 * list[i][c] - before[i][c];
  return list;
}

TEST(LammpsReference, StressAndContactsOfOnePacking) {
  const Measurement m = Dynamics(Material{}, read_packing()).measure();
  const auto theirs = read_csv("start.csv").at(0);
  const std::array<std::size_t, 6> column{0, 1, 2, 5, 4, 3};  // theirs: xx, yy, zz, xy, xz, yz
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(m.stress[c] / theirs[column[c]], 1, 1e-10) << c;
  EXPECT_EQ(m.contacts, theirs[6]);
}

TEST(LammpsReference, ThousandStepsWithoutDamping) {
  EXPECT_LT(largest(differences(flow(0, 0, 1000, 0), read_csv("elastic.csv"))), 1e-8);
}

/// LAMMPS computes damping with the velocity of the half step, which makes its error first order, and moves
/// the box after the forces of a step, so that images lag one step behind; ours is second order. So the
/// difference halves with the step, and falls by more than an order of magnitude where LAMMPS's places are
/// extrapolated to a step of 0 (not to nothing: damping jumps where contacts begin and end).
class LammpsSteps : public testing::TestWithParam<const char*> {
 protected:
  State ours(int steps) const {
    return GetParam() == std::string("damped") ? flow(1000, 100, steps, 0) : flow(1000, 0, steps, 1e-3);
  }
  Table theirs(int steps) const { return read_csv(GetParam() + ("-" + std::to_string(steps) + ".csv")); }
};

TEST_P(LammpsSteps, DifferenceFallsWithTheStep) {
  std::vector<double> size;
  for (const int steps : {500, 1000, 2000})
    size.push_back(root_mean_square(differences(ours(steps), theirs(steps))));
  EXPECT_NEAR(size[0] / size[1], 2, 0.05);
  EXPECT_NEAR(size[1] / size[2], 2, 0.05);
  EXPECT_LT(root_mean_square(extrapolated(ours(2000), theirs(1000), theirs(2000))), 0.1 * size[2]);
}

/// LAMMPS's background damps the whole velocity and so holds back the flow; ours damps the fluctuation. With
/// a background the difference does not fall with the step.
TEST(LammpsReference, BackgroundOnTheWholeVelocityIsAnotherFlow) {
  const State ours = flow(1000, 100, 2000, 1e-3);
  const Table coarse = read_csv("drag-1000.csv"), fine = read_csv("drag-2000.csv");
  const double size = root_mean_square(differences(ours, fine));
  EXPECT_GT(size, 1e-4);  // a free grain would lag by gamma_b G x t^2/(2 m): 3e-4 mm
  EXPECT_NEAR(root_mean_square(extrapolated(ours, coarse, fine)), size, 0.01 * size);
}

INSTANTIATE_TEST_SUITE_P(Cases, LammpsSteps, testing::Values("damped", "flow"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace grainlaw::dem
