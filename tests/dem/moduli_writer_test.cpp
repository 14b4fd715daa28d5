// Moduli along a test: those of the very states, without a trace in the test itself; refused states have a
// row and a reason.
#include "grainlaw/dem/record/moduli_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/dem/run/element_test.hpp"
#include "grainlaw/dem/stiffness/probed_packing.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr StrainTensor d2{-1, 1, 0};

class ModuliOfATest : public testing::Test {
 protected:
  void SetUp() override {
    dir = fs::temp_directory_path() / ("grainlaw-moduli-" + std::to_string(::getpid()));
    fs::remove_all(dir);
    fs::create_directories(dir);
  }
  void TearDown() override { fs::remove_all(dir); }

  RunSummary run(const std::string& name, const std::string& measure) {
    const std::string text = R"({
      "preparation": {"count": 150, "seed": 3, "rate": 1e-3, "relax": {"tolerance": 1e-2, "duration": 100}},
      "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.75}, "rate": 5e-4},
                            {"mode": "d2", "amount": 0.05, "rate": 2e-4}]},
      "measure": {"rows": 10, "time_step_gas": 0.1)" +
                             measure + "}}";
    return run_element_test(Scene::read(Reader(parse_json(text, "s.json"), "s.json"), ""), dir / name);
  }

  fs::path dir;
};

TEST_F(ModuliOfATest, AreThoseOfTheStatesAndLeaveTheTestAlone) {
  const std::string states =
      R"([{"segment": 1, "eps_dev": 0}, {"segment": 1, "eps_dev": 0.02}, {"segment": 1}])";
  run("plain", "");
  run("looked", R"(, "moduli": )" + states + R"(, "snapshots": )" + states);
  EXPECT_FALSE(fs::exists(dir / "plain/moduli.csv"));
  EXPECT_EQ(read_file(dir / "looked/record.csv"), read_file(dir / "plain/record.csv"));
  const Record table = read_moduli(dir / "looked/moduli.csv");
  ASSERT_EQ(table.rows(), 3u);
  EXPECT_FALSE(table.has("file"));
  EXPECT_EQ(table["segment"], (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(table["eps_dev"][0], 0);
  EXPECT_NEAR(table["eps_dev"][2], 0.05, 1e-12);
  for (std::size_t k = 0; k < 3; ++k) {
    const State state = read_frame(dir / "looked/snapshots.h5", {.nu = {}, .frame = k, .segment = {}});
    const std::vector<double> expected = ProbedPacking(Material{}, state, d2).row();
    const auto at = [&](const char* column) { return table[column][k]; };
    EXPECT_EQ(at("nu"), expected[0]);
    EXPECT_NEAR(at("B"), expected[11], 1e-9 * expected[11]);
    EXPECT_NEAR(at("G_oct"), expected[14], 1e-9 * expected[11]);
    EXPECT_GE(at("contacts"), isostatic_contacts(at("backbone")));
  }
}

TEST_F(ModuliOfATest, ARefusedStateHasARowAndAReason) {
  const RunSummary summary = run("loose", R"(, "moduli": [{"segment": 0, "nu": 0.65}, {"segment": 1}])");
  const Record table = read_moduli(dir / "loose/moduli.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_TRUE(std::isnan(table["B"][0]));
  EXPECT_TRUE(std::isnan(table["E_xx_xx"][0]));
  EXPECT_GT(table["B"][1], 0);
  EXPECT_THAT(
      summary.warnings,
      testing::Contains(HasSubstr("no moduli in segment 0 at eps_dev = 0: unjammed: no grain bears load")));
}

TEST_F(ModuliOfATest, UnderStressControlTheyWaitForTheTarget) {
  const std::string text = R"({
      "preparation": {"count": 150, "seed": 3, "rate": 1e-3, "nu": 0.72, "relax": {"tolerance": 1e-2, "duration": 100}},
      "path": {"segments": [{"mode": "isotropic_stress", "P": 0.03, "rate": 1e-4},
                            {"mode": "constant_p", "amount": 0.02, "rate": 1e-4}]},
      "measure": {"rows": 4, "time_step_gas": 0.1,
                  "moduli": [{"segment": 0}, {"segment": 1, "eps_dev": 0.01}, {"segment": 1}]}})";
  run_element_test(Scene::read(Reader(parse_json(text, "s.json"), "s.json"), ""), dir / "held");
  const Record table = read_moduli(dir / "held/moduli.csv");
  ASSERT_EQ(table.rows(), 3u);
  EXPECT_EQ(table["segment"], (std::vector<double>{0, 1, 1}));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(table["B"][k], 0) << k;
}

TEST(ProbedPacking, RefusesWhatIsBelowIsostatic) {
  EXPECT_THAT(why_no_moduli(100, 200, 1e-12),
              testing::StartsWith("contacts below isostatic: 200 between the 100 grains that bear load"));
  EXPECT_EQ(why_no_moduli(0, 0, 0), "unjammed: no grain bears load");
  EXPECT_EQ(why_no_moduli(100, 400, 2e-3),
            "not in balance: the largest net force on a grain is 0.002 times the mean contact force");
}

TEST(ModuliTable, NamesFileAndColumn) {
  const fs::path file = fs::temp_directory_path() / ("moduli-" + std::to_string(::getpid()) + ".csv");
  const auto said = [&](const std::string& text) {
    write_file(file, text);
    try {
      read_moduli(file);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  std::string header, row, large;
  for (const std::string& name : moduli_columns()) {
    header += (header.empty() ? "" : ",") + name;
    row += (row.empty() ? "" : ",") + std::string(name == "nu" ? "0.7" : "1");
    large += (large.empty() ? "" : ",") + std::string(name == "nu" ? "0.7" : name == "A2" ? "-1e308" : "1");
  }
  const std::string good = header + "\n" + row + "\n";
  EXPECT_EQ(said(good), "accepted");
  std::string other = good;
  EXPECT_EQ(said(other.replace(other.find("G_oct"), 5, "G_odd")),
            file.string() + ": G_oct: column is missing");
  EXPECT_EQ(said(header + ",B_left,speed_xyz_3,Poisson_zy\n" + row + ",1,1,1\n"), "accepted");
  EXPECT_EQ(said(header + ",mu\n" + row + ",1\n"),
            file.string() + ": mu: is no column of a table of moduli (docs/formats.md lists them)");
  EXPECT_EQ(said(header + "\n" + row + "\n" + large + "\n"),
            file.string() + ": A2: line 3: must be in [-1000, 1000], got -1e+308");
  fs::remove(file);
}

}  // namespace
}  // namespace grainlaw::dem
