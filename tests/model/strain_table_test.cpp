// Tables of measured strains: followed row by row, with a start from the table or beside it.
#include "grainlaw/model/strain_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "walks.hpp"

namespace grainlaw::model {
namespace {

using testing::HasSubstr;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

Record table(const std::vector<std::vector<double>>& rows,
             const std::vector<std::string>& columns = {"eps_vol", "eps_dev"}) {
  Record record(columns);
  for (const auto& row : rows) record.append(row);
  return record;
}

Prediction follow(const MeasuredPath& path, Form form) {
  return predict(thesis(), path.path, path.samples, {form, tight_rtol, tight_atol, 1});
}

TEST(StrainTable, IsTheWalkThatWroteIt) {
  // Two straight segments: the rows between change nothing.
  for (const Form form : {Form::reduced_closed, Form::reduced, Form::coupled}) {
    const Prediction walked = walk(R"({"start": {"nu": 0.69}, "segments": [{"mode": "uni", "amount": 0.04},
        {"mode": "d3", "amount": -0.03}]})",
                                   form, 7);
    const MeasuredPath path = strain_path(walked.record, "walked.csv", std::nullopt, std::nullopt);
    const Prediction p = follow(path, form);
    ASSERT_EQ(p.record.rows(), walked.record.rows());
    EXPECT_EQ(path.segments, std::vector<double>(walked.record.rows(), 0));
    for (const char* column : {"nu", "eps_vol", "eps_dev"})
      EXPECT_LT(difference(p, walked, column), 1e-14) << column;
    for (const char* column : {"P", "sigma_dev", "F_dev"})
      EXPECT_LT(difference(p, walked, column), 1e-9) << column;
  }
}

TEST(StrainTable, CountsFromItsFirstRow) {
  const auto from = [](double vol, double dev) {
    return follow(
        strain_path(table({{vol, dev}, {vol + 0.01, dev + 0.02}, {vol, dev + 0.05}}), "t.csv", 0.7, 0.01),
        Form::coupled);
  };
  const Prediction zero = from(0, 0), shifted = from(0.25, -0.5);
  for (const auto& column : prediction_columns())
    EXPECT_LT(difference(zero, shifted, column.c_str()), tight_rtol);
  EXPECT_EQ(zero.record["P"][0], 0.01);
}

TEST(StrainTable, RowsThatRepeatChangeNothing) {
  const Prediction p =
      follow(strain_path(table({{0, 0}, {0, 0}, {0, 0.02}, {0, 0.02}, {1e-17, 0.02}, {0, 0.05}}), "t.csv",
                         0.711, std::nullopt),
             Form::coupled);
  const Prediction once =
      follow(strain_path(table({{0, 0}, {0, 0.02}, {0, 0.05}}), "t.csv", 0.711, std::nullopt), Form::coupled);
  ASSERT_EQ(p.record.rows(), 6U);
  for (const char* column : {"P", "sigma_dev", "F_dev"}) {
    EXPECT_EQ(p.record[column][1], p.record[column][0]);
    for (const std::size_t i : {2u, 3u, 4u}) EXPECT_EQ(p.record[column][i], once.record[column][1]) << column;
    EXPECT_EQ(last(p, column), last(once, column)) << column;
  }
}

TEST(StrainTable, StartsFromItsFirstRowOrBesideIt) {
  const Record own =
      table({{0, 0, 0.72, 0.03, 7}, {0, 0.1, none, none, none}}, {"eps_vol", "eps_dev", "nu", "P", "other"});
  const MeasuredPath path = strain_path(own, "t.csv", std::nullopt, std::nullopt);
  EXPECT_EQ(path.path.start.nu, 0.72);
  EXPECT_EQ(path.path.start.P, 0.03);
  EXPECT_EQ(refusal([&] { strain_path(own, "t.csv", 0.7, std::nullopt); }),
            "t.csv: nu: line 2: says the start already; leave out --nu");
  EXPECT_THAT(refusal([&] {
                strain_path(table({{0, 0}, {0, 1}}), "t.csv", std::nullopt, std::nullopt);
              }),
              HasSubstr("t.csv: nu: is missing"));
}

TEST(StrainTable, NamesLineAndColumn) {
  const auto refused = [](const std::vector<std::vector<double>>& rows) {
    return refusal([&] { strain_path(table(rows), "t.csv", 0.7, std::nullopt); });
  };
  EXPECT_EQ(refused({{0, 0}, {0.1, none}}), "t.csv: eps_dev: line 3: is empty");
  EXPECT_EQ(refused({{0, 0}, {0.1, 0}, {0, 101}}),
            "t.csv: eps_dev: line 4: must be >= -100 and <= 100, got 101");
  EXPECT_THAT(refused({{0, 0}, {0.5, 0}}), HasSubstr("t.csv: eps_vol: line 3: takes nu to 1.15"));
  EXPECT_THAT(refused({{0, 0}}), HasSubstr("two rows"));
  EXPECT_THAT(refused({{0, 0}, {0, 0}}), HasSubstr("must strain somewhere"));
}

}  // namespace
}  // namespace grainlaw::model
