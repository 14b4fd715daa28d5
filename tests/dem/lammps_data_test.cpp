// The data file holds the packing to the last bit.
#include "grainlaw/dem/files/lammps_data.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <tuple>

#include "lammps_file.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

/// Lines of a section, without blank ones.
std::vector<std::vector<double>> section(const std::string& text, const std::string& head) {
  std::istringstream lines(text.substr(text.find(head) + head.size()));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line) && (line.empty() || std::isdigit(line[0]));) {
    std::istringstream words(line);
    std::vector<double> row;
    for (std::string word; words >> word;) row.push_back(std::stod(word));
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

TEST(LammpsData, ReadsBackToTheLastBit) {
  const Material m;
  State state = test::squeezed(m, 60, 2, 0.7);
  state.position[7][1] -= state.box(1, 1);  // an image counts as the grain
  const std::string text = lammps_data(state, m);
  EXPECT_NE(text.find("\n60 atoms\n1 atom types\n"), std::string::npos);
  std::istringstream box(text.substr(text.find("types") + 6));
  const char* bounds[3][2] = {{"xlo", "xhi"}, {"ylo", "yhi"}, {"zlo", "zhi"}};
  for (std::size_t c = 0; c < 3; ++c) {
    double low, high;
    std::string low_name, high_name;
    box >> low >> high >> low_name >> high_name;
    EXPECT_EQ(low, 0);
    EXPECT_EQ(high, state.box(c, c));
    EXPECT_EQ(low_name, bounds[c][0]);
    EXPECT_EQ(high_name, bounds[c][1]);
  }
  const auto atoms = section(text, "Atoms # sphere\n"), velocities = section(text, "Velocities\n");
  ASSERT_EQ(atoms.size(), 60u);
  ASSERT_EQ(velocities.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) {
    const Vec3 x = Cell(state.box).wrap(state.position[i]), v = state.velocity[i];
    const double id = static_cast<double>(i + 1);
    EXPECT_EQ(atoms[i], (std::vector<double>{id, 1, 2 * state.radius[i], m.rho, x[0], x[1], x[2]}));
    EXPECT_EQ(velocities[i], (std::vector<double>{id, v[0], v[1], v[2], 0, 0, 0}));
  }
}

/// A packing after any homogeneous deformation, and what the file holds of it.
struct Exported {
  explicit Exported(const Mat3& deformation)
      : state(test::turned(test::squeezed(material, 60, 3, 0.7), deformation)),
        text(lammps_data(state, material)),
        box(state.box) {
    std::istringstream file(text);
    read = test::read_lammps(file);
  }
  Material material;
  State state;
  std::string text;
  LammpsBox box;
  State read;
};

Mat3 simple_shear(double gamma) { return {{1, gamma, 0}, {0, 1, 0}, {0, 0, 1}}; }

class LammpsTilted : public testing::TestWithParam<Mat3> {};

TEST_P(LammpsTilted, IsTheSamePackingInItsFrame) {
  const Exported e(GetParam());
  const Mat3& h = e.read.box;
  for (std::size_t c = 0; c < 3; ++c) EXPECT_GT(h(c, c), 0);
  EXPECT_LE(std::abs(h(0, 1)), 0.5 * h(0, 0));
  EXPECT_LE(std::abs(h(0, 2)), 0.5 * h(0, 0));
  EXPECT_LE(std::abs(h(1, 2)), 0.5 * h(1, 1));
  EXPECT_NEAR(determinant(h) / determinant(e.state.box), 1, 1e-12);
  EXPECT_NEAR(determinant(e.box.turn), 1, 1e-14);
  const Mat3 to_fractions = inverse(h);
  for (std::size_t i = 0; i < e.state.count(); ++i) {
    for (const double fraction : to_fractions* e.read.position[i]) {
      EXPECT_GE(fraction, -1e-12);
      EXPECT_LE(fraction, 1 + 1e-12);
    }
    // The image that was written is one of the grain's: whole edges of the snapshot's box away.
    const Vec3 there = transposed(e.box.turn) * e.read.position[i];
    const Vec3 away =
        inverse(e.state.box) * Vec3{there[0] - e.state.position[i][0], there[1] - e.state.position[i][1],
                                    there[2] - e.state.position[i][2]};
    for (const double edges : away) EXPECT_NEAR(edges, std::round(edges), 1e-11);
    const Vec3 back = transposed(e.box.turn) * e.read.velocity[i];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], e.state.velocity[i][c], 1e-16);
  }
}

TEST_P(LammpsTilted, HasTheSameContactsEnergyAndStress) {
  const Exported e(GetParam());
  const Dynamics ours(e.material, e.state), theirs(e.material, e.read);
  const auto here = test::listed(ours), there = test::listed(theirs);
  ASSERT_GT(here.size(), 100u);
  ASSERT_EQ(here.size(), there.size());
  for (std::size_t k = 0; k < here.size(); ++k) {
    EXPECT_EQ(std::get<0>(here[k]), std::get<0>(there[k]));
    EXPECT_EQ(std::get<1>(here[k]), std::get<1>(there[k]));
    EXPECT_NEAR(std::get<2>(here[k]), std::get<2>(there[k]), 1e-12);
  }
  const Measurement a = ours.measure(), b = theirs.measure();
  EXPECT_NEAR(b.elastic / a.elastic, 1, 1e-11);
  EXPECT_NEAR(b.kinetic / a.kinetic, 1, 1e-13);
  const Sym6 stress = test::turned(a.stress, e.box.turn);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(b.stress[c], stress[c], 1e-11 * trace(a.stress)) << c;
}

INSTANTIATE_TEST_SUITE_P(
    Boxes, LammpsTilted,
    testing::Values(simple_shear(0.3), simple_shear(-7.6),
                    test::rotation({1, 2, -1}, 0.7) * simple_shear(0.45),
                    Mat3{{1, 0.2, -0.4}, {0.3, 1.1, 0.6}, {-0.2, 0.5, 1.2}},
                    exponential({{0.4, 0.7, -0.2}, {0.7, -0.5, 0.3}, {-0.2, 0.3, 0.1}})));

TEST(LammpsData, SimpleShearOfACubeIsNotTurned) {
  const Exported e(simple_shear(2.7));
  EXPECT_EQ(e.box.turn, Mat3::identity());
  const double length = e.state.box(0, 0);
  EXPECT_EQ(e.read.box(0, 0), length);
  EXPECT_EQ(e.read.box(1, 1), e.state.box(1, 1));
  EXPECT_NEAR(e.read.box(0, 1), -0.3 * length, 1e-14 * length);
  EXPECT_THAT(e.text, testing::HasSubstr(" xy xz yz\n# x in the frame of the snapshot: 1 0 0\n# y in"));
  EXPECT_THAT(e.text, testing::HasSubstr("# z in the frame of the snapshot: 0 0 1\n\nAtoms # sphere\n"));
}

}  // namespace
}  // namespace grainlaw::dem
