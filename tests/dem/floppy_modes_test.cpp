// Floppy modes counted, against lattices with known ones and against the rank of the contacts' matrix.
#include "grainlaw/dem/stiffness/floppy_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "grainlaw/dem/balance/minimise.hpp"
#include "lattices.hpp"
#include "packings.hpp"

namespace grainlaw::dem {
namespace {

StaticPacking with_contacts(const State& state) {
  StaticPacking packing(Material{}, state);
  packing.find_contacts();
  return packing;
}

/// Every row and column of grains slides along itself, alone: 3 edge^2 displacements, three of them together
/// the translations.
TEST(FloppyModes, SimpleCubicLatticeSlidesAlongItsRows) {
  for (const int edge : {4, 5}) {
    const FloppyModes modes = floppy_modes(with_contacts(test::simple_cubic(2, edge)));
    EXPECT_EQ(modes.count, static_cast<std::size_t>(3 * edge * edge - 3));
    EXPECT_FALSE(modes.at_least);
  }
  FloppyOptions few;
  few.most_modes = 20;
  const FloppyModes modes = floppy_modes(with_contacts(test::simple_cubic(2, 5)), few);
  EXPECT_EQ(modes.count, 20u);
  EXPECT_TRUE(modes.at_least);
}

TEST(FloppyModes, NoneInFaceCentredCubicLatticeAndInJammedPackings) {
  EXPECT_EQ(floppy_modes(with_contacts(test::fcc(1.9, 3))).count, 0u);
  StaticPacking packing(Material{}, test::squeezed(Material{}, 200, 3, 0.75));
  minimise(packing);
  EXPECT_LT(packing.backbone().grains(), packing.count());  // it has rattlers
  EXPECT_EQ(floppy_modes(packing).count, 0u);
}

/// By elimination with pivots of rows normal . (u_i - u_j), one for each contact of the backbone.
std::size_t rank(const StaticPacking& packing) {
  const ContactNetwork& network = packing.network();
  const std::size_t columns = 3 * packing.count();
  std::vector<std::vector<double>> rows;
  for (std::size_t c = 0; c < network.count; ++c) {
    if (!packing.backbone().joins(network, c)) continue;
    std::vector<double> row(columns);
    const Quad& n = network.normal[c];
    const double normal[3] = {n.x, n.y, n.z};
    for (std::size_t k = 0; k < 3; ++k) {
      row[3 * network.pairs[c].i + k] = normal[k];
      row[3 * network.pairs[c].j + k] = -normal[k];
    }
    rows.push_back(row);
  }
  std::size_t rank = 0;
  for (std::size_t column = 0; column < columns && rank < rows.size(); ++column) {
    std::size_t pivot = rank;
    for (std::size_t r = rank; r < rows.size(); ++r)
      if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
    if (std::abs(rows[pivot][column]) < 1e-9) continue;
    std::swap(rows[rank], rows[pivot]);
    for (std::size_t r = rank + 1; r < rows.size(); ++r) {
      const double factor = rows[r][column] / rows[rank][column];
      for (std::size_t k = column; k < columns && factor != 0; ++k) rows[r][k] -= factor * rows[rank][k];
    }
    ++rank;
  }
  return rank;
}

/// Out of balance, so that there are fewer contacts than displacements, or hardly more.
TEST(FloppyModes, AreWhatTheRankOfTheContactsLeaves) {
  std::size_t most = 0;
  for (const double nu : {0.64, 0.66, 0.68, 0.72}) {
    const StaticPacking packing = with_contacts(test::squeezed(Material{}, 60, 3, nu));
    const std::size_t grains = packing.backbone().grains();
    ASSERT_GT(grains, 20u) << nu;
    const FloppyModes modes = floppy_modes(packing);
    EXPECT_EQ(modes.count, 3 * grains - 3 - rank(packing)) << nu;
    most = std::max(most, modes.count);
  }
  EXPECT_GT(most, 2u);
}

TEST(FloppyModes, NoneWithoutBackbone) {
  EXPECT_EQ(floppy_modes(with_contacts(test::squeezed(Material{}, 50, 3, 0.2))).count, 0u);
}

}  // namespace
}  // namespace grainlaw::dem
