// A record survives a round trip digit by digit; anything but finite numbers and empty fields is an error.
#include "grainlaw/element/record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "grainlaw/element/error.hpp"
#include "grainlaw/element/file.hpp"

namespace grainlaw {
namespace {

class RecordFile : public testing::Test {
 protected:
  std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("record-") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv");
  void TearDown() override { std::filesystem::remove(file_); }

  std::string refusal(const std::string& text, const std::vector<std::string>& required = {}) {
    std::ofstream(file_) << text;
    try {
      Record::read_csv(file_, required);
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), file_.string());
      return std::string(error.what()).substr(file_.string().size() + 2);
    }
    return "accepted";
  }
};

TEST_F(RecordFile, RoundTripIsExact) {
  Record record({"nu", "s_dev"});
  record.append({0.1 + 0.2, std::numeric_limits<double>::quiet_NaN()});
  record.append({5e-324, -1.7976931348623157e308});
  record.write_csv(file_);
  EXPECT_EQ(read_file(file_), "nu,s_dev\n0.30000000000000004,\n5e-324,-1.7976931348623157e+308\n");
  const Record back = Record::read_csv(file_);
  EXPECT_EQ(back["nu"], record["nu"]);
  EXPECT_TRUE(std::isnan(back["s_dev"][0]));
  EXPECT_EQ(back["s_dev"][1], record["s_dev"][1]);
}

TEST_F(RecordFile, RefusesWhatIsNotARecord) {
  EXPECT_EQ(refusal(""), "is empty; a record starts with a header line");
  EXPECT_EQ(refusal("nu,P\n"), "has a header but no rows");
  EXPECT_EQ(refusal("nu,P\n0.7,nan\n"), "P: line 2: must be a finite number or empty, got \"nan\"");
  EXPECT_EQ(refusal("nu,P\n0.7,1\ninf,1\n"), "nu: line 3: must be a finite number or empty, got \"inf\"");
  EXPECT_EQ(refusal("nu,P\n0.7,1 MPa\n"), "P: line 2: must be a finite number or empty, got \"1 MPa\"");
  EXPECT_EQ(refusal("nu,P\n0.7\n"), "line 2: must have 2 fields, got 1");
  EXPECT_EQ(refusal("nu,nu\n0.7,1\n"), "nu: line 1: column is given twice");
  EXPECT_EQ(refusal("P\n0.7\n", {"nu"}), "nu: column is missing");
  EXPECT_EQ(refusal("nu\n0.7\n", {"P"}),
            "P: column is missing; a record of simulate has it where measure.standard of its scene names "
            "\"stress\"");
  EXPECT_EQ(refusal("nu,P\n0.7,0.0123"), "is cut short: its last line does not end with a newline");
  EXPECT_EQ(refusal("nu;P\n0,7;1\n"),
            "line 1: columns must be separated by commas (and numbers have a decimal point), got semicolons");
  EXPECT_EQ(refusal("nu\tP\n0.7\t1\n"),
            "line 1: columns must be separated by commas (and numbers have a decimal point), got tabs");
}

TEST_F(RecordFile, TakesWhatASpreadsheetWrites) {
  EXPECT_EQ(refusal("nu,P\r\n0.7,\r\n"), "accepted");
  ASSERT_EQ(refusal("\xEF\xBB\xBFnu, P\r\n 0.7 ,\t0.01\r\n0.71, \r\n", {"nu", "P"}), "accepted");
  const Record record = Record::read_csv(file_);
  EXPECT_EQ(record.columns(), (std::vector<std::string>{"nu", "P"}));
  EXPECT_EQ(record["nu"], (std::vector<double>{0.7, 0.71}));
  EXPECT_EQ(record["P"][0], 0.01);
  EXPECT_TRUE(std::isnan(record["P"][1]));
}

TEST_F(RecordFile, InfinityIsNeverWritten) {
  Record record({"P"});
  record.append({std::numeric_limits<double>::infinity()});
  EXPECT_THROW(record.write_csv(file_), Error);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(RecordFile, AFolderThatIsNotThereIsNamed) {
  Record record({"P"});
  record.append({1});
  try {
    record.write_csv("/nowhere/record.csv");
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/record.csv: cannot be written: No such file or directory");
  }
}

TEST_F(RecordFile, WritesWhereALinkPointsAndIntoADevice) {
  const std::string link = file_.string() + ".link";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(file_, link);
  write_file(link, "through the link");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_file(file_), "through the link");
  std::filesystem::remove(link);
  ASSERT_TRUE(std::filesystem::is_character_file("/dev/null"));
  write_file("/dev/null", "lost");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  try {
    write_file("/dev/full", "no room");
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_TRUE(error.unwritable());
  }
}

}  // namespace
}  // namespace grainlaw
