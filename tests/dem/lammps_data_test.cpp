// The data file holds the packing to the last bit.
#include "grainlaw/dem/files/lammps_data.hpp"

#include <gtest/gtest.h>

#include <sstream>

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

}  // namespace
}  // namespace grainlaw::dem
