// What ParaView is given: every grain, every contact, and pressures that add up to that of the packing.
#include "grainlaw/dem/record/vtp.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "packings.hpp"

namespace grainlaw::dem {
namespace {

/// The numbers of one DataArray.
std::vector<double> array(const std::string& text, const std::string& name) {
  const auto head = text.find("Name=\"" + name + "\""), begin = text.find('>', head) + 1;
  EXPECT_NE(head, std::string::npos) << name;
  std::istringstream words(text.substr(begin, text.find("</DataArray>", begin) - begin));
  std::vector<double> numbers;
  for (std::string word; words >> word;) numbers.push_back(std::stod(word));
  return numbers;
}

Frame frame_of(const State& state) { return {state, {state.volume_fraction(), 0, 0, 0}, 0}; }

class Vtp : public testing::Test {
 protected:
  Material m;
  State state = test::squeezed(m, 80, 5, 0.75);
  std::string text = vtp_text(frame_of(state), m);
  std::size_t ends = array(text, "radius").size() - state.count();
};

TEST_F(Vtp, PointsAreTheGrains) {
  const auto radius = array(text, "radius"), place = array(text, "Points"),
             velocity = array(text, "velocity"), grain = array(text, "grain"),
             contacts = array(text, "contacts");
  const auto all = test::brute_force(state);
  std::vector<double> counted(state.count(), 0);
  for (const auto& [i, j, overlap] : all) ++counted[i], ++counted[j];
  for (std::size_t i = 0; i < state.count(); ++i) {
    EXPECT_EQ(radius[i], state.radius[i]);
    EXPECT_EQ(grain[i], static_cast<double>(i));
    EXPECT_EQ(contacts[i], counted[i]);
    const Vec3 x = Cell(state.box).wrap(state.position[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(place[3 * i + c], x[c]);
      EXPECT_EQ(velocity[3 * i + c], state.velocity[i][c]);
    }
  }
  EXPECT_GT(ends, 0u);
  for (std::size_t i = state.count(); i < radius.size(); ++i) {
    EXPECT_EQ(radius[i], 0);
    EXPECT_EQ(grain[i], -1);
  }
  EXPECT_EQ(array(text, "box"),
            (std::vector<double>{state.box(0, 0), 0, 0, 0, state.box(1, 1), 0, 0, 0, state.box(2, 2)}));
}

TEST_F(Vtp, LinesAreTheContacts) {
  const auto line = array(text, "connectivity"), offsets = array(text, "offsets"),
             overlap = array(text, "overlap"), force = array(text, "force"), share = array(text, "share"),
             ratio = array(text, "force_over_mean"), place = array(text, "Points"),
             radius = array(text, "radius");
  ASSERT_EQ(line.size(), 2 * offsets.size());
  double contacts = 0, ratios = 0;
  std::size_t halves = 0;
  for (std::size_t n = 0; n < offsets.size(); ++n) {
    EXPECT_EQ(offsets[n], static_cast<double>(2 * (n + 1)));
    EXPECT_EQ(force[n], m.k * overlap[n]);
    const auto a = static_cast<std::size_t>(line[2 * n]), b = static_cast<std::size_t>(line[2 * n + 1]);
    const double length = norm({place[3 * a] - place[3 * b], place[3 * a + 1] - place[3 * b + 1],
                                place[3 * a + 2] - place[3 * b + 2]});
    const double gap = share[n] == 1 ? overlap[n] : 0.5 * overlap[n];
    EXPECT_NEAR(length, radius[a] + radius[b] - gap, 1e-9);  // so no line crosses the box
    halves += share[n] == 1 ? 0 : 1;
    contacts += share[n];
    ratios += share[n] * ratio[n];
  }
  EXPECT_EQ(halves, ends);
  EXPECT_EQ(contacts, static_cast<double>(test::brute_force(state).size()));
  EXPECT_NEAR(ratios, contacts, 1e-9);
}

TEST_F(Vtp, PressuresAddUpToThatOfThePacking) {
  Material elastic = m;
  elastic.gamma = 0;
  const Dynamics dynamics(elastic, state);
  const auto pressure = array(text, "pressure");
  double sum = 0;
  for (std::size_t i = 0; i < state.count(); ++i) sum += sphere_volume(state.radius[i]) * pressure[i];
  const double wanted = trace(dynamics.measure().stress) / 3 / m.stress_unit() * dynamics.cell().volume();
  EXPECT_NEAR(sum / wanted, 1, 1e-12);
}

TEST(VtpAlone, TwoGrainsThroughAFaceAreTwoHalves) {
  const Material m;
  State two;
  two.box = Mat3::diagonal({10, 10, 10});
  two.radius = {1, 0.5};
  two.position = {{0.2, 5, 5}, {9, 5, 5}};  // overlap 0.3 through x = 0
  two.velocity = {{0, 0, 0}, {0, 0, 0}};
  const std::string text = vtp_text(frame_of(two), m);
  const auto place = array(text, "Points");
  ASSERT_EQ(place.size(), 12u);
  // Grain 0 ends at 1 - 0.15 to its left, grain 1 at 0.5 - 0.15 to its right: one point, an edge apart.
  const double low = std::min(place[6], place[9]), high = std::max(place[6], place[9]);
  EXPECT_NEAR(low, 0.2 - 0.85, 1e-12);
  EXPECT_NEAR(high, 9 + 0.35, 1e-12);
}

TEST(VtpAlone, AGasHasNoLines) {
  const Material m;
  State gas = test::two_grains(1, 1, 0);
  gas.position[1] = {2, 2, 2};
  const std::string text = vtp_text(frame_of(gas), m);
  EXPECT_NE(text.find("NumberOfPoints=\"2\" NumberOfVerts=\"0\" NumberOfLines=\"0\""), std::string::npos);
  EXPECT_EQ(array(text, "pressure"), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace grainlaw::dem
