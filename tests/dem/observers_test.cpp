// Observers against closed forms: crystals, pairs, gases; and what must not matter to them.
#include "grainlaw/dem/observe/observers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "observed.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

using observe::Observers;
using test::contacts_of;
using test::d2_signs;
using test::elastic;
using test::Met;
using test::see;
using testing::DoubleEq;

Record table_of(const std::string& name, const Material& m, const State& state) {
  Observers observers({name});
  see(observers, m, state);
  return observers.tables().at(0).rows;
}

TEST(Observers, FaceCentredCubic) {
  const auto seen = see(elastic(), test::crystal(0.99, 0));  // twelve contacts each, overlap 0.02
  EXPECT_DOUBLE_EQ(seen.at("C_r"), 12);
  EXPECT_DOUBLE_EQ(seen.at("C_star_p"), 12);
  EXPECT_EQ(seen.at("phi_r"), 0);
  EXPECT_NEAR(seen.at("overlap"), 0.02, 1e-13);
  EXPECT_NEAR(seen.at("E_p"), 6 * 0.5 * 0.02 * 0.02, 1e-14);
  EXPECT_EQ(seen.at("E_k"), 0);
  for (const char* c : {"F0xx", "F0yy", "F0zz"}) EXPECT_NEAR(seen.at(c), 1.0 / 3, 1e-14) << c;
  for (const char* c : {"F0yz", "F0xz", "F0xy", "F0_dev"}) EXPECT_NEAR(seen.at(c), 0, 1e-14) << c;
  EXPECT_LT(seen.at("unbalanced"), 1e-10);
  EXPECT_EQ(seen.at("percolating"), 0);  // no force is 2.2 times the mean
  EXPECT_EQ(seen.at("xi_x"), 0);
  EXPECT_TRUE(std::isnan(seen.at("D2_min")));
}

TEST(Observers, EqualForcesAreOneBinOfTheDistributions) {
  for (const char* name : {"force_distribution", "overlap_distribution"}) {
    const Record table = table_of(name, elastic(), test::crystal(0.99, 0));
    ASSERT_EQ(table.rows(), 81u);
    double sum = 0;
    for (std::size_t k = 0; k < table.rows(); ++k) {
      EXPECT_EQ(table["count"][k], k == 10 ? 32 * 6 : 0) << name << " " << table["x"][k];
      sum += table["P"][k] * 0.1;
    }
    EXPECT_DOUBLE_EQ(table["x"][10], 1);
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

/// A pair of unit grains: how deep they overlap, mm, and how fast they close, mm/us.
struct Pair {
  double overlap, closing;
};

/// Sixteen pairs alike and four others, far from each other. Forces 1e5 overlap + 1000 closing are 400 (16
/// times), 2200, 3800, -1000 and 28600, their mean 2000; the mean overlap is 0.027.
State twenty_pairs() {
  std::vector<Pair> pairs(16, {0.01, -0.6});
  pairs.insert(pairs.end(), {{0.03, -0.8}, {0.03, 0.8}, {0.02, -3}, {0.3, -1.4}});
  State state;
  state.box = Mat3::diagonal({10, 20, 20});
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const double y = 2 + 4 * static_cast<double>(p % 5), z = 2 + 4 * static_cast<double>(p / 5);
    state.position.insert(state.position.end(), {{2, y, z}, {4 - pairs[p].overlap, y, z}});
    state.velocity.insert(state.velocity.end(), {{pairs[p].closing, 0, 0}, {0, 0, 0}});
    state.radius.insert(state.radius.end(), 2, 1);
  }
  return state;
}

/// P of the bins that are not empty: so many contacts over 20 * 0.1.
std::map<std::size_t, double> filled_bins(const std::string& name) {
  const Record table = table_of(name, Material{}, twenty_pairs());
  std::map<std::size_t, double> filled;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    EXPECT_DOUBLE_EQ(table["x"][k], 0.1 * static_cast<double>(k));
    if (table["count"][k] > 0) filled[k] = table["P"][k];
    EXPECT_DOUBLE_EQ(table["count"][k], 2 * table["P"][k]) << name << " " << k;
  }
  return filled;
}

TEST(Observers, ForcesByHand) {
  // f/<f>: 0.2, 1.1, 1.9, and outside -0.5 and 14.3
  EXPECT_THAT(filled_bins("force_distribution"),
              testing::ElementsAre(testing::Pair(2, DoubleEq(8)), testing::Pair(11, DoubleEq(0.5)),
                                   testing::Pair(19, DoubleEq(0.5))));
}

TEST(Observers, OverlapsByHand) {
  // delta/<delta>: 0.370, 0.741, 1.111, and outside 11.1
  EXPECT_THAT(filled_bins("overlap_distribution"),
              testing::ElementsAre(testing::Pair(4, DoubleEq(8)), testing::Pair(7, DoubleEq(0.5)),
                                   testing::Pair(11, DoubleEq(1))));
}

TEST(Observers, RattlersAreLeftOutOfPartnersToo) {
  // A crystal with one small grain that three of its grains hold: those three have 13 contacts.
  State state = test::crystal(0.99, 0);
  const double a = 0.5 * state.box(0, 0);
  state.position.push_back({a / 2 + 0.12, 0.12, 0.12});
  state.radius.push_back(0.3);
  state.velocity.push_back({0, 0, 0});
  const auto seen = see(elastic(), state);
  EXPECT_DOUBLE_EQ(seen.at("C_star_p"), 12);
  EXPECT_DOUBLE_EQ(seen.at("C_r"), (32.0 * 12 + 6) / 33);
  EXPECT_NEAR(seen.at("phi_r"), 1.0 / 33, 1e-15);
}

TEST(Observers, OneContactIsWhollyUnbalanced) {
  State state;
  state.box = Mat3::diagonal({10, 10, 10});
  state.radius = {1, 0.5};
  state.position = {{0.2, 5, 5}, {9.0, 5, 5}};  // touch through the face x = 0; overlap 0.3
  state.velocity = {{0, 0, 0}, {0, 0, 0}};
  const auto seen = see(elastic(), state);
  EXPECT_NEAR(seen.at("unbalanced"), 1, 1e-14);
  EXPECT_NEAR(seen.at("overlap"), 0.3, 1e-14);
  EXPECT_NEAR(seen.at("F0xx"), 1, 1e-14);
  EXPECT_NEAR(seen.at("F0_dev"), -1, 1e-14);  // D2: sgn(Fyy - Fxx)
  EXPECT_TRUE(std::isnan(seen.at("C_star_p")));
  const Record radius = table_of("radius", elastic(), state);
  ASSERT_EQ(radius.rows(), 20u);
  for (const std::size_t k : {std::size_t{0}, std::size_t{19}}) {
    EXPECT_EQ(radius["grains"][k], 1);
    EXPECT_NEAR(radius["overlap"][k], 0.3, 1e-14);
    EXPECT_TRUE(std::isnan(radius["C_star"][k]));
    EXPECT_NEAR(radius["F_dev"][k], -state.volume_fraction(), 1e-14);  // nu n (x) n in either bin
  }
  EXPECT_EQ(radius["grains"][7], 0);
  EXPECT_TRUE(std::isnan(radius["overlap"][7]));
}

// The contacts of a row lie where those of the last one lay.
TEST(Observers, NoContactOfTheLastRowIsSeenInTheNext) {
  const State crystal = test::crystal(0.99, 0);
  State apart = crystal;
  for (double& radius : apart.radius) radius *= 0.9;
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (const std::string& name : observe::names()) {
    if (name == "nonaffine") continue;  // it looks back
    SCOPED_TRACE(name);
    Observers used({name}), fresh({name});
    if (!used.sees_velocity()) continue;  // it walks no contacts
    see(used, elastic(), crystal);
    const auto after = see(used, elastic(), apart), alone = see(fresh, elastic(), apart);
    for (const auto& [column, value] : alone) EXPECT_TRUE(same(after.at(column), value)) << column;
    for (std::size_t t = 0; t < fresh.tables().size(); ++t) {
      const Record &all = used.tables()[t].rows, &last = fresh.tables()[t].rows;
      ASSERT_GT(all.rows(), last.rows());
      const std::size_t before = all.rows() - last.rows();
      for (const std::string& column : last.columns())
        for (std::size_t row = 0; row < last.rows(); ++row)
          EXPECT_TRUE(same(all[column][before + row], last[column][row])) << column << " " << row;
    }
  }
}

/// sqrt(3 J2), with the sign of Q_yy - Q_xx.
double d2_deviator(const Mat3& q) {
  const double mean = (q(0, 0) + q(1, 1) + q(2, 2)) / 3;
  double squares = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) squares += std::pow(q(a, b) - (a == b ? mean : 0), 2);
  return std::copysign(std::sqrt(1.5 * squares), q(1, 1) - q(0, 0));
}

TEST(Observers, RadiusAgainstContactsByBruteForce) {
  const Material m = elastic();
  const State state = test::squeezed(m, 300, 31, 0.75);
  const Record table = table_of("radius", m, state);
  std::vector<double> count(300, 0), overlap(300, 0);
  std::vector<Mat3> normals(300);  // sum of n n of each grain
  for (const Met& c : contacts_of(state))
    for (const auto g : {c.i, c.j}) {
      ++count[g];
      overlap[g] += c.overlap;
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b)
          normals[g](a, b) += c.branch[a] * c.branch[b] / dot(c.branch, c.branch);
    }
  const auto [least, most] = std::minmax_element(state.radius.begin(), state.radius.end());
  for (std::size_t k = 0; k < 20; ++k) {
    double grains = 0, touching = 0, sum = 0, bearing = 0, held = 0, volume = 0;
    Mat3 fabric;  // sum of V_p n n
    for (std::size_t i = 0; i < 300; ++i) {
      const double sc = (state.radius[i] - *least) / (*most - *least);
      if (std::min<double>(19, std::floor(sc * 20)) != static_cast<double>(k)) continue;
      ++grains;
      touching += count[i];
      sum += overlap[i];
      volume += sphere_volume(state.radius[i]);
      fabric = fabric + sphere_volume(state.radius[i]) * normals[i];
      if (count[i] >= 4) {
        ++bearing;
        held += count[i];
      }
    }
    EXPECT_DOUBLE_EQ(table["r_sc"][k], (static_cast<double>(k) + 0.5) / 20);
    EXPECT_EQ(table["grains"][k], grains);
    ASSERT_GT(touching, 0);  // with 300 grains in 20 bins
    EXPECT_NEAR(table["overlap"][k], sum / touching, 1e-12);
    ASSERT_GT(bearing, 0);
    EXPECT_NEAR(table["C_star"][k], held / bearing, 1e-12);
    EXPECT_NEAR(table["F_dev"][k], d2_deviator(state.volume_fraction() / volume * fabric), 1e-12);
  }
}

TEST(Observers, KineticStressOfAGasIsTwiceItsEnergyPerVolume) {
  const Material m;
  NewPacking packing;
  packing.count = 200;
  const State state = random_gas(m, packing);
  const auto seen = see(m, state);
  const double volume = state.box(0, 0) * state.box(1, 1) * state.box(2, 2);
  const double trace = (seen.at("kxx") + seen.at("kyy") + seen.at("kzz")) * m.stress_unit() * volume;
  const double energy = seen.at("E_k") * 200 * m.k * m.r_mean * m.r_mean;
  EXPECT_NEAR(trace / energy, 2, 1e-12);
  double expected = 0;
  for (std::size_t i = 0; i < 200; ++i)
    expected += 0.5 * m.rho * sphere_volume(state.radius[i]) * dot(state.velocity[i], state.velocity[i]);
  EXPECT_NEAR(energy / expected, 1, 1e-12);
  EXPECT_TRUE(std::isnan(seen.at("overlap")));
  EXPECT_TRUE(std::isnan(seen.at("unbalanced")));
  EXPECT_EQ(seen.at("percolating"), 0);
  EXPECT_EQ(table_of("force_distribution", m, state).rows(), 0u);
}

class Rearrangement : public testing::Test {
 protected:
  double between(const Material& m, const State& before, const State& after) {
    Observers observers({"nonaffine"});
    see(observers, m, before);
    return see(observers, m, after).at("D2_min");
  }
};

TEST_F(Rearrangement, NothingMovesInAnAffineDeformation) {
  const Material m = elastic();
  const State before = test::squeezed(m, 200, 33, 0.7);
  State after = before;
  const Vec3 stretch{1.05, 0.96, 0.98};
  for (std::size_t c = 0; c < 3; ++c) {
    after.box(c, c) *= stretch[c];
    for (auto& x : after.position) x[c] = x[c] * stretch[c] + 3.7;
  }
  EXPECT_LT(between(m, before, after), 1e-26);
}

TEST_F(Rearrangement, OneGrainOfACrystal) {
  // Each grain has its twelve contacts as neighbours, Y = 4 d^2 I. The grain that moves by u sees twelve
  // branches change by u, which no J follows: |u|^2. Each of its neighbours sees one change: (1 - 1/4)
  // |u|^2/12.
  const State before = test::crystal(0.99, 0);
  State after = before;
  const Vec3 u{0.003, -0.002, 0.001};
  for (std::size_t c = 0; c < 3; ++c) after.position[17][c] += u[c];
  EXPECT_NEAR(between(elastic(), before, after) / (dot(u, u) * 1.75 / 32), 1, 1e-9);
}

class ObserversInvariance : public testing::Test {
 protected:
  Material m;
  State state = test::squeezed(m, 200, 23, 0.72);
  std::map<std::string, double> here = see(m, state);
  void expect_equal(const std::map<std::string, double>& other,
                    const std::map<std::string, std::string>& names) {
    for (const auto& [column, value] : here) {
      if (column == "D2_min") continue;  // undefined in a first row
      const auto renamed = names.find(column);
      const double seen = other.at(renamed == names.end() ? column : renamed->second);
      EXPECT_NEAR(seen, value, 1e-10 * std::max(1.0, std::abs(value))) << column;
    }
  }
};

TEST_F(ObserversInvariance, Permutation) {
  const State other = test::permuted(state, test::shuffled(state.count(), 1));
  expect_equal(see(m, other), {});
}

TEST_F(ObserversInvariance, TranslationAndImages) {
  State other = state;
  for (std::size_t i = 0; i < other.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      other.position[i][c] += 1.234 * static_cast<double>(c + 1) +
                              state.box(c, c) * static_cast<double>(i % 5) - 2 * state.box(c, c);
  expect_equal(see(m, other), {});
}

TEST_F(ObserversInvariance, AxisSwap) {
  State other = state;
  for (std::size_t i = 0; i < other.count(); ++i) {
    other.position[i] = {state.position[i][1], state.position[i][2], state.position[i][0]};
    other.velocity[i] = {state.velocity[i][1], state.velocity[i][2], state.velocity[i][0]};
  }
  other.box = Mat3::diagonal({state.box(1, 1), state.box(2, 2), state.box(0, 0)});
  std::map<std::string, std::string> names{{"xi_x", "xi_z"},
                                           {"xi_y", "xi_x"},
                                           {"xi_z", "xi_y"},
                                           {"percolates_x", "percolates_z"},
                                           {"percolates_y", "percolates_x"},
                                           {"percolates_z", "percolates_y"}};
  for (const std::string q : {"k", "F0"}) {
    const std::pair<const char*, const char*> pairs[] = {{"xx", "zz"}, {"yy", "xx"}, {"zz", "yy"},
                                                         {"yz", "xy"}, {"xz", "yz"}, {"xy", "xz"}};
    for (const auto& [old, now] : pairs) names[q + old] = q + now;
  }
  const double signed_before = here.at("F0_dev");
  here.erase("F0_dev");
  const auto there = see(m, other);
  expect_equal(there, names);
  EXPECT_NEAR(std::abs(there.at("F0_dev")), std::abs(signed_before), 1e-12);  // its sign is the mode's
}

TEST(Observers, EachSaysWhatItReads) {
  const State state = test::squeezed(Material{}, 150, 24, 0.75);
  const auto together = see(Material{}, state);
  for (const std::string& name : observe::names()) {
    Observers one({name});
    for (const auto& [column, value] : see(one, Material{}, state)) {
      if (column == "D2_min") continue;  // has no row before
      EXPECT_EQ(value, together.at(column)) << column;
    }
  }
  EXPECT_EQ(Observers({}).reads(), Wanted{});
  EXPECT_EQ(Observers({"contacts", "percolation"}).reads(), Wanted{});  // of the network alone
  EXPECT_EQ(Observers({"energy"}).reads(), Wanted{.energies = true});
  EXPECT_EQ(Observers({"kinetic_stress"}).reads(), Wanted{.kinetic_stress = true});
}

TEST(Observers, NoneCostsNoColumn) {
  Observers none({});
  EXPECT_TRUE(see(none, elastic(), test::crystal(0.99, 0)).empty());
  EXPECT_TRUE(observe::columns({}).empty());
  EXPECT_TRUE(observe::tables({}).empty());
  EXPECT_THAT(observe::columns({"nonaffine", "contacts"}),
              testing::ElementsAre("C_r", "C_star_p", "phi_r", "D2_min"));
}

}  // namespace
}  // namespace grainlaw::dem
