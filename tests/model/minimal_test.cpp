// The minimal form (section 5.H): its jamming density against Eqs. 5.1, 5.3 and 5.13 as written, everything
// else as functions of nu/phi_J, and what it refuses.
#include "grainlaw/model/forms/minimal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "checks.hpp"
#include "grainlaw/model/predict_minimal.hpp"

namespace grainlaw::model {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Tables 5.1 and 5.2, with a phi_cr.
ParameterSet near_jamming(double phi_cr = 0.6621) {
  auto set = ParameterSet::load(std::filesystem::path(GRAINLAW_DATA_DIR) / "thesis" / "near-jamming.json");
  set.memory->phi_cr.emplace().value = phi_cr;
  return set;
}

Prediction run(const std::string& path, int rows = 40, double phi_cr = 0.6621) {
  return predict_minimal(near_jamming(phi_cr), path_of(path), rows);
}

const char* const shear_cycle =
    R"({"start": {"nu": 0.6593, "phi_J": 0.6652}, "segments": [{"mode": "d2", "controls": {"eps_dev": 0.28}},
      {"mode": "d2", "controls": {"eps_dev": -0.16}}, {"mode": "d2", "controls": {"eps_dev": 0.28}}]})";

TEST(Minimal, ShearTakesTheJammingDensityByEquations5_3And5_13) {
  const Record record = run(shear_cycle).record;
  for (std::size_t row = 0; row < record.rows(); ++row) {
    const double e = record["eps_dev"][row], leg = record["segment"][row];
    if (row > 0 && leg > record["segment"][row - 1]) continue;
    const double strain = leg == 0 ? e : leg == 1 ? 0.28 - e : e + 0.16;
    const double expected = leg == 0 ? 0.6567 + (0.6652 - 0.6567) * std::exp(-std::pow(strain / 0.102, 1.37))
                                     : 0.6567 + (0.6621 - 0.6567) * std::exp(-std::pow(strain / 0.17, 1.37));
    EXPECT_NEAR(record["phi_J"][row], expected, 1e-12) << e;
    const bool jammed = 0.6593 > expected;
    EXPECT_EQ(record["P"][row] > 0, jammed);
    if (!jammed) {
      for (const char* column : {"P", "sigma_dev", "F_dev", "C", "f_NR"}) EXPECT_EQ(record[column][row], 0);
    }
  }
}

TEST(Minimal, TheStrainToJamIsThatOfTheThesis) {
  for (const auto& [nu, strain] : {std::pair{0.6584, 0.1444}, {0.6593, 0.1154}, {0.66, 0.0980}}) {
    const Record record = predict_minimal(near_jamming(),
                                          path_of(R"({"start": {"nu": )" + to_text(nu) +
                                                  R"(, "phi_J": 0.6652}, "segments": [
        {"mode": "d2", "amount": 0.2}]})"),
                                          20000)
                              .record;
    std::size_t row = 0;
    while (record["P"][row] == 0) ++row;
    EXPECT_NEAR(record["eps_dev"][row], strain, 1e-4);
  }
}

/// By Eqs. 5.3 and 5.13 inverted for phi_J = nu; a reversal at nu <= phi_cr unjams where it comes.
TEST(Minimal, TellsWhereItJamsAndUnjams) {
  const auto strain = [](double from, double eps0) {
    return eps0 * std::pow(-std::log((0.6593 - 0.6567) / (from - 0.6567)), 1 / 1.37);
  };
  const auto at = [](double eps_dev) { return " at nu = 0.6593, eps_dev = " + shown(eps_dev); };
  const std::string jams = "jams", unjams = "unjams: loses its pressure";
  const double first = strain(0.6652, 0.102), again = strain(0.6621, 0.17);
  for (const int rows : {1, 40})
    EXPECT_THAT(run(shear_cycle, rows).warnings,
                ElementsAre(jams + at(first), unjams + at(0.28), jams + at(0.28 - again), unjams + at(-0.16),
                            jams + at(-0.16 + again)));
}

/// Volume and shear together, through jamming more than once on one leg: as the rows of a fine table have it.
TEST(Minimal, TellsOfEveryPassageThroughJamming) {
  for (const char* segments :
       {R"({"mode": "iso", "controls": {"nu": 0.7}}, {"mode": "iso", "controls": {"nu": 0.64}},
           {"mode": "iso", "controls": {"nu": 0.7}})",
        R"({"mode": "uni", "controls": {"nu": 0.7}}, {"mode": "uni", "controls": {"nu": 0.6}})",
        R"({"mode": "d2", "amount": 0.3}, {"mode": "iso", "amount": -0.003}, {"mode": "d2", "amount": -0.3},
           {"mode": "iso", "amount": 0.05}, {"mode": "iso", "amount": -0.06}, {"mode": "d2", "amount": 0.3})"}) {
    const Prediction p =
        run(R"({"start": {"nu": 0.66, "phi_J": 0.6652}, "segments": [)" + std::string(segments) + "]}", 5000);
    std::size_t passages = 0, told = 0;
    for (std::size_t row = 1; row < p.record.rows(); ++row)
      passages += (p.record["P"][row] > 0) != (p.record["P"][row - 1] > 0) ? 1 : 0;
    for (const std::string& warning : p.warnings) told += warning.find("jams") < 3 ? 1 : 0;
    EXPECT_GT(passages, 1u);
    EXPECT_EQ(told, passages) << segments;
  }
}

TEST(Minimal, EverythingElseFollowsFromTheDistanceToJamming) {
  const Record record = run(R"({"start": {"nu": 0.7, "phi_J": 0.664}, "segments": [
      {"mode": "d2", "amount": 2}]})")
                            .record;
  const double x = 0.7 / 0.6567 - 1, C_star = 6 + 8.1 * std::pow(x, 0.58),
               f_NR = 1 - 0.16 * std::exp(-15 * x);
  const std::size_t end = record.rows() - 1;
  EXPECT_NEAR(record["phi_J"][end], 0.6567, 1e-12);
  EXPECT_NEAR(record["C_star"][end], C_star, 1e-9);
  EXPECT_NEAR(record["f_NR"][end], f_NR, 1e-9);
  EXPECT_NEAR(record["P"][end], 0.042 * (1 + x) * C_star * f_NR * std::log(1 + x), 1e-9);
  EXPECT_NEAR(record["s_dev"][end], 0.12 + 0.091 * std::exp(-7.9 * x), 1e-9);
  EXPECT_NEAR(record["F_dev"][end], 0.17 * std::exp(-5.3 * x), 1e-9);
}

TEST(Minimal, CyclesOfCompressionFollowEquation5_1) {
  const Prediction p = run(R"({"start": {"nu": 0.64}, "segments": [{"repeat": 300, "segments": [
      {"mode": "iso", "controls": {"nu": 0.73}}, {"mode": "iso", "controls": {"nu": 0.64}}]}]})",
                           1);
  const auto over = near_jamming().memory->over_compression();
  const auto& phi_J = p.record["phi_J"];
  for (const std::size_t M : {1, 2, 10, 300})
    EXPECT_NEAR(phi_J[2 * M - 1], jamming_density_after(over, 0.73, static_cast<double>(M)), 1e-6);
  EXPECT_EQ(p.status.code, Status::Code::unjammed);
}

TEST(Minimal, AboveTheCriticalDensityAReversalLeavesItAlone) {
  const char* path = R"({"start": {"nu": 0.663, "phi_J": 0.6652}, "segments": [
      {"mode": "d2", "amount": 0.3}, {"mode": "d2", "amount": -0.3}]})";
  const Record above = run(path).record;
  for (std::size_t row = 41; row < above.rows(); ++row) EXPECT_GT(above["P"][row], 0);
  const Record below = run(path, 40, 0.6645).record;
  EXPECT_EQ(below["P"][42], 0);
  EXPECT_GT(below["P"].back(), 0);
}

TEST(Minimal, StressRatioAndFabricGoOnFromWhereAReversalFoundThem) {
  const Record record = run(R"({"start": {"nu": 0.7, "phi_J": 0.664}, "segments": [
      {"mode": "d2", "amount": 2}, {"mode": "d2", "amount": -1e-6}]})",
                            1)
                            .record;
  for (const char* column : {"s_dev", "F_dev"}) {
    EXPECT_GT(record[column][1], 0.1) << column;
    EXPECT_NEAR(record[column][2], record[column][1], 1e-4) << column;
  }
}

/// The second column of Table 5.1, however little Eq. 5.13 has forgotten.
TEST(Minimal, AfterAReversalThatUnjamsContactsAreThoseOfShear) {
  const Record record = run(shear_cycle).record;
  std::size_t jammed = 0;
  for (std::size_t row = 0; row < record.rows(); ++row) {
    if (record["segment"][row] != 1 || record["P"][row] == 0 || record["eps_dev"][row] > 0.2799) continue;
    const double x = 0.6593 / record["phi_J"][row] - 1;
    EXPECT_NEAR(record["C_star"][row], 6 + 8.1 * std::pow(x, 0.58), 1e-9);
    ++jammed;
  }
  EXPECT_GT(jammed, 10u);
}

TEST(Minimal, OneStepIsAsGoodAsMany) {
  const Minimal law{minimal_laws(near_jamming())};
  MinimalState start;
  start.point.nu = 0.65;
  start.point.history = {0.6567, 0.65, 0.65};
  law.settle(start);
  const MinimalState once = law.after(start, 0.12, 0.1);
  MinimalState many = start;
  for (int i = 0; i < 1000; ++i) many = law.after(many, 0.12e-3, 0.1e-3);
  EXPECT_NEAR(once.point.P, many.point.P, 1e-12);
  EXPECT_NEAR(once.point.sigma_dev, many.point.sigma_dev, 1e-12);
  EXPECT_NEAR(once.point.phi_J, many.point.phi_J, 1e-12);
}

TEST(Minimal, BelowTheShearJammingDensityNothingJams) {
  for (const double nu : {0.60, 0.6567}) {
    const Prediction p = run(R"({"start": {"nu": )" + to_text(nu) +
                             R"(, "phi_J": 0.6652}, "segments": [{"mode": "d2", "amount": 20},
        {"mode": "d2", "amount": -20}]})");
    for (const double P : p.record["P"]) EXPECT_EQ(P, 0);
  }
}

/// Exactly at phi_J nothing pushes; any shear jams it, any decompression unjams it again.
TEST(Minimal, ExactlyAtTheJammingDensity) {
  const Record shear =
      run(R"({"start": {"nu": 0.6652, "phi_J": 0.6652}, "segments": [{"mode": "d2", "amount": 1e-6}]})")
          .record;
  EXPECT_EQ(shear["P"].front(), 0);
  EXPECT_GT(shear["P"].back(), 0);
  const Record compressed = run(R"({"start": {"nu": 0.6652, "phi_J": 0.6652}, "segments": [
      {"mode": "iso", "amount": 1e-3}, {"mode": "iso", "amount": -2e-3}]})",
                                1)
                                .record;
  EXPECT_GT(compressed["P"][1], 0);
  EXPECT_EQ(compressed["P"][2], 0);
}

/// At phi_cr itself a reversal takes P away, and shear on brings it back from 0.
TEST(Minimal, ExactlyAtTheCriticalDensity) {
  for (const auto& [nu, unjams] : {std::pair{0.6621, true}, {std::nextafter(0.6621, 1.0), false}}) {
    const Record record = run(R"({"start": {"nu": )" + to_text(nu) + R"(, "phi_J": 0.6652}, "segments": [
        {"mode": "d2", "amount": 0.3}, {"mode": "d2", "amount": -1e-9}, {"mode": "d2", "amount": -0.4}]})",
                              1)
                              .record;
    EXPECT_GT(record["P"][1], 0);
    EXPECT_EQ(record["P"][2] < 1e-12, unjams) << nu;
    EXPECT_GT(record["P"][3], 0);
  }
}

/// A reversal where a reversal has unjammed it begins Eq. 5.13 anew.
TEST(Minimal, ReversalInTheFragileRegime) {
  const Record record = run(R"({"start": {"nu": 0.66, "phi_J": 0.6652}, "segments": [
      {"mode": "d2", "amount": 0.3}, {"mode": "d2", "amount": -0.02}, {"mode": "d2", "amount": 0.02},
      {"mode": "d2", "amount": 0.3}]})",
                            1)
                            .record;
  EXPECT_GT(record["P"][1], 0);
  EXPECT_EQ(record["P"][2], 0);
  EXPECT_EQ(record["P"][3], 0);
  EXPECT_NEAR(record["phi_J"][3], 0.6567 + (0.6621 - 0.6567) * std::exp(-std::pow(0.02 / 0.17, 1.37)), 1e-12);
  EXPECT_GT(record["P"][4], 0);
}

/// M = 0, phi_max < phi_SJ, 10^4 cycles, one huge compression.
TEST(Minimal, CompressionsOfEverySize) {
  EXPECT_EQ(run(R"({"start": {"nu": 0.64}, "segments": [{"mode": "d2", "amount": 1}]})").end.phi_J, 0.6567);
  EXPECT_EQ(run(R"({"start": {"nu": 0.64}, "segments": [{"mode": "iso", "controls": {"nu": 0.65}},
      {"mode": "iso", "controls": {"nu": 0.64}}]})")
                .end.phi_J,
            0.6567);
  const auto over = near_jamming().memory->over_compression();
  EXPECT_NEAR(run(R"({"start": {"nu": 0.64}, "segments": [{"repeat": 10000, "segments": [
      {"mode": "iso", "controls": {"nu": 0.73}}, {"mode": "iso", "controls": {"nu": 0.64}}]}]})",
                  1)
                  .end.phi_J,
              jamming_density_after(over, 0.73, 1e4), 2e-6);
  const Prediction huge =
      run(R"({"start": {"nu": 0.64}, "segments": [{"mode": "iso", "controls": {"nu": 0.99}},
      {"mode": "d2", "amount": 0.5}, {"mode": "iso", "controls": {"nu": 0.64}}]})",
          1);
  EXPECT_GT(huge.record["P"][1], 0.2);
  EXPECT_LT(huge.end.phi_J, jamming_density_after(over, 0.99, 1.0));
  EXPECT_FALSE(huge.end.jammed);
}

/// Group near_jamming stands in place of isotropic and shear, and only there.
TEST(Minimal, NumbersNearJammingTakeThePlaceOfThoseOfTheWholeRange) {
  const ParameterSet tables = near_jamming();
  ParameterSet set = thesis();
  set.memory = tables.memory;
  const Record whole = predict_minimal(set, path_of(shear_cycle)).record;
  set.near_jamming =
      NearJammingLaws{tables.isotropic.at("iso"), tables.isotropic.at("d2"), *tables.shear->s_max,
                      *tables.shear->beta_s,      *tables.shear->F_max,      *tables.shear->beta_F};
  const auto again = ParameterSet::read(Reader(set.to_json(), "written"));
  const Record near = predict_minimal(again, path_of(shear_cycle)).record,
               expected = predict_minimal(tables, path_of(shear_cycle)).record;
  for (const char* column : {"P", "sigma_dev", "F_dev", "C", "f_NR", "phi_J"})
    for (std::size_t row = 0; row < near.rows(); ++row)
      EXPECT_EQ(near[column][row], expected[column][row]) << column << ' ' << row;
  EXPECT_GT(std::abs(whole["P"].back() - near["P"].back()), 1e-5);
  const Path shear = path_of(R"({"start": {"nu": 0.7}, "segments": [{"mode": "d2", "amount": 0.1}]})");
  EXPECT_EQ(predict(again, shear).record["P"].back(), predict(thesis(), shear).record["P"].back());
  set.near_jamming->F_max.Q_v.value = std::nan("");
  EXPECT_THAT(refusal([&] { minimal_laws(set); }),
              HasSubstr("near_jamming.F_max.Q_v: must be a finite number"));
}

TEST(Minimal, WhatItCannotTakeIsRefused) {
  const auto refused = [](const std::string& path) { return refusal([&] { run(path); }); };
  const std::string shear = R"("segments": [{"mode": "d2", "amount": 0.1}]})";
  EXPECT_THAT(refused(R"({"start": {}, )" + shear), HasSubstr("start.nu: is missing"));
  EXPECT_THAT(refused(R"({"start": {"nu": 0.7, "F_dev": 0.1}, )" + shear), HasSubstr("start.F_dev"));
  EXPECT_THAT(refused(R"({"start": {"nu": 0.7, "phi_max": 0.69}, )" + shear),
              HasSubstr("phi_max: must be >= start.nu"));
  EXPECT_THAT(refused(R"({"start": {"nu": 0.7}, "segments": [{"mode": "d2", "amount": 0.1},
      {"mode": "uni", "amount": 0.1}]})"),
              HasSubstr("not coaxial"));
  EXPECT_THAT(refused(R"({"start": {"nu": 0.7}, "segments": [{"mode": "triaxial", "amount": 0.1}]})"),
              HasSubstr("must prescribe strains"));
  ParameterSet set = near_jamming();
  set.memory.reset();
  EXPECT_THAT(refusal([&] { minimal_laws(set); }), HasSubstr("the minimal form"));
  set = near_jamming();
  set.memory->eps0.value = std::nan("");
  EXPECT_THAT(refusal([&] { minimal_laws(set); }), HasSubstr("memory.eps0: must be a finite number"));
}

}  // namespace
}  // namespace grainlaw::model
