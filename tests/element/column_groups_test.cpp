// Groups of columns: together with those that are always there, they are all columns of a DEM record.
#include "grainlaw/element/column_groups.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/element/record.hpp"

namespace grainlaw {
namespace {

using testing::ElementsAre;

TEST(ColumnGroups, MakeUpARecord) {
  EXPECT_THAT(column_groups(), ElementsAre("stress", "fabric", "coordination", "energy_ratio"));
  EXPECT_EQ(record_columns_with(column_groups()), record_columns());
  EXPECT_THAT(record_columns_with({}), ElementsAre("segment", "eps_vol", "eps_dev", "nu", "phi_J", "t"));
}

TEST(ColumnGroups, AreInTheOrderOfARecordWhateverTheOrderOfTheWords) {
  EXPECT_THAT(
      record_columns_with({"energy_ratio", "coordination"}),
      ElementsAre("segment", "eps_vol", "eps_dev", "nu", "C", "C_star", "f_NR", "phi_J", "t", "Ek_over_Ep"));
  EXPECT_THAT(record_columns_with({"stress"}),
              ElementsAre("segment", "eps_vol", "eps_dev", "nu", "P", "sigma_dev", "s_dev", "phi_J", "t",
                          "sxx", "syy", "szz", "syz", "sxz", "sxy"));
  EXPECT_THAT(record_columns_with({"fabric"}),
              ElementsAre("segment", "eps_vol", "eps_dev", "nu", "F_v", "F_dev", "phi_J", "t", "Fxx", "Fyy",
                          "Fzz", "Fyz", "Fxz", "Fxy"));
}

TEST(ColumnGroups, OfAColumn) {
  EXPECT_EQ(group_of_column("sxy"), "stress");
  EXPECT_EQ(group_of_column("Ek_over_Ep"), "energy_ratio");
  EXPECT_EQ(group_of_column("nu"), "");
  EXPECT_EQ(group_of_column("kxx"), "");
}

}  // namespace
}  // namespace grainlaw
