// Moduli by a table: the curve between its rows, and the coupled form that takes it, against an independent
// integration, on every way of walking; bad tables and paths beyond it.
#include "grainlaw/model/laws/moduli_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/model/forms/law.hpp"
#include "grainlaw/model/light/light_batch.hpp"
#include "walks.hpp"
#include "written.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;
using Columns = std::array<std::vector<double>, ModuliTable::columns>;

/// Of docs/moduli.md, by density.
const ModuliTable measured({0.68, 0.705, 0.725, 0.75, 0.81}, Columns{{{0.330, 0.412, 0.467, 0.532, 0.674},
                                                                      {0.81, 0.75, 0.68, 0.61, 0.59},
                                                                      {1.24, 1.19, 1.12, 1.05, 1.26},
                                                                      {0.256, 0.385, 0.427, 0.456, 0.502},
                                                                      {13, 163, 142, 102, 148}}});

TEST(ModuliTable, GoesThroughItsRowsAndIsMonotoneBetween) {
  const auto& nu = measured.nu();
  for (std::size_t k = 0; k < nu.size(); ++k) {
    const auto there = measured.at(nu[k]);
    EXPECT_NEAR(there.B, measured.values(ModuliTable::B)[k], 1e-15);
    EXPECT_NEAR(there.g_I, measured.values(ModuliTable::g_I)[k], 1e-12);
  }
  for (std::size_t k = 0; k + 1 < nu.size(); ++k) {
    const double a_II = measured.values(ModuliTable::a_II)[k + 1] - measured.values(ModuliTable::a_II)[k],
                 g_I = measured.values(ModuliTable::g_I)[k + 1] - measured.values(ModuliTable::g_I)[k];
    for (int i = 0; i < 20; ++i) {
      const double low = nu[k] + (nu[k + 1] - nu[k]) * i / 20,
                   high = nu[k] + (nu[k + 1] - nu[k]) * (i + 1) / 20;
      EXPECT_GT((measured.at(high).a_II - measured.at(low).a_II) * a_II, 0);
      EXPECT_GT((measured.at(high).g_I - measured.at(low).g_I) * g_I, 0);
    }
  }
}

TEST(ModuliTable, HasOneSlope) {
  for (const double nu : {0.69, 0.711, 0.8})
    expect_v_shape([](double x) { return measured.at(x).B; }, nu, measured.at(Dual<1>(nu, 0)).B.slope[0],
                   0.01);
  for (const double row : {0.705, 0.725, 0.75})
    EXPECT_NEAR(measured.at(Dual<1>(row * (1 - 1e-9), 0)).GB_ini.slope[0],
                measured.at(Dual<1>(row * (1 + 1e-9), 0)).GB_ini.slope[0], 1e-6);
  // Straight rows give a straight line.
  const std::vector<double> nu{0.6, 0.65, 0.8}, line{1.2, 1.3, 1.6};
  EXPECT_NEAR(ModuliTable(nu, {line, line, line, line, line}).at(0.7).a_I, 1.4, 1e-15);
}

TEST(ModuliTable, SaysNothingBeyondIt) {
  EXPECT_FALSE(measured.covers(0.679));
  EXPECT_TRUE(std::isnan(measured.at(0.679).B));
  EXPECT_TRUE(std::isnan(measured.at(0.811).g_I));
  EXPECT_TRUE(measured.covers(0.81 * (1 + 1e-15)));
}

ParameterSet with_table(const ModuliTable& table = measured) {
  ParameterSet set = thesis();
  set.moduli_table.emplace().table = table;
  return set;
}

/// A straight table, written down anew.
struct Straight : Written {
  static double line(double low, double high, double n) { return low + (high - low) * (n - 0.68) / 0.13; }
  void operator()(const Vector& y, Vector& dy, double t) const {
    const double n = nu(t), B = line(0.33, 0.674, n);
    const double S = (1 - q() * y[1] / y[0] / s_max(n)) / S_I;
    Written::operator()(y, dy, t);
    dy[0] = B * v + line(0.81, 0.59, n) * B * y[2] * S * e;
    dy[1] = line(1.24, 1.26, n) * B * y[2] * v +
            B * (line(0.256, 0.502, n) - line(13, 148, n) * y[1] * y[2]) * S * e;
  }
};
const ModuliTable straight({0.68, 0.81},
                           Columns{{{0.33, 0.674}, {0.81, 0.59}, {1.24, 1.26}, {0.256, 0.502}, {13, 148}}});

constexpr const char* there_and_back =
    R"({"start": {"nu": 0.69, "P": 0.012, "sigma_dev": -0.001, "F_dev": 0.03}, "segments": [
    {"mode": "uni", "amount": 0.12}, {"mode": "uni", "amount": -0.08}]})";

TEST(Tabulated, AgainstAnIndependentIntegration) {
  const Prediction p = walk(there_and_back, choice_of("coupled+moduli_table"), 20, with_table(straight));
  expect_agreement<Straight>(0.69, {0.012, -0.001, 0.03}, {{0.12, 0.12}, {-0.08, -0.08}}, p, 20);
}

/// With many rows of the thesis's own laws, and its a_I, a_II and g_I, it is the coupled form.
TEST(Tabulated, WithRowsOfTheLawsItIsTheCoupledForm) {
  const auto coupled = std::get<Coupled>(make_law(thesis(), Form::coupled));
  std::vector<double> nu;
  Columns values;
  for (double x = 0.68; x < 0.8; x += 0.001) {
    const auto c = coupled.coefficients(x);
    nu.push_back(x);
    for (const auto& [column, number] : {std::pair{ModuliTable::B, c.B},
                                         {ModuliTable::a_I, 0.66},
                                         {ModuliTable::a_II, 1.0},
                                         {ModuliTable::GB_ini, c.ratio_ini},
                                         {ModuliTable::g_I, 86.0}})
      values[column].push_back(number);
  }
  const Prediction laws = walk(there_and_back, Form::coupled),
                   table = walk(there_and_back, choice_of("coupled+moduli_table"), 20,
                                with_table(ModuliTable(nu, values)));
  for (const char* column : {"P", "sigma_dev", "F_dev"}) {
    EXPECT_LT(difference(laws, table, column), 1e-7) << column;
    EXPECT_EQ(difference(laws, walk(there_and_back, Form::coupled, 20, with_table()), column), 0)
        << "off unless asked for";
  }
}

State start_at(const Law& law, double nu) {
  State state;
  state.nu = nu;
  state.P = pressure(laws_of(law).pressure, nu);
  state.phi_J = jamming_density(laws_of(law).pressure);
  state.jammed = true;
  return state;
}

TEST(Tabulated, LightPathBatchAndTangent) {
  const LightLaw light(make_law(with_table(), choice_of("coupled+moduli_table")), {1e-10, 1e-14});
  const Prediction p = walk(R"({"start": {"nu": 0.7}, "segments": [{"mode": "uni", "amount": 0.02},
                                {"mode": "d3", "amount": -0.03}]})",
                            choice_of("coupled+moduli_table"), 2, with_table());
  State one = start_at(light.law(), 0.7);
  LightBatch batch(light, 9, one);
  for (const auto& [v, e] : {std::pair{0.02, 0.02}, {0.0, -0.03}}) {
    ASSERT_FALSE(light.update(one, v, e).failed());
    ASSERT_EQ(batch.update(std::vector<double>(9, v), std::vector<double>(9, e)).failed, 0U);
  }
  EXPECT_NEAR(one.P, last(p, "P"), 1e-10);
  EXPECT_NEAR(one.sigma_dev, last(p, "sigma_dev"), 1e-10);
  EXPECT_NEAR(batch.P()[8], one.P, 1e-12);
  Tangent tangent;
  State moved = one;
  ASSERT_FALSE(light.update(moved, 1e-3, -1e-3, tangent).failed());
  expect_v_shape(
      [&](double v) {
        State there = one;
        EXPECT_FALSE(light.update(there, v, -1e-3).failed());
        return there.sigma_dev;
      },
      1e-3, tangent.sigma_dev[0], 1e-2);
}

/// Another history moves the densities of the table with those of the laws.
TEST(Tabulated, AnotherHistoryMovesTheTable) {
  Law law = make_law(with_table(), choice_of("coupled+moduli_table"));
  const auto before = std::get<Tabulated>(law).coefficients(0.72);
  laws_of(law) = with_jamming_density(laws_of(law), 0.66);
  const auto after = std::get<Tabulated>(law).coefficients(0.72 * 0.66 / 0.6649);
  EXPECT_NEAR(after.B, before.B, 1e-14);
  EXPECT_NEAR(after.g_I, before.g_I, 1e-11);
}

TEST(Tabulated, PathsBeyondTheTableAreRefused) {
  const Law law = make_law(with_table(), choice_of("coupled+moduli_table"));
  const LightLaw light(law, {1e-8, 1e-12});
  const State start = start_at(law, 0.8);
  for (const double v : {0.02, -0.3}) {
    State state = start;
    const Status status = light.update(state, v, 1e-3);
    EXPECT_TRUE(status.failed());
    EXPECT_THAT(status.message, HasSubstr("the table of moduli goes from nu = 0.68 to 0.81, the path to 0."));
    EXPECT_EQ(state.P, start.P);
    const Prediction p =
        walk(R"({"start": {"nu": 0.8}, "segments": [{"mode": "uni", "amount": )" + std::to_string(v) + "}]}",
             choice_of("coupled+moduli_table"), 20, with_table());
    EXPECT_EQ(p.status.message, "segments[0]: " + status.message);
  }
  // Stress control comes to its end on the way.
  const Prediction p = walk(R"({"start": {"nu": 0.8}, "segments": [{"mode": "d2",
                                "controls": {"P": 0.2, "s_dev": 0.05}}]})",
                            choice_of("coupled+moduli_table"), 20, with_table());
  EXPECT_NE(p.status.code, Status::Code::ok);
  EXPECT_LE(last(p, "nu"), 0.8101);
}

TEST(Tabulated, RefusesTablesThatAreNone) {
  Json json = with_table().to_json();
  const auto refused = [&](const char* key, const Json& value) {
    Json bad = json;
    bad["moduli_table"][key] = value;
    return refusal([&] { ParameterSet::read(Reader(bad, "p.json")); });
  };
  EXPECT_EQ(ParameterSet::read(Reader(json, "p.json")).to_json(), json);
  EXPECT_THAT(refused("nu", {0.68, 0.705, 0.70, 0.75, 0.81}),
              HasSubstr("moduli_table.nu[2]: must be > the one before, 0.705, got 0.7"));
  EXPECT_THAT(refused("a_I", {0.7, 0.7}),
              HasSubstr("moduli_table.a_I: must have one number for each of the 5 nu, got 2"));
  EXPECT_THAT(refused("B", {0.3, 0.4, -0.5, 0.5, 0.6}),
              HasSubstr("moduli_table.B[2]: must be > 0, got -0.5"));
  EXPECT_THAT(refused("nu", Json::array({0.7})), HasSubstr("moduli_table.nu: must have at least 2 numbers"));
  EXPECT_THAT(refusal([] { make_law(thesis(), choice_of("coupled+moduli_table")); }),
              HasSubstr("moduli_table: is missing; the coupled+moduli_table form needs it"));
  EXPECT_THAT(refusal([] { choice_of("coupled+energy+moduli_table"); }), HasSubstr("not both"));
  EXPECT_THAT(refusal([] { choice_of("reduced+moduli_table"); }), HasSubstr("reduced takes the terms axial"));
}

}  // namespace
}  // namespace grainlaw::model
