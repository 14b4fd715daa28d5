#include "grainlaw/calibrate/predict_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/model/predict.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class PredictRecords : public testing::Test {
 protected:
  PredictRecords() { write_campaign(scratch_.dir(), thesis_); }
  const std::filesystem::path& dir() const { return scratch_.dir(); }

  /// The rows of a record that the law itself has written.
  std::vector<Row> rows_of_law(const std::string& path_text, double nu, model::Form form) const {
    Path path = Path::read(Reader(parse_json(path_text, "path"), "path"));
    path.start.nu = nu;
    model::PredictOptions options;
    options.form = form;
    options.rows_per_leg = 50;
    const Record record = model::predict(thesis_.set(), path, options).record;
    std::vector<Row> rows;
    for (std::size_t i = 0; i < record.rows(); ++i) {
      rows.push_back({record["segment"][i], record["eps_vol"][i], record["eps_dev"][i], record["nu"][i],
                      record["P"][i], record["s_dev"][i], record["F_dev"][i], record["C"][i],
                      record["C_star"][i], record["f_NR"][i]});
    }
    return rows;
  }

  ThesisRecords thesis_;
  Scratch scratch_;
};

const Json& find(const Json& predictions, const std::string& test, const std::string& form) {
  for (const Json& p : predictions.at("predictions")) {
    if (p.at("test") == test && p.at("form") == form) return p;
  }
  throw std::runtime_error("no prediction of " + test);
}

TEST_F(PredictRecords, TheLawPredictsARecordOfItsOwn) {
  for (const model::Form form : {model::Form::reduced, model::Form::coupled}) {
    write_record(dir() / "records/d3-0.7-s1", path_json("d3"), rows_of_law(path_json("d3"), 0.7, form));
    write_record(dir() / "records/uni-s1", path_json("uni"), rows_of_law(path_json("uni"), 0.64, form));
    const Json out = predict_records(dir(), thesis_.set());
    for (const char* test : {"d3-0.7-s1", "uni-s1"}) {
      const Json& p = find(out, test, model::name_of(form));
      for (const char* column : {"P", "sigma_dev", "s_dev", "F_dev", "C", "C_star", "f_NR"}) {
        ASSERT_TRUE(p.at("errors").at(column).is_number()) << test << column << p.dump();
        EXPECT_LT(p.at("errors").at(column).get<double>(), 1e-6) << test << column;
      }
    }
  }
}

TEST_F(PredictRecords, TellTheErrorOfARecordThatIsOff) {
  std::vector<Row> rows = rows_of_law(path_json("d3"), 0.7, model::Form::reduced);
  for (Row& row : rows) row.P *= 1.25;
  write_record(dir() / "records/d3-0.7-s1", path_json("d3"), rows);
  const Json out = predict_records(dir(), thesis_.set());
  const Json& errors = find(out, "d3-0.7-s1", "reduced").at("errors");
  EXPECT_NEAR(errors.at("P").get<double>(), 0.2, 1e-9);  // (1.25 - 1)/1.25
  EXPECT_LT(errors.at("s_dev").get<double>(), 1e-6);
}

TEST_F(PredictRecords, OneFilePerTestAndFormWithARowPerRow) {
  const Json out = predict_records(dir(), thesis_.set());
  ASSERT_EQ(out.at("predictions").size(), 9u);  // uni, d3 at two densities; three forms each
  for (const Json& p : out.at("predictions")) {
    const Record predicted = Record::read_csv(dir() / p.at("file").get<std::string>());
    const Record measured = Record::read_csv(dir() / p.at("record").get<std::string>());
    ASSERT_EQ(predicted.rows(), measured.rows());
    for (std::size_t i = 0; i < measured.rows(); ++i)
      EXPECT_NEAR(predicted["nu"][i], measured["nu"][i], 1e-9);
    EXPECT_EQ(p.at("seed"), 1);
  }
  EXPECT_EQ(load_json(dir() / "predictions.json"), out);
  const Json& start = find(out, "d3-0.75-s1", "coupled").at("start");
  EXPECT_NEAR(start.at("nu").at("value").get<double>(), 0.75, 1e-9);
  EXPECT_TRUE(start.contains("P"));
}

TEST_F(PredictRecords, StartFromTheParameterSetAndNotFromTheRecord) {
  // A record that starts at another pressure, stress and fabric changes the errors, not the prediction.
  predict_records(dir(), thesis_.set());
  const std::string before = read_file(dir() / "predictions/d3-0.7-s1.coupled.csv");
  std::vector<Row> rows = thesis_.shear("d3", 0.7);
  for (Row& row : rows) {
    row.P *= 1.5;
    row.s_dev += 0.1;
    row.F_dev += 0.1;
  }
  write_record(dir() / "records/d3-0.7-s1", path_json("d3"), rows);
  predict_records(dir(), thesis_.set());
  EXPECT_EQ(read_file(dir() / "predictions/d3-0.7-s1.coupled.csv"), before);
}

TEST_F(PredictRecords, DeletingThemChangesNoDigitOfTheOtherPredictions) {
  const auto predictions = [&] {
    predict_records(dir(), fit_records(dir(), thesis_file()).parameters);
    return read_file(dir() / "predictions/d3-0.75-s1.coupled.csv");
  };
  const std::string with = predictions();
  std::filesystem::remove_all(dir() / "records/uni-s1");
  std::filesystem::remove_all(dir() / "records/d3-0.7-s1");
  EXPECT_EQ(predictions(), with);
  EXPECT_FALSE(std::filesystem::exists(dir() / "predictions/uni-s1.coupled.csv"))
      << "no file of an earlier run stays";
}

TEST_F(PredictRecords, AFormThatCannotBePredictedIsListedWithTheReason) {
  model::ParameterSet without = thesis_.set();
  without.moduli.reset();
  without.closure.contacts_at_moduli_nu_c = false;
  const Json out = predict_records(dir(), without);
  const Json& coupled = find(out, "d3-0.7-s1", "coupled");
  EXPECT_THAT(coupled.at("status").get<std::string>(), StartsWith("refused: "));
  EXPECT_THAT(coupled.at("status").get<std::string>(), HasSubstr("moduli"));
  EXPECT_TRUE(coupled.at("file").is_null());
  EXPECT_TRUE(coupled.at("errors").at("P").is_null());
  EXPECT_EQ(find(out, "d3-0.7-s1", "reduced").at("status"), "ok");
}

TEST_F(PredictRecords, CountTheRowsThatOnlyOneSideDefines) {
  // A packing that the law calls unjammed, and the record does not: no s_dev to compare.
  std::vector<Row> rows = thesis_.shear("d3", 0.7);
  const std::size_t all = rows.size();
  for (std::size_t i = 0; i < 3; ++i) rows[i].s_dev = std::nan("");
  for (Row& row : rows) row.nu = 0.7;
  write_record(dir() / "records/d3-0.7-s1", path_json("d3"), rows);
  const Json out = predict_records(dir(), thesis_.set());
  const Json& count = find(out, "d3-0.7-s1", "reduced").at("rows");
  EXPECT_EQ(count.at("s_dev").at("compared"), all - 3);
  EXPECT_EQ(count.at("s_dev").at("missed"), 3);
  EXPECT_EQ(count.at("P").at("compared"), all);
  EXPECT_EQ(count.at("P").at("missed"), 0);
}

TEST_F(PredictRecords, NothingToPredictIsAnEmptyList) {
  std::filesystem::remove(dir() / "campaign.json");  // all records are for fits now
  EXPECT_TRUE(predict_records(dir(), thesis_.set()).at("predictions").empty());
}

TEST(RelativeDistance, IsTheL2NormOverRowsThatBothDefine) {
  const double none = std::nan("");
  EXPECT_DOUBLE_EQ(relative_distance({4, 0, 9, none}, {3, 0, none, 7}), 1.0 / 3);
  EXPECT_DOUBLE_EQ(relative_distance({3, 4}, {0, 5}), std::sqrt(10.0) / 5);
  EXPECT_TRUE(std::isnan(relative_distance({1, 2}, {0, 0})));
  EXPECT_TRUE(std::isnan(relative_distance({}, {})));
}

TEST(CountRows, TakesARowThatIsNotThereAsUndefined) {
  const double none = std::nan("");
  const RowCount count = count_rows({4, none, none}, {3, 2, none, 7});
  EXPECT_EQ(count.compared, 1u);
  EXPECT_EQ(count.missed, 2u);
  EXPECT_EQ(count_rows({}, {1, none}).missed, 1u);
}

}  // namespace
}  // namespace grainlaw::calibrate
