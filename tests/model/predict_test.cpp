// Predictions as records: columns, rows, samples of another record, refusals, statuses.
#include "grainlaw/model/predict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* mixed = R"({"start": {"nu": 0.69}, "segments": [
    {"mode": "uni", "amount": 0.05}, {"mode": "relax"}, {"mode": "d3", "amount": -0.1}, {"mode": "iso", "amount": 0.02}]})";

std::string refused(const std::string& segments) {
  return refusal([&] { walk(R"({"start": {"nu": 0.7}, "segments": [)" + segments + "]}", Form::reduced); });
}

TEST(Predict, WritesTheAgreedColumnsAndRows) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    const Prediction p = walk(mixed, form, 10);
    EXPECT_EQ(p.record.columns(), prediction_columns());
    ASSERT_EQ(p.record.rows(), 1U + 10 + 1 + 10 + 10);
    EXPECT_EQ(p.record["segment"].front(), 0);
    EXPECT_EQ(p.record["segment"][11], 1);
    EXPECT_EQ(last(p, "segment"), 3);
    EXPECT_NEAR(last(p, "eps_vol"), 0.07, 1e-14);
    EXPECT_NEAR(last(p, "eps_dev"), -0.05, 1e-14);
    EXPECT_NEAR(last(p, "nu"), 0.69 * std::exp(0.07), 1e-14);
    for (std::size_t i = 0; i < p.record.rows(); ++i) {
      const auto at = [&](const char* column) { return p.record[column][i]; };
      EXPECT_NEAR(at("nu"), 0.69 * std::exp(at("eps_vol")), 1e-14);
      EXPECT_NEAR(at("s_dev"), at("sigma_dev") / at("P"), 1e-15);
      EXPECT_NEAR(at("C"), at("f_NR") * at("C_star"), 1e-14);
      EXPECT_NEAR(at("F_v"), 1.22 * at("nu") * at("C"), 1e-14);
      EXPECT_EQ(at("phi_J"), 0.6649);
    }
    EXPECT_EQ(p.status.code, Status::Code::ok);
  }
}

TEST(Predict, UnjammedRowsCarryNothing) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    const Prediction p =
        walk(R"({"start": {"nu": 0.64}, "segments": [{"mode": "iso", "controls": {"nu": 0.82}},
        {"mode": "iso", "controls": {"nu": 0.64}}]})",
             form);
    int unjammed = 0;
    for (std::size_t i = 0; i < p.record.rows(); ++i) {
      const bool jammed = p.record["nu"][i] > 0.665;
      EXPECT_EQ(p.record["P"][i] > 0, jammed);
      EXPECT_EQ(std::isnan(p.record["s_dev"][i]), !jammed);
      EXPECT_EQ(std::isnan(p.record["C_star"][i]), !jammed);
      EXPECT_EQ(p.record["F_v"][i] > 4, jammed);
      unjammed += !jammed;
    }
    EXPECT_GT(unjammed, 4);
    EXPECT_EQ(p.status.code, Status::Code::unjammed);
    EXPECT_THAT(p.status.message, HasSubstr("nu = 0.64"));
    ASSERT_EQ(p.warnings.size(), 2U);
    EXPECT_THAT(p.warnings[0], HasSubstr("jams at nu = 0.6649"));
    EXPECT_THAT(p.warnings[1], HasSubstr("unjams"));
    EXPECT_NO_THROW(p.record.to_csv());
  }
}

TEST(Predict, FollowsTheRowsOfAnotherRecord) {
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    const Path path = path_of(mixed);
    const Prediction fine = walk(mixed, form, 12);
    Record rows({"segment", "eps_vol", "eps_dev"});
    for (const std::size_t i : {0, 3, 6, 12, 13, 17, 25, 26, 37})
      rows.append({fine.record["segment"][i], fine.record["eps_vol"][i], fine.record["eps_dev"][i]});
    const auto samples = samples_of(rows, path, 0.69);
    const Prediction p = predict(thesis(), path, samples, {form, tight_rtol, tight_atol, 1});
    ASSERT_EQ(p.record.rows(), rows.rows());
    std::size_t row = 0;
    for (const std::size_t i : {0, 3, 6, 12, 13, 17, 25, 26, 37}) {
      for (const char* column : {"segment", "eps_vol", "eps_dev", "nu", "P", "sigma_dev", "F_dev"})
        EXPECT_NEAR(p.record[column][row], fine.record[column][i], 1e-11) << column << " in row " << i;
      ++row;
    }
  }
}

TEST(Predict, ARowOffThePathIsRefused) {
  const Path path = path_of(mixed);
  const auto refusal_of = [&](const std::vector<double>& row) {
    Record rows({"segment", "eps_vol", "eps_dev"});
    rows.append({0, 0, 0});
    rows.append(row);
    return refusal([&] { samples_of(rows, path, 0.69); });
  };
  EXPECT_EQ(refusal_of({0, 0.0502, 0.0502}), "accepted");  // a time step too far
  EXPECT_THAT(refusal_of({0, 0.06, 0.06}), HasSubstr("row 2 of the record is not on segment 0"));
  EXPECT_THAT(refusal_of({4, 0.06, 0.06}), HasSubstr("the path has 4"));
}

TEST(Predict, SamplesMustBeInOrder) {
  const auto refused_samples = [](const std::vector<Sample>& samples) {
    return refusal([&] { predict(thesis(), path_of(mixed), samples, {}); });
  };
  EXPECT_EQ(refused_samples({{0, 0.5}, {0, 0.5}, {2, 0.1}}), "accepted");
  EXPECT_THAT(refused_samples({{0, 0.5}, {0, 0.4}}), HasSubstr("in order"));
  EXPECT_THAT(refused_samples({{2, 0.5}, {1, 0.6}}), HasSubstr("in order"));
  EXPECT_THAT(refused_samples({{4, 0.5}}), HasSubstr("leg 4"));
  EXPECT_THAT(refused_samples({{0, 1.5}}), HasSubstr("progress 1.5"));
}

TEST(Predict, RefusesAnotherDirectionOfShear) {
  EXPECT_THAT(refused(R"({"mode": "uni", "amount": 0.02}, {"mode": "d2", "amount": 0.1})"),
              HasSubstr("p.json: segments[1]: mode d2 is not coaxial with uni"));
  EXPECT_THAT(
      refused(
          R"({"mode": "d2", "amount": 0.1}, {"mode": "iso", "amount": 0.1}, {"mode": "d3", "amount": 0.1})"),
      HasSubstr("segments[2]"));
  EXPECT_THAT(refused(R"({"mode": "d2", "amount": 0.1}, {"mode": "components", "strain": [0.1, 0, 0]})"),
              HasSubstr("not coaxial"));
  EXPECT_EQ(
      refused(
          R"({"mode": "uni", "amount": 0.02}, {"mode": "iso", "amount": -0.01}, {"mode": "d3", "amount": -0.1})"),
      "accepted");
  EXPECT_EQ(
      refused(R"({"mode": "d2", "amount": 0.1}, {"mode": "components", "strain": [0.11, -0.09, 0.01]})"),
      "accepted");
}

TEST(Predict, ComponentsAreTheModesTheySpell) {
  const Prediction mode =
      walk(R"({"start": {"nu": 0.7}, "segments": [{"mode": "uni", "amount": 0.05}]})", Form::coupled);
  const Prediction spelled =
      walk(R"({"start": {"nu": 0.7}, "segments": [{"mode": "components", "strain": [0, 0, 0.05]}]})",
           Form::coupled);
  for (const char* column : {"eps_dev", "P", "sigma_dev", "F_dev"})
    EXPECT_LT(difference(mode, spelled, column), 1e-13) << column;
}

TEST(Predict, RelaxRestartsTheDirection) {
  const std::string before = R"({"start": {"nu": 0.711}, "segments": [{"mode": "d2", "amount": 0.05},)";
  const Prediction rested =
      walk(before + R"({"mode": "relax"}, {"mode": "d2", "amount": 0.01}]})", Form::coupled, 1);
  const Prediction straight = walk(before + R"({"mode": "d2", "amount": 0.01}]})", Form::coupled, 1);
  ASSERT_EQ(rested.record.rows(), 4U);
  for (const char* column : {"P", "sigma_dev", "F_dev"}) {
    EXPECT_EQ(rested.record[column][1], rested.record[column][2])
        << column;                                                      // the rest itself changes nothing
    EXPECT_GT(last(rested, column), last(straight, column)) << column;  // what follows begins elastic
  }
}

TEST(Predict, FailureKeepsTheRowsBefore) {
  ParameterSet set = thesis();
  set.shear->s_max->Q_max.value = -0.05;
  const Prediction p = walk(R"({"start": {"nu": 0.7}, "segments": [{"mode": "d2", "amount": 0.1},
      {"mode": "relax"}, {"mode": "d2", "amount": 0.1}, {"mode": "components", "strain": [0.06, 0.12, 0.09]}]})",
                            Form::coupled, 10, set);
  EXPECT_EQ(p.status.code, Status::Code::failed);
  EXPECT_THAT(p.status.message, HasSubstr("segments[3]: s_max is -0.0"));
  EXPECT_EQ(p.record.rows(), 1U + 10 + 1 + 10);
}

TEST(Predict, ContactsAreThereWherePressureIs) {
  // Contacts of the D2 row begin at 0.6601, the pressure of the D2 row at 0.6581.
  ParameterSet set = thesis();
  set.closure = {"d2", "d2", false};
  for (const Form form : {Form::reduced_closed, Form::reduced}) {
    const Prediction p =
        walk(R"({"start": {"nu": 0.657}, "segments": [{"mode": "iso", "controls": {"nu": 0.662}}]})", form,
             50, set);
    const auto &P = p.record["P"], &nu = p.record["nu"], &C_star = p.record["C_star"];
    EXPECT_EQ(p.record["phi_J"].back(), 0.6581);
    int below = 0;
    for (std::size_t i = 0; i < p.record.rows(); ++i) {
      EXPECT_EQ(P[i] > 0, nu[i] > 0.6581);
      EXPECT_LT(P[i] - P[i == 0 ? 0 : i - 1], 5e-5);  // no jump
      EXPECT_EQ(std::isfinite(C_star[i]), P[i] > 0);
      if (P[i] == 0 || nu[i] > 0.6601) continue;
      ++below;
      EXPECT_EQ(C_star[i], 6);
      EXPECT_NEAR(p.record["f_NR"][i], 1 - 0.1363, 1e-14);
      EXPECT_NEAR(p.record["F_v"][i], 1.22 * nu[i] * 6 * (1 - 0.1363), 1e-13);
    }
    EXPECT_GT(below, 10);
  }
}

/// A set that pumps: fast growth of fabric, as the quick campaign's fit has it.
ParameterSet pumping() {
  ParameterSet set = thesis();
  set.shear->beta_F->Q_v.value = 114;
  return set;
}

std::vector<std::string> warnings_of(const std::string& segments, const ParameterSet& set,
                                     Form form = Form::coupled) {
  return walk(R"({"start": {"nu": 0.711}, "segments": [)" + segments + "]}", form, 1, set).warnings;
}

std::string d2_to(double eps_dev) {
  return R"({"mode": "d2", "controls": {"eps_dev": )" + to_text(eps_dev) + "}}";
}

TEST(Predict, FollowsTheMeasuredStrainOfStressControl) {
  const auto path = [](const std::string& segments) {
    return Path::read(Reader(parse_json(R"({"segments": [)" + segments + "]}", "p.json"), "p.json"));
  };
  const std::string shear =
      R"({"mode": "relax"}, {"mode": "d2", "amount": 0.1}, {"mode": "iso", "amount": 0.02}])";
  const Prediction direct = walk(R"({"start": {"nu": 0.7}, "segments": [)" + shear + "}", Form::coupled);
  // The same strain, as if grains under constant pressure had taken it.
  const Path asked = path(
      R"({"mode": "relax"}, {"mode": "constant_p", "amount": 0.1}, {"mode": "isotropic_stress", "P": 0.1})");
  const MeasuredPath measured = measured_path(direct.record, asked);
  ASSERT_EQ(measured.samples.size(), direct.record.rows());
  const Prediction p = predict(thesis(), measured.path, measured.samples);
  for (const char* column : {"nu", "eps_dev", "P", "sigma_dev", "F_dev"})
    for (std::size_t i = 0; i < p.record.rows(); ++i)
      EXPECT_NEAR(p.record[column][i], direct.record[column][i], 1e-6) << column << " in row " << i;
  EXPECT_EQ(measured.segments, direct.record["segment"]);
  EXPECT_THROW(predict(thesis(), asked), Error);
  // Along another axis it is the same to the law.
  const MeasuredPath sheared = measured_path(
      direct.record,
      path(
          R"({"mode": "relax"}, {"mode": "control", "x": {"strain": 0}, "y": {"strain": 0}, "z": {"strain": 0},
               "xy": {"strain": -0.05}, "P": "start"}, {"mode": "isotropic_stress", "P": 0.1})"));
  const StrainTensor& one = sheared.path.segments.at(10).strain;
  EXPECT_EQ(one[0], one[1]);
  EXPECT_LT(one[5], 0);
  const Prediction q = predict(thesis(), sheared.path, sheared.samples);
  for (const char* column : {"nu", "eps_dev", "P", "sigma_dev", "F_dev"})
    EXPECT_LT(difference(p, q, column), 1e-10) << column;
}

TEST(Predict, SaysHowMuchPressureIsPumped) {
  const std::string cycle = d2_to(0.4) + "," + d2_to(-0.4) + "," + d2_to(0.4);
  const Prediction p =
      walk(R"({"start": {"nu": 0.711}, "segments": [)" + cycle + "]}", Form::coupled, 1, pumping());
  const auto& P = p.record["P"];
  const double drift = 100 * (std::sqrt(P[3] / P[1]) - 1);
  EXPECT_GT(drift, 1);
  ASSERT_EQ(p.warnings.size(), 1U);
  char said[64];
  std::snprintf(said, sizeof said, "gains up to %.1f %% of P per half cycle", drift);
  EXPECT_THAT(p.warnings[0], HasSubstr(said));
  EXPECT_TRUE(warnings_of(cycle, pumping(), Form::reduced).empty());
  // Legs may be cut, and rests are none.
  const std::string cut = d2_to(0.1) + "," + d2_to(0.4) + R"(, {"mode": "relax"},)" + d2_to(0) + "," +
                          d2_to(-0.4) + "," + d2_to(0.4);
  EXPECT_EQ(warnings_of(cut, pumping()).size(), 1U);
}

/// The thesis's own numbers, with P of Table 4.1's in Eq. 2.14: 0.8 to 0.9 % a half cycle.
TEST(Predict, SaysThatTheThesisSetPumps) {
  const auto said = walk(R"({"start": {"nu": 0.711, "P": 0.0264}, "segments": [)" + d2_to(0.4) + "," +
                             d2_to(-0.4) + "," + d2_to(0.4) + "]}",
                         Form::coupled, 1)
                        .warnings;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_THAT(said[0], testing::AnyOf(HasSubstr("up to 0.8 % of P"), HasSubstr("up to 0.9 % of P")));
}

TEST(Predict, DoesNotTakeATransientForPumping) {
  const std::string cycle = d2_to(0.4) + "," + d2_to(-0.4) + "," + d2_to(0.4);
  EXPECT_TRUE(warnings_of(cycle + "," + d2_to(-0.4) + "," + d2_to(0.4), thesis()).empty());  // 0.08 %
  // First loading, in part and in full; the recovery from a dip; another volume.
  EXPECT_TRUE(warnings_of(d2_to(0.01) + "," + d2_to(0) + "," + d2_to(0.4), pumping()).empty());
  EXPECT_TRUE(warnings_of(d2_to(0.4) + "," + d2_to(-0.4), pumping()).empty());
  for (const std::string& warning :
       warnings_of(d2_to(0.4) + R"(, {"mode": "iso", "amount": 0.05},)" + d2_to(0) +
                       R"(, {"mode": "iso", "amount": -0.03},)" + d2_to(0.4),
                   pumping()))
    EXPECT_THAT(warning, Not(HasSubstr("per half cycle")));
}

TEST(Predict, SaysHowFarBeyondSaturationVolumeChangesGo) {
  const auto down = warnings_of(d2_to(0.4) + R"(, {"mode": "iso", "controls": {"nu": 0.675}})", thesis());
  ASSERT_EQ(down.size(), 1U);
  EXPECT_THAT(down[0], HasSubstr("s_dev goes to 2.17"));
  EXPECT_THAT(down[0], HasSubstr(" s_max at nu = 0.675, eps_dev = 0.4"));
  const auto up = warnings_of(d2_to(0.4) + R"(, {"mode": "iso", "controls": {"nu": 0.75}})", thesis());
  ASSERT_EQ(up.size(), 1U);
  EXPECT_THAT(up[0], HasSubstr("F_dev goes to 1.3"));
  EXPECT_TRUE(warnings_of(d2_to(0.4), thesis()).empty());
}

TEST(Predict, EveryThesisMaterialPredicts) {
  for (const auto& entry : std::filesystem::directory_iterator(thesis_file().parent_path())) {
    if (entry.path().extension() != ".json") continue;
    const ParameterSet set = ParameterSet::load(entry.path());
    if (!set.shear->beta_s) continue;  // w = 1
    for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
      const Prediction p =
          walk(R"({"start": {"nu": 0.64}, "segments": [{"mode": "uni", "controls": {"nu": 0.8}},
          {"mode": "uni", "controls": {"nu": 0.72}}]})",
               form, 20, set);
      EXPECT_EQ(p.status.code, Status::Code::ok) << entry.path() << p.status.message;
      EXPECT_LT(last(p, "s_dev"), 0) << entry.path();
      EXPECT_NO_THROW(p.record.to_csv());
    }
  }
}

}  // namespace
}  // namespace grainlaw::model
