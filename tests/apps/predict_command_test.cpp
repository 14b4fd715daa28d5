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

TEST_F(Predict, FollowsATableOfStrains) {
  const Record walked = predict({"--rows", "11"}, "data/paths/d2-cycle.json");
  std::filesystem::rename(folder / "p.csv", folder / "strains.csv");
  const Record again = predict({}, "strains.csv");
  ASSERT_EQ(again.rows(), walked.rows());
  for (std::size_t i = 0; i < walked.rows(); ++i)
    EXPECT_NEAR(again["sigma_dev"][i], walked["sigma_dev"][i], 1e-8) << i;
  write("bare.csv", "eps_vol,eps_dev\n0,0\n0,0.1\n");
  EXPECT_EQ(predict({"--nu", "0.7", "--P", "0.02"}, "bare.csv")["P"][0], 0.02);
  // k/(2<r>) of the thesis's grains is 1e8 kg/s2 over 2 mm: 50 GPa.
  EXPECT_DOUBLE_EQ(predict({"--nu", "0.7", "--P", "1e6kPa"}, "bare.csv")["P"][0], 0.02);
  // A table in kPa, as --si writes it, starts from its own pressure.
  write("kpa.csv", "eps_vol,eps_dev,nu,P_kPa\n0,0,0.7,1e6\n0,0.1,0.7,\n");
  EXPECT_DOUBLE_EQ(predict({}, "kpa.csv")["P"][0], 0.02);
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "kpa.csv", "--P", "0.02"}),
                      {"kpa.csv: P_kPa: line 2: says the start already; leave out --P"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "bare.csv", "--nu", "0.7", "--P", "50"}),
              {"--P: must be a number between 0 and 1, over k* = 5e+07 kPa, or in kPa with that unit"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "bare.csv"}), {"bare.csv: nu: is missing"}));
  write("bad.csv", "eps_vol,eps_dev\n0,0\n0,\n");
  EXPECT_TRUE(refuses(run({"predict", "data/thesis/parameters.json", "bad.csv", "--nu", "0.7"}),
                      {"bad.csv: eps_dev: line 3: is empty"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "bare.csv", "--nu", "1.7"}), {"--nu: must be"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/d2-cycle.json", "--nu", "0.7"}),
              {"--nu: goes with a table of strains"}));
}

TEST_F(Predict, ATargetOutOfReachLeavesTheRowsUpToIt) {
  write("limit.json", R"({"start": {"nu": 0.711}, "segments": [
      {"mode": "d2", "controls": {"eps_vol": "start", "s_dev": 0.3}}, {"mode": "d2", "amount": 0.1}]})");
  const Outcome outcome =
      run({"predict", "data/thesis/parameters.json", "limit.json", "-o", "l.csv", "--rows", "10"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("limit.json: segments[0]: no strain follows the path further"));
  EXPECT_THAT(outcome.err, HasSubstr("s_dev = 0.166914 on the way to 0.3"));
  EXPECT_EQ(Record::read_csv(folder / "l.csv").rows(), 7u);
}

TEST_F(Predict, DrawsItsTable) {
  for (const char* file : {"p.svg", "p.png"}) {
    predict({"--plot", file, "--rows", "9", "--si"}, "data/paths/triaxial.json");
    EXPECT_GT(std::filesystem::file_size(folder / file), 5000u) << file;
  }
  EXPECT_THAT(read("p.svg"), HasSubstr("kPa"));
  EXPECT_THAT(read("p.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(read("p.png"), testing::StartsWith("\x89PNG"));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/d3.json", "--plot", "p.pdf"}),
              {"--plot: must end in .svg or .png, got p.pdf"}));
}

TEST_F(Predict, EnvelopeOfTheEndOfAPath) {
  const Record responses =
      predict({"--envelope", "1e-4", "--directions", "12", "--plot", "e.svg"}, "data/paths/d3.json");
  ASSERT_EQ(responses.rows(), 12u);
  EXPECT_EQ(responses["direction"][3], 90);
  EXPECT_EQ(responses["eps_dev"][3], 1e-4);
  EXPECT_LT(std::abs(responses["dsigma_dev"][3]), 0.01 * std::abs(responses["dsigma_dev"][9]));  // saturated
  EXPECT_THAT(read("e.svg"), HasSubstr("responses"));
  EXPECT_TRUE(predict({"--envelope", "1e-4", "--si"}, "data/paths/d3.json").has("dsigma_dev_kPa"));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/d3.json", "--directions", "9"}),
              {"--directions: goes with --envelope"}));
  EXPECT_TRUE(
      refuses(run({"predict", "data/thesis/parameters.json", "data/paths/d3.json", "--envelope", "2"}),
              {"--envelope: must be a number > 0 and <= 0.1"}));
}

TEST_F(Predict, TheMinimalFormIsEvaluated) {
  const std::string set = "data/thesis/near-jamming.json";
  const Record record = predict({"--form", "minimal", "--rows", "20"}, "data/paths/shear-jamming.json", set);
  EXPECT_EQ(record.columns(), prediction_columns());
  ASSERT_EQ(record.rows(), 101u);
  EXPECT_EQ(record["P"][10], 0);  // 0.14 of strain: the thesis jams at 0.1444
  EXPECT_GT(record["P"][11], 0);
  EXPECT_NEAR(record["s_dev"].back(), 0.21, 0.01);
  EXPECT_THAT(last.err, HasSubstr("memory.phi_cr is missing"));
  predict({"--form", "minimal"}, "data/paths/uni.json", set);  // no reversal, no need
  EXPECT_THAT(last.err, testing::Not(HasSubstr("phi_cr")));
  EXPECT_TRUE(refuses(run({"predict", set, "data/paths/uni.json", "--form", "minimall"}),
                      {"--form: must be one of", "coupled_3_14 or minimal", "minimall"}));
  EXPECT_TRUE(refuses(run({"predict", set, "data/paths/uni.json", "--form", "minimal+axial"}),
                      {"--form: minimal takes no terms"}));
  EXPECT_TRUE(refuses(
      run({"predict", set, "data/paths/shear-jamming.json", "--form", "minimal", "--envelope", "1e-4"}),
      {"--form: minimal has no rates"}));
  EXPECT_TRUE(refuses(run({"predict", set, "data/paths/triaxial.json", "--form", "minimal"}),
                      {"--form: minimal follows a path by strain"}));
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
