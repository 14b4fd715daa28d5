// What a row measures, and what is watched whatever it measures.
#include "grainlaw/dem/record/row_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Words = std::vector<std::string>;

RowWriter writer_of(const Words& standard, const Words& observe = {}) {
  return RowWriter(Material{}, {Leg{}}, 0.7, standard, observe);
}

TEST(RowWriter, WantsWhatIsAskedForAndWhatObserversRead) {
  EXPECT_EQ(writer_of({}).wanted(), Wanted{});
  EXPECT_EQ(writer_of({"stress"}).wanted(), Wanted{.stress = true});
  EXPECT_EQ(writer_of({"fabric"}).wanted(), Wanted{.fabric = true});
  EXPECT_EQ(writer_of({"coordination"}).wanted(), Wanted{.coordination = true});
  EXPECT_EQ(writer_of({"energy_ratio"}).wanted(), Wanted{.energies = true});
  // The kinetic stress, in no standard column, is for its observer alone.
  EXPECT_FALSE(writer_of(column_groups()).wanted().kinetic_stress);
  EXPECT_EQ(writer_of({}, {"kinetic_stress"}).wanted(), Wanted{.kinetic_stress = true});
  EXPECT_EQ(writer_of({"fabric"}, {"energy"}).wanted(), (Wanted{.fabric = true, .energies = true}));
  EXPECT_EQ(writer_of({}, {"percolation", "radius", "contacts"}).wanted(), Wanted{});
}

/// Whatever the rows say, velocities that no energy can be made of are the end.
TEST(RowWriter, FindsAnUnstableMotionWithoutAnyColumn) {
  State state = test::squeezed(Material{}, 40, 3, 0.7);
  state.velocity[7] = {1e200, 0, 0};
  const Dynamics dynamics(Material{}, state);
  for (const Words& standard : {Words{}, Words{"stress"}, Words{"energy_ratio"}, column_groups()}) {
    RowWriter writer = writer_of(standard);
    try {
      writer.append(dynamics, 0, 0, 3);
      ADD_FAILURE() << standard.size() << " groups: no error";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("the motion of the grains became unstable at nu = 0.7"));
    }
    EXPECT_EQ(writer.record().rows(), 0u);
  }
}

/// Of a packing that is full of motion and bears a load: said where stress and energies are measured, by
/// whichever name; else it is said that nobody watched.
TEST(RowWriter, WarnsOfTheEnergyRatioOrSaysThatNobodyWatches) {
  const Dynamics dynamics(Material{}, test::squeezed(Material{}, 40, 3, 0.75, 0.2));
  const auto warnings = [&](const Words& standard, const Words& observe = {}) {
    RowWriter writer = writer_of(standard, observe);
    writer.append(dynamics, 0, 0, 0);
    return writer.warnings();
  };
  EXPECT_THAT(warnings(column_groups()), ElementsAre(HasSubstr("in 1 of 1 load-bearing rows")));
  EXPECT_EQ(warnings({"stress", "energy_ratio"}), warnings(column_groups()));
  EXPECT_EQ(warnings({"stress"}, {"energy"}), warnings(column_groups()));
  for (const Words& standard : {Words{}, Words{"stress"}, Words{"energy_ratio", "fabric"}})
    EXPECT_THAT(warnings(standard), ElementsAre(HasSubstr("E_k/E_p was not watched"))) << standard.size();
}

/// Velocities of the full step are taken only where something depends on them; the rest is the same.
TEST(RowWriter, RowsWithoutVelocitiesAreTheSame) {
  const Dynamics dynamics(Material{}, test::squeezed(Material{}, 40, 3, 0.75, 0.2));
  RowWriter all = writer_of(column_groups());
  all.append(dynamics, 0, 0, 0);
  for (const char* group : {"fabric", "coordination"}) {
    RowWriter one = writer_of({group});
    EXPECT_FALSE(one.wanted().of_velocity());
    one.append(dynamics, 0, 0, 0);
    for (const std::string& column : one.record().columns())
      if (!std::isnan(all.record()[column][0])) {
        EXPECT_EQ(one.record()[column][0], all.record()[column][0]) << column;
      }
  }
}

}  // namespace
}  // namespace grainlaw::dem
