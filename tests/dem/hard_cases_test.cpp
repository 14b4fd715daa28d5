// Scenes at the edge of what the engine takes, each with a stated outcome. Gas without contacts: see
// element_test_test.cpp; flows of w = 10 and to eps_dev = 2 against brute force at random moments: see
// neighbours_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/record.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Scene scene_of(const std::string& json) {
  return Scene::read(Reader(parse_json(json, "scene.json"), "scene.json"), "");
}

class HardCase : public testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("grainlaw-hard-case-" + std::to_string(::getpid()));
    fs::remove_all(dir);
  }
  void TearDown() override { fs::remove_all(dir); }
  std::vector<std::string> run(const std::string& json) {
    return run_element_test(scene_of(json), dir).warnings;
  }
  Record record() const { return Record::read_csv(dir / "record.csv"); }
  /// The last snapshot is a packing of `count` grains whose contacts, counted anew by brute force, are those
  /// of the last row.
  void expect_whole(std::size_t count) const {
    const State end = read_frame(dir / "snapshots.h5", {});
    ASSERT_EQ(end.count(), count);
    std::vector<int> contacts(count, 0);
    for (const auto& [i, j, overlap] : test::brute_force(end)) ++contacts[i], ++contacts[j];
    double held = 0;
    for (const int c : contacts) held += c >= 4 ? c : 0;
    const Record r = record();
    EXPECT_NEAR(r["C"].back(), held / static_cast<double>(count), 1e-12);
    EXPECT_GT(held, 0);
    EXPECT_NEAR(end.volume_fraction(), r["nu"].back(), 1e-12);
  }
  fs::path dir;
};

TEST_F(HardCase, EqualGrainsAreWarnedOf) {
  const auto warnings = run(R"({"material": {"w": 1},
    "preparation": {"count": 64, "rate": 1e-2, "relax": {"duration": 5}},
    "path": {"segments": [{"mode": "relax", "duration": 1}]}})");
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings.back(), testing::AllOf(HasSubstr("w = 1 is below 1.2"), HasSubstr("at the end")));
  EXPECT_THAT(read_file(dir / "provenance.json"), HasSubstr("crystallise"));
}

TEST_F(HardCase, SizesTenToOneJam) {
  run(R"({"material": {"w": 10}, "preparation": {"count": 150, "nu": 0.66, "rate": 2e-3, "relax": {"duration": 50}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.8}, "rate": 1e-3}, {"mode": "relax", "duration": 200}]},
    "measure": {"rows": 5, "time_step": 0.2, "snapshots": [{"segment": 1}]}})");
  expect_whole(150);
  EXPECT_GT(record()["P"].back(), 0.01);
  EXPECT_LT(record()["Ek_over_Ep"].back(), 1e-3);
}

TEST_F(HardCase, EightGrainsFlow) {
  run(R"({"preparation": {"count": 8, "rate": 2e-3, "relax": {"duration": 50}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.76}, "rate": 1e-3},
                          {"mode": "d2", "amount": 0.03, "rate": 1e-3}]},
    "measure": {"rows": 20, "snapshots": [{"segment": 1}]}})");
  expect_whole(8);
  EXPECT_EQ(record().rows(), 41u);
}

TEST_F(HardCase, ANarrowBoxHasExactImages) {
  // Eight grains in a box under two cut-offs wide, and the same box laid out twice along each axis: stress
  // and fabric of both are equal, also where two grains touch through several images.
  const Material m;
  const State one = test::squeezed(m, 8, 3, 0.8);
  ASSERT_LT(one.box(0, 0), 2 * 3.02);
  State eight = one;
  for (std::size_t c = 0; c < 3; ++c) eight.box(c, c) *= 2;
  eight.position.clear(), eight.velocity.clear(), eight.radius.clear();
  for (int copy = 0; copy < 8; ++copy)
    for (std::size_t i = 0; i < one.count(); ++i) {
      auto x = one.position[i];
      for (std::size_t c = 0; c < 3; ++c) x[c] += ((copy >> c) & 1) * one.box(c, c);
      eight.position.push_back(x);
      eight.velocity.push_back(one.velocity[i]);
      eight.radius.push_back(one.radius[i]);
    }
  const Measurement a = Dynamics(m, one).measure(), b = Dynamics(m, eight).measure();
  EXPECT_EQ(8 * a.contacts, b.contacts);
  for (std::size_t c = 0; c < 6; ++c) {
    EXPECT_NEAR(a.stress[c], b.stress[c], 1e-11 * trace(a.stress));
    EXPECT_NEAR(a.fabric[c], b.fabric[c], 1e-11 * trace(a.fabric));
  }
}

TEST_F(HardCase, DenseToNineTenths) {
  run(R"({"preparation": {"count": 100, "rate": 2e-3, "relax": {"duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.9}, "rate": 1e-3},
                          {"mode": "d2", "amount": 0.2, "rate": 1e-3}]},
    "measure": {"rows": 5, "time_step": 0.2, "snapshots": [{"segment": 1}]}})");
  expect_whole(100);
  const Record r = record();
  EXPECT_NEAR(r["nu"].back(), 0.9, 1e-12);
  EXPECT_GT(r["P"].back(), 0.1);  // Eq. 2.14 gives 0.14
  EXPECT_LT(r["P"].back(), 0.2);
  EXPECT_EQ(r["f_NR"].back(), 1);
}

TEST_F(HardCase, TwoGrainsAtOnePointAreRefused) {
  State state = test::two_grains(1, 1, 0);
  state.position[1] = state.position[0];
  fs::create_directories(dir);
  SnapshotWriter(dir / "snapshots.h5", state.radius).append(state, {state.volume_fraction(), 0, 0, 0});
  const std::string scene = R"({"material": {"w": 1}, "preparation": {"snapshot": ")" +
                            (dir / "snapshots.h5").string() +
                            R"("}, "path": {"segments": [{"mode": "relax"}]}})";
  try {
    run_element_test(scene_of(scene), dir / "out");
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("two grains lie at the same point"));
  }
  EXPECT_FALSE(fs::exists(dir / "out" / "record.csv"));
}

TEST_F(HardCase, TooLongAStepIsRefused) {
  for (const char* key : {"time_step", "time_step_gas"}) {
    const std::string scene =
        R"({"path": {"segments": [{"mode": "relax"}]}, "measure": {")" + std::string(key) + R"(": 0.21}})";
    try {
      scene_of(scene);
      FAIL() << key;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()),
                "scene.json: measure." + std::string(key) + ": must be > 0 and <= 0.2, got 0.21");
    }
  }
}

TEST_F(HardCase, TooFastARateIsWarnedOf) {
  const auto warnings =
      run(R"({"preparation": {"count": 60, "nu": 0.55, "rate": 1e-2, "relax": {"duration": 10}},
    "path": {"segments": [{"repeat": 3, "segments": [{"mode": "d2", "amount": 0.4, "rate": 0.3},
                                                     {"mode": "d2", "amount": -0.4, "rate": 0.3}]}]},
    "measure": {"rows": 10}})");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("E_k/E_p is above 1 in"));
  EXPECT_THAT(read_file(dir / "provenance.json"), HasSubstr("E_k/E_p is above 1 in"));
}

TEST_F(HardCase, ThreeHundredCyclesLoseNothing) {
  Material m;
  m.gamma_b = 0;  // nothing but the grains' own forces
  const State start = test::squeezed(m, 60, 12, 0.66, 0.005);
  Dynamics dynamics(m, start);
  const int half = 100;  // steps
  const double dt = time_step(m, dynamics.grains().smallest_radius(), 0.2),
               squeeze = std::log(0.72 / 0.66) / 3;
  for (int cycle = 0; cycle < 300; ++cycle) {
    const double rate = squeeze / (half * dt);
    dynamics.start(dt, {-rate, -rate, -rate});
    for (int n = 1; n <= 2 * half; ++n) {
      const double strain = squeeze * (n <= half ? n : 2 * half - n) / half, sign = n < half ? -1 : 1;
      Vec3 length;
      for (std::size_t c = 0; c < 3; ++c) length[c] = start.box(c, c) * std::exp(-strain);
      dynamics.step(length, {sign * rate, sign * rate, sign * rate});
    }
  }
  const State end = dynamics.state();
  EXPECT_EQ(end.radius, start.radius);
  EXPECT_NEAR(end.volume_fraction(), 0.66, 1e-12);
  Vec3 momentum{};
  double scale = 0;
  for (std::size_t i = 0; i < end.count(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double p = std::pow(end.radius[i], 3) * end.velocity[i][c];
      momentum[c] += p;
      scale += std::abs(p);
    }
  EXPECT_GT(scale, 0);
  EXPECT_LT(norm(momentum), 1e-11 * scale);
  const auto is = test::listed(dynamics), should = test::brute_force(end);
  ASSERT_EQ(is.size(), should.size());
  for (std::size_t c = 0; c < is.size(); ++c) EXPECT_NEAR(std::get<2>(is[c]), std::get<2>(should[c]), 1e-10);
  EXPECT_LT(dynamics.measure().kinetic, 1e9);
}

TEST_F(HardCase, ShearToTwo) {
  // x and y change by a factor 3.2.
  run(R"({"preparation": {"count": 200, "nu": 0.66, "rate": 2e-3, "relax": {"duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.72}, "rate": 2e-3},
                          {"mode": "d2", "controls": {"eps_dev": 2}, "rate": 1e-2}]},
    "measure": {"rows": 10, "time_step": 0.2, "snapshots": [{"segment": 1}]}})");
  expect_whole(200);
  const Record r = record();
  EXPECT_NEAR(r["eps_dev"].back(), 2, 1e-12);
  EXPECT_NEAR(r["nu"].back(), 0.72, 1e-9);
  EXPECT_GT(r["s_dev"].back(), 0.05);
}

}  // namespace
}  // namespace grainlaw::dem
