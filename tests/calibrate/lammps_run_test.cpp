// A whole D2 test by LAMMPS, our contact law at the thesis's step t_c/50 (data/reference/lammps/d2-0.75),
// against ours from the same packing at four steps near the default.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grainlaw/element/record.hpp"

namespace grainlaw::calibrate {
namespace {

/// Mean of a column where the flow has forgotten its start.
double mean_in_flow(const Record& record, const std::string& column) {
  double sum = 0, rows = 0;
  for (std::size_t i = 0; i < record.rows(); ++i)
    if (record["eps_dev"][i] >= 0.1) sum += record[column][i], rows += 1;
  return sum / rows;
}

Record table(const std::string& name) {
  return Record::read_csv(GRAINLAW_DATA_DIR "/reference/lammps/d2-0.75/" + name + ".csv",
                          {"eps_dev", "P", "s_dev", "F_dev", "C_star"});
}

// Runs that differ in the step alone go apart as the flow's chaos has it, so that theirs is one more such
// run: it lies within Student's t (three degrees of freedom, one case in a hundred) of ours, for a new value
// beside four.
TEST(LammpsRun, FlowsAsOursDoes) {
  const Record theirs = table("lammps");
  ASSERT_EQ(theirs.rows(), 201u);
  for (const std::string column : {"P", "s_dev", "F_dev", "C_star"}) {
    double sum = 0, squares = 0;
    for (const char* step : {"0.2", "0.19", "0.18", "0.17"}) {
      const double mean = mean_in_flow(table(std::string("ours-") + step), column);
      sum += mean, squares += mean * mean;
    }
    const double ours = sum / 4, scatter = std::sqrt((squares - 4 * ours * ours) / 3);
    EXPECT_NEAR(mean_in_flow(theirs, column), ours, 5.84 * std::sqrt(1.25) * scatter) << column;
    EXPECT_LT(scatter, 0.1 * ours) << column << ": too wide to tell anything";
  }
}

// Before the first avalanches there is no chaos: row by row the same, to what the step and LAMMPS's
// background make.
TEST(LammpsRun, BeginsAsOursDoes) {
  const Record theirs = table("lammps"), ours = table("ours-0.2");
  EXPECT_NEAR(theirs["P"][0], ours["P"][0],
              1e-7 * ours["P"][0]);  // kinetic stress: LAMMPS has the velocity of the flow, too
  EXPECT_EQ(theirs["C_star"][0], ours["C_star"][0]);
  EXPECT_NEAR(theirs["P"][1], ours["P"][1], 1e-3 * ours["P"][1]);
  EXPECT_NEAR(theirs["F_dev"][1], ours["F_dev"][1], 5e-4);
}

}  // namespace
}  // namespace grainlaw::calibrate
