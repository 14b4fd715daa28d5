// grainlaw predict: forms, units, rows, and following a record.
#include <gmock/gmock.h>

#include <cmath>

#include "grainlaw/element/record.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

using testing::HasSubstr;

class Predict : public Program {
 protected:
  Record predict(const Arguments& options, const std::string& path = "data/paths/d2-cycle.json",
                 const std::string& parameters = "data/thesis/parameters.json") {
    Arguments arguments{"predict", parameters, path, "-o", "p.csv"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    last = run(arguments);
    EXPECT_EQ(last.status, 0) << last.err;
    return Record::read_csv(folder / "p.csv");
  }
  Outcome last;
};

TEST_F(Predict, WritesTheColumnsOfAPrediction) {
  const Record record = predict({});
  EXPECT_EQ(record.columns(), prediction_columns());
  EXPECT_EQ(record.rows(), 301u);
  EXPECT_THAT(last.err, HasSubstr("start P "));
  EXPECT_EQ(last.out, "");
  // To standard output the very same.
  const Outcome outcome = run({"predict", "data/thesis/parameters.json", "data/paths/d2-cycle.json"});
  EXPECT_EQ(outcome.out, read("p.csv"));
}

TEST_F(Predict, InSIStressIsInkPa) {
  const Record plain = predict({}), si = predict({"--si"});
  ASSERT_TRUE(si.has("P_kPa") && si.has("sigma_dev_kPa"));
  EXPECT_FALSE(si.has("P") || si.has("sigma_dev"));
  // k* = k/(2<r>) = 1e8 kg/s^2 / 2e-3 m = 5e10 Pa
  for (std::size_t i = 0; i < plain.rows(); i += 50) {
    EXPECT_NEAR(si["P_kPa"][i], 5e7 * plain["P"][i], 1e-6 * si["P_kPa"][i]);
    EXPECT_NEAR(si["sigma_dev_kPa"][i], 5e7 * plain["sigma_dev"][i], 1e-3);
    EXPECT_EQ(si["s_dev"][i], plain["s_dev"][i]);
  }
}

TEST_F(Predict, RowsPerSegment) { EXPECT_EQ(predict({"--rows", "7"}).rows(), 22u); }

TEST_F(Predict, FormsDiffer) {
  const Record reduced = predict({"--form", "reduced"}), coupled = predict({"--form", "coupled"});
  // Eq. 2.17 from isotropy at nu = 0.711: s_max = 0.16691, beta_s = 48.662 (Table 2.2).
  EXPECT_NEAR(reduced["s_dev"][10], 0.16691 * (1 - std::exp(-48.662 * 0.04)), 1e-5);
  EXPECT_LT(coupled["s_dev"][10], 0.99 * reduced["s_dev"][10]);  // 4.16 rises more slowly
}

TEST_F(Predict, WritesSensitivities) {
  const Record record = predict({"--sensitivities", "moduli.a_I,memory.mu"});
  EXPECT_EQ(record.columns().size(), prediction_columns().size() + 8);
  EXPECT_NE(record["dP/d(moduli.a_I)"][50], 0);
  EXPECT_EQ(record["dF_dev/d(memory.mu)"][50], 0);
  EXPECT_THAT(last.err, HasSubstr("nothing on this path depends on memory.mu"));
  const Record si = predict({"--sensitivities", "moduli.a_I,memory.mu", "--si"});
  EXPECT_NEAR(si["dP_kPa/d(moduli.a_I)"][50], 5e7 * record["dP/d(moduli.a_I)"][50], 1);
  const Record all = predict({"--sensitivities", "all", "--rows", "3"});
  EXPECT_TRUE(all.has("dsigma_dev/d(start.nu)"));
  EXPECT_TRUE(all.has("dP/d(isotropic.iso.p0)"));
  EXPECT_FALSE(all.has("dP/d(isotropic.uni.p0)"));
  const Outcome refused = run({"predict", "data/thesis/parameters.json", "data/paths/d2-cycle.json",
                               "--sensitivities", "moduli.a_III"});
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.err, HasSubstr("moduli.a_III: no such parameter"));
}

TEST_F(Predict, BothFamiliesOfFormulasAgree) {
  const Record bdf = predict({}), adams = predict({"--method", "adams"});
  for (std::size_t i = 0; i < bdf.rows(); ++i) EXPECT_NEAR(adams["P"][i], bdf["P"][i], 1e-8 * bdf["P"][i]);
  EXPECT_NE(adams["P"], bdf["P"]);
}

TEST_F(Predict, ToleranceIsObeyed) {
  const Record fine = predict({"--rtol", "1e-11"}), coarse = predict({"--rtol", "1e-3"});
  double largest = 0;
  for (std::size_t i = 0; i < fine.rows(); ++i)
    largest = std::max(largest, std::abs(fine["P"][i] - coarse["P"][i]));
  EXPECT_GT(largest, 0);
  EXPECT_LT(largest, 1e-3);
}

TEST_F(Predict, FollowsTheRowsOfARecord) {
  write(
      "s.json",
      R"({"preparation": {"count": 64, "nu": 0.68, "rate": 1e-3, "relax": {"tolerance": 1e-3, "duration": 20}},
      "path": {"segments": [{"mode": "uni", "controls": {"nu": 0.72}, "rate": 2e-4}, {"mode": "relax", "duration": 5}]},
      "measure": {"rows": 12, "time_step": 0.2, "time_step_gas": 0.1}})");
  ASSERT_EQ(run({"simulate", "s.json", "-o", "r"}).status, 0);
  const Record dem = Record::read_csv(folder / "r/record.csv"), law = predict({}, "r");
  ASSERT_EQ(law.rows(), dem.rows());
  for (std::size_t i = 0; i < dem.rows(); ++i) {
    EXPECT_NEAR(law["nu"][i], dem["nu"][i], 1e-9);
    EXPECT_NEAR(law["eps_dev"][i], dem["eps_dev"][i], 1e-9);
    EXPECT_EQ(law["segment"][i], dem["segment"][i]);
  }
  EXPECT_EQ(predict({"--rows", "5"}, "r").rows(), 1u + 5 + 1);
}

TEST_F(Predict, EveryThesisSetPredicts) {
  for (const char* set : {"w-1.5", "w-2.0", "w-3.0", "w-10.0", "near-jamming"})
    EXPECT_GT(predict({"--form", "reduced_closed", "--rows", "3"}, "data/paths/uni.json",
                      std::string("data/thesis/") + set + ".json")
                  .rows(),
              1u)
        << set;
}

}  // namespace
}  // namespace grainlaw::apps
