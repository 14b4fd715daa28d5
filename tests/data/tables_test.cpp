// The thesis's tables agree with one another and with what its text says of them: a digit changed by hand in
// one of them would show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "table.hpp"

namespace grainlaw::tests {
namespace {

const std::filesystem::path folder = std::filesystem::path(GRAINLAW_DATA_DIR) / "thesis" / "tables";

double constant(const std::string& group, const std::string& parameter) {
  return number(row_where(read_table("text-constants"), {{"group", group}, {"parameter", parameter}}),
                "value");
}

/// Least squares of Eq. 3.11, nu_c = nu_inf (1 - h) + nu_0 h with h = 3/w^2 - 2/w^3: {nu_0, nu_inf}.
std::array<double, 2> fit_jamming_density(const std::vector<Row>& rows, const std::string& mode) {
  double hh = 0, hg = 0, gg = 0, hy = 0, gy = 0;
  for (const Row& row : rows) {
    const double w = number(row, "w");
    if (row.at("mode") != mode || w < 1.2) continue;
    const double h = 3 / (w * w) - 2 / (w * w * w), g = 1 - h, y = number(row, "nu_c");
    hh += h * h;
    hg += h * g;
    gg += g * g;
    hy += h * y;
    gy += g * y;
  }
  const double det = hh * gg - hg * hg;
  return {(hy * gg - gy * hg) / det, (gy * hh - hy * hg) / det};
}

TEST(Tables, FitOfTable34GivesTable32) {
  const auto rows = read_table("table-3.4");
  for (const std::string mode : {"iso", "uni", "d2"}) {
    const Row limits = row_where(read_table("table-3.2"), {{"mode", mode}, {"data", "thesis"}});
    const auto [nu_0, nu_inf] = fit_jamming_density(rows, mode);
    // The thesis does not say how it weighted its points; 6e-4 is the scatter of one nu_c about the law.
    EXPECT_NEAR(nu_0, number(limits, "nu_c_0"), 6e-4) << mode;
    EXPECT_NEAR(nu_inf, number(limits, "nu_c_inf"), 6e-4) << mode;
  }
}

TEST(Tables, Table33TakesItsJammingDensitiesFromTable34) {
  const auto shear = read_table("table-3.3"), packing = read_table("table-3.4");
  ASSERT_EQ(shear.size(), 11U);
  ASSERT_EQ(packing.size(), 33U);
  for (const Row& row : shear)
    EXPECT_EQ(row.at("nu_c"), row_where(packing, {{"mode", "d2"}, {"w", row.at("w")}}).at("nu_c"));
}

TEST(Tables, JammingDensityFallsFromIsoOverUniToD2) {
  const auto packing = read_table("table-3.4"), w3 = read_table("table-2.1");
  for (const Row& row : read_table("table-3.3")) {
    const auto nu_c = [&](const char* mode) {
      return number(row_where(packing, {{"mode", mode}, {"w", row.at("w")}}), "nu_c");
    };
    EXPECT_GT(nu_c("iso"), nu_c("uni")) << row.at("w");
    EXPECT_GT(nu_c("uni"), nu_c("d2")) << row.at("w");
  }
  const auto nu_c = [&](const char* mode) {
    return number(row_where(w3, {{"mode", mode}, {"data", "thesis"}}), "nu_c");
  };
  EXPECT_GT(nu_c("iso"), nu_c("uni"));
  EXPECT_GT(nu_c("uni"), nu_c("d3"));
  EXPECT_GT(nu_c("d3"), nu_c("d2"));
}

TEST(Tables, CompactFormsStayBelowTable33) {
  double below_Q_max = 0, below_Q_v = 0;
  for (const Row& row : read_table("table-3.3")) {
    const double nu_c = number(row, "nu_c");
    const double Q_max = constant("shear", "s_max_Q_max_c0") + constant("shear", "s_max_Q_max_c1") * nu_c;
    const double Q_v = constant("shear", "F_max_Q_v_c0") + constant("shear", "F_max_Q_v_c1") * nu_c;
    below_Q_max = std::max(below_Q_max, 1 - Q_max / number(row, "s_max_Q_max"));
    below_Q_v = std::max(below_Q_v, 1 - Q_v / number(row, "F_max_Q_v"));
  }
  EXPECT_NEAR(below_Q_max, 0.065, 0.001);  // at w = 3.5
  EXPECT_NEAR(below_Q_v, 0.17, 0.005);     // at w = 2
}

TEST(Tables, Table42NamesTheProductBesideItsFactor) {
  const auto rows = read_table("table-4.2");
  const double b = number(row_where(rows, {{"parameter", "b"}}), "value");
  const Row p0 = row_where(rows, {{"parameter", "p0"}});
  EXPECT_NEAR(b * constant("moduli", "p0_w"), number(p0, "value"), 0.0004);
  EXPECT_EQ(p0.at("suspect"), "value");
}

TEST(Tables, OneRelationOfEq56) {
  const Row ratio = row_where(read_table("text-constants"), {{"parameter", "one_cycle_ratio"}});
  EXPECT_NEAR(1 / number(ratio, "value"), 1 / (1 - std::exp(-1.0)), 1e-3);  // printed is the inverse
  EXPECT_EQ(ratio.at("suspect"), "value");
}

TEST(Tables, UnitsOfTable31) {
  const auto rows = read_table("table-3.1");
  // ug, mm, us in SI: 1e-9 kg, 1e-3 m, 1e-6 s.
  const std::map<std::string, double> si{
      {"rho", 1e-9 / 1e-9}, {"k", 1e-9 / 1e-12}, {"gamma", 1e-9 / 1e-6}, {"gamma_b", 1e-9 / 1e-6}};
  for (const auto& [symbol, factor] : si) {
    const Row row = row_where(rows, {{"symbol", symbol}});
    EXPECT_NEAR(number(row, "value") * factor, number(row, "si_value"), 1e-12 * number(row, "si_value"));
  }
}

TEST(Tables, SuspectCellsAreColumnsAndHaveANote) {
  std::size_t suspects = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    for (const Row& row : read_table(entry.path().stem().string())) {
      std::istringstream names(row.at("suspect"));
      for (std::string name; std::getline(names, name, ';'); ++suspects) {
        EXPECT_TRUE(row.contains(name) || name == "unit") << entry.path() << ": " << name;
        EXPECT_NE(row.at("note"), "") << entry.path() << ": " << name;
      }
    }
  }
  EXPECT_EQ(suspects, 8U);
}

TEST(Tables, EachIsDescribed) {
  std::ifstream stream(folder / "README.md");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::size_t tables = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    ++tables;
    EXPECT_THAT(text, testing::HasSubstr(entry.path().filename().string() + '`'));
  }
  EXPECT_EQ(tables, 13U);
}

}  // namespace
}  // namespace grainlaw::tests
