// What a row measures, and what is watched whatever it measures.
#include "grainlaw/dem/record/row_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/element/error.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

/// Of a packing that is full of motion and bears a load: said where both the ratio and the pressure are
/// columns.
TEST(RowWriter, WarnsOfTheEnergyRatioWhereItAndThePressureAreAskedFor) {
  const Dynamics dynamics(Material{}, test::squeezed(Material{}, 40, 3, 0.75, 0.2));
  const auto warnings = [&](const Words& standard, const Words& observe = {}) {
    RowWriter writer = writer_of(standard, observe);
    writer.append(dynamics, 0, 0, 0);
    return writer.warnings();
  };
  EXPECT_THAT(warnings(column_groups()), ElementsAre(HasSubstr("in 1 of 1 load-bearing rows")));
  EXPECT_EQ(warnings({"stress", "energy_ratio"}), warnings(column_groups()));
  EXPECT_THAT(warnings({"stress"}), IsEmpty());
  EXPECT_THAT(warnings({"stress"}, {"energy"}), IsEmpty());
  EXPECT_THAT(warnings({"energy_ratio", "fabric"}), IsEmpty());
}

}  // namespace
}  // namespace grainlaw::dem
