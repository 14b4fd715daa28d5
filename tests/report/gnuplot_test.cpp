#include "grainlaw/apps/report/gnuplot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "grainlaw/element/error.hpp"

namespace grainlaw::report {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& script, const std::string& program = "gnuplot") {
  try {
    run_gnuplot(script, program);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Gnuplot, ReturnsWhatItDrew) {
  EXPECT_THAT(run_gnuplot("set terminal svg\nplot x\n"), HasSubstr("</svg>"));
}

TEST(Gnuplot, NamesThePackageWhereItIsMissing) {
  EXPECT_THAT(error_of("plot x\n", "gnuplot-that-nobody-has"), HasSubstr("apt-get install gnuplot-nox"));
}

TEST(Gnuplot, PassesItsComplaintOn) {
  EXPECT_THAT(error_of("set terminal svg\nplot no_such_variable\n"),
              HasSubstr("undefined variable: no_such_variable"));
}

TEST(Gnuplot, TakesMoreThanAPipeHolds) {
  std::string script = "set terminal svg\n$d << EOD\n";
  for (int i = 0; i < 60000; ++i) script += std::to_string(i) + " " + std::to_string(i % 7) + "\n";
  EXPECT_GT(run_gnuplot(script + "EOD\nplot $d with points\n").size(), 1000000u);
}

TEST(Gnuplot, QuotedTextIsTextAndNothingElse) {
  const auto canary = std::filesystem::temp_directory_path() / "grainlaw-gnuplot-canary";
  std::filesystem::remove(canary);
  const std::string hostile =
      "'; `touch " + canary.string() + "` system('touch " + canary.string() + "') @x \n EOD \\";
  const std::string drawn = run_gnuplot("set terminal svg\nset label 1 " + gnuplot_quoted(hostile) +
                                        " at screen 0.5,0.5 noenhanced\nplot x\n");
  EXPECT_THAT(drawn, HasSubstr("’; `touch"));
  EXPECT_FALSE(std::filesystem::exists(canary));
}

}  // namespace
}  // namespace grainlaw::report
