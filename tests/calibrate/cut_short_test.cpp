// Records that end before their path does: fitted where they go far enough for that, else left out and named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit_fixture.hpp"
#include "grainlaw/calibrate/fit_input.hpp"
#include "grainlaw/calibrate/fit_records.hpp"
#include "grainlaw/calibrate/predict_records.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CutShort : public testing::Test {
 protected:
  CutShort() { write_campaign(scratch_.dir(), thesis_); }
  std::filesystem::path record(const std::string& name) const { return scratch_.dir() / "records" / name; }

  /// Leaves the rows before the first one that `ends`, and says so in provenance.json.
  void cut(const std::string& name, const std::string& path, std::vector<Row> rows,
           const std::function<bool(const Row&)>& ends) {
    rows.erase(std::find_if(rows.begin(), rows.end(), ends), rows.end());
    rows_ = rows.size();
    write_record(record(name), path_json(path), rows);
    tell(name, rows_);
  }
  void tell(const std::string& name, std::size_t rows) {
    fitted_.reset();
    write_file(record(name) / "provenance.json",
               R"({"cut_short": "no balance was found", "rows": )" + std::to_string(rows) + "}");
    edit(record(name) / "scene.json", [](std::string text) {
      const auto at = text.find(R"("measure": {})");
      return at == std::string::npos ? text : text.replace(at, 13, R"("measure": {"rows": 80})");
    });
  }
  const FitOutput& fitted() {
    if (!fitted_) fitted_ = fit_records(scratch_.dir(), thesis_file());
    return *fitted_;
  }

  /// Why this record is left out, all reasons together; empty where it is not.
  std::string left_out(const std::string& name) {
    std::string reasons;
    for (const Json& left : fitted().fits.at("left_out"))
      if (left.at("test") == name) reasons += left.at("reason").get<std::string>() + "\n";
    return reasons;
  }
  /// The tests that a fit read.
  std::vector<std::string> tests_of(const std::string& fit) {
    for (const Json& entry : fitted().fits.at("fits"))
      if (entry.at("name") == fit) return entry.at("tests");
    return {};
  }

  ThesisRecords thesis_;
  Scratch scratch_;
  std::size_t rows_ = 0;
  std::optional<FitOutput> fitted_;
};

TEST_F(CutShort, AShearThatCameToItsSteadyStateIsFitted) {
  cut("d2-0.71-s1", "d2", thesis_.shear("d2", 0.71), [](const Row& r) { return r.eps_dev > 0.3; });
  EXPECT_EQ(left_out("d2-0.71-s1"), "");
  EXPECT_THAT(tests_of("isotropic.d2.P"), testing::Contains("d2-0.71-s1"));
  EXPECT_THAT(tests_of("shear.beta_s"), testing::Contains("d2-0.71-s1"));
  const auto folder = read_records(scratch_.dir());
  for (const TestRecord& test : folder.tests) {
    if (test.name != "d2-0.71-s1") continue;
    EXPECT_EQ(test.legs.size(), 1u);
    EXPECT_EQ(test.legs[0].eps_dev[1], test.rows["eps_dev"].back());
  }
}

TEST_F(CutShort, AShearThatDidNotIsLeftOutAndNamed) {
  cut("d2-0.71-s1", "d2", thesis_.shear("d2", 0.71), [](const Row& r) { return r.eps_dev > 0.1; });
  EXPECT_THAT(left_out("d2-0.71-s1"),
              AllOf(HasSubstr("packing laws: only 0 rows of its first loading have |eps_dev| >= 0.15"),
                    HasSubstr("s_dev: it was cut short at eps_dev = 0.1, and a rate takes a loading to "
                              "|eps_dev| >= 0.15: no balance was found"),
                    HasSubstr("F_dev: it was cut short")));
  EXPECT_THAT(tests_of("isotropic.d2.P"), testing::Not(testing::Contains("d2-0.71-s1")));
  EXPECT_THAT(tests_of("shear.beta_s"), testing::Not(testing::Contains("d2-0.71-s1")));
}

TEST_F(CutShort, AnUnloadingThatDoesNotReachJammingIsLeftOutAndNamed) {
  const auto late = [](const Row& r) { return r.segment == 1 && r.nu < 0.72; };
  cut("iso-s1", "iso", thesis_.cycle("iso"), late);
  EXPECT_THAT(left_out("iso-s1"), AllOf(HasSubstr("it was cut short at nu = 0.7"),
                                        HasSubstr("before its unloading came to P < 2e-04")));
  cut("iso-s1", "iso", thesis_.cycle("iso"), [](const Row& r) { return r.segment == 1 && r.nu < 0.65; });
  EXPECT_EQ(left_out("iso-s1"), "");
}

TEST_F(CutShort, OneThatEndsBeforeItsUnloadingIsLeftOutAndNamed) {
  cut("iso-s1", "iso", thesis_.cycle("iso"), [](const Row& r) { return r.nu > 0.8; });
  EXPECT_THAT(left_out("iso-s1"), HasSubstr("never decreases the volume fraction"));
}

TEST_F(CutShort, AFewRowsAreNoRecord) {
  cut("d2-0.71-s1", "d2", thesis_.shear("d2", 0.71), [](const Row& r) { return r.eps_dev > 0.02; });
  ASSERT_LT(rows_, 10u);
  EXPECT_EQ(left_out("d2-0.71-s1"),
            "cut short after " + std::to_string(rows_) + " rows: no balance was found\n");
}

TEST_F(CutShort, APredictionGoesAsFarAsTheRecord) {
  cut("d3-0.7-s1", "d3", thesis_.shear("d3", 0.7), [](const Row& r) { return r.eps_dev > 0.2; });
  const Json made = predict_records(scratch_.dir(), thesis_.set());
  int predicted = 0;
  for (const Json& p : made.at("predictions")) {
    if (p.at("test") != "d3-0.7-s1" || p.at("form") != "coupled") continue;
    EXPECT_EQ(p.at("status"), "ok");
    EXPECT_EQ(p.at("rows").at("P").at("compared"), rows_);
    ++predicted;
  }
  EXPECT_EQ(predicted, 1);
}

TEST_F(CutShort, ATableOfAnotherLengthThanWasToldIsRefused) {
  cut("d2-0.71-s1", "d2", thesis_.shear("d2", 0.71), [](const Row& r) { return r.eps_dev > 0.3; });
  tell("d2-0.71-s1", rows_ + 1);
  try {
    fitted();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(
        std::string(error.what()),
        AllOf(HasSubstr("d2-0.71-s1/record.csv"),
              HasSubstr("must have " + std::to_string(rows_ + 1) + " rows, got " + std::to_string(rows_) +
                        ": it is not the one that its provenance.json is of")));
  }
}

}  // namespace
}  // namespace grainlaw::calibrate
