// grainlaw probe: moduli of every frame, those that bear nothing named, bad input before anything is written.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grainlaw/dem/balance/minimise.hpp"
#include "grainlaw/dem/balance/static_packing.hpp"
#include "grainlaw/dem/files/snapshot.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/element/record.hpp"
#include "grainlaw/element/tensor.hpp"
#include "program.hpp"

namespace grainlaw::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ProbeCommand : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("s.json", R"({
      "preparation": {"count": 64, "rate": 1e-3, "nu": 0.5, "relax": {"tolerance": 1e-3, "duration": 20}},
      "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.74}, "rate": 1e-3}, {"mode": "relax", "residual": 1e-8}]},
      "measure": {"rows": 2, "time_step_gas": 0.1, "snapshots": [
        {"segment": 0, "nu": 0.55}, {"segment": 0}, {"segment": 1}]}})");
    ASSERT_EQ(run({"simulate", "s.json", "-o", "r"}).status, 0);
  }
};

TEST_F(ProbeCommand, EveryFrameThatBearsLoad) {
  const Outcome outcome = run({"probe", "r/snapshots.h5", "--amplitude", "1e-6", "-o", "m.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "wrote m.csv: moduli of 2 packings\n");
  EXPECT_THAT(outcome.err, HasSubstr("r/snapshots.h5: frame 0 is left out: unjammed"));
  const Record record = Record::read_csv(folder / "m.csv");
  ASSERT_EQ(record.rows(), 6u);
  EXPECT_EQ(record["amplitude"], (std::vector<double>{0, 1e-6, -1e-6, 0, 1e-6, -1e-6}));
  for (const std::size_t k : {0u, 3u})
    for (const std::size_t probe : {k + 1, k + 2}) {
      EXPECT_NEAR(record["B"][probe], record["B"][k], 1e-2 * record["B"][k]);
      EXPECT_NEAR(record["G_oct"][probe], record["G_oct"][k], 1e-2 * record["B"][k]);
      EXPECT_TRUE(std::isnan(record["E_xx_xx"][probe]));
    }
  EXPECT_GT(record["E_xx_xx"][0], record["E_xx_yy"][0]);
  EXPECT_EQ(record["frame"][3], 2);
}

/// What --also and --undo add stands after the columns that are always there.
TEST_F(ProbeCommand, MoreColumnsByName) {
  ASSERT_EQ(run({"probe", "r/snapshots.h5", "-o", "plain.csv"}).status, 0);
  ASSERT_EQ(run({"probe", "r/snapshots.h5", "--amplitude", "1e-6", "--axis", "uni", "--undo", "--also",
                 "waves,floppy,young,invariants,affine,stress", "--also", "symmetry,eigenvalues,young", "-o",
                 "m.csv"})
                .status,
            0);
  const std::vector<std::string> plain = Record::read_csv(folder / "plain.csv").columns();
  const Record record = read_moduli(folder / "m.csv");
  ASSERT_EQ(record.columns().size(), plain.size() + 8 + 6 + 10 + 9 + 21 + 1 + 4 + 4 + 42);
  EXPECT_TRUE(std::equal(plain.begin(), plain.end(), record.columns().begin()));
  EXPECT_EQ(record.columns().back(), "S_xy_xy");
  EXPECT_EQ(record["floppy"][0], 0);
  EXPECT_LT(record["eigenvalue_1"][0], record["eigenvalue_6"][0]);
  // The largest belongs to nearly isotropic compression: 3 K.
  EXPECT_NEAR(record["eigenvalue_6"][0], 3 * (record["B"][0] - 2.0 / 3 * record["P"][0]),
              0.1 * record["B"][0]);
  EXPECT_LE(record["iso_share"][0], record["ti_best_share"][0]);
  EXPECT_LE(record["ortho_share"][0], 1);
  EXPECT_GT(record["Young_z"][0], 0);
  EXPECT_LT(std::abs(record["Poisson_xy"][0]), 1);
  EXPECT_LT(record["speed_xyz_1"][0], record["speed_xyz_3"][0]);
  EXPECT_GT(record["B_affine"][0], record["B"][0]);  // bounds
  EXPECT_GT(record["G_oct_affine"][0], record["G_oct"][0]);
  EXPECT_NEAR((record["sigma_xx"][0] + record["sigma_yy"][0] + record["sigma_zz"][0]) / 3, record["P"][0],
              1e-9);
  double bulk = 0;
  for (const char* a : {"xx", "yy", "zz"})
    for (const char* b : {"xx", "yy", "zz"}) bulk += record[std::string("S_") + a + "_" + b][0] / 9;
  EXPECT_NEAR(bulk, record["B"][0], 1e-12);
  // sqrt(3 J2) of the whole tensor: more than lies along one axis, and its derivative less.
  EXPECT_GE(std::abs(record["sigma_dev_inv"][0]), std::abs(record["sigma_dev"][0]));
  EXPECT_GE(std::abs(record["F_dev_inv"][0]), std::abs(record["F_dev"][0]));
  EXPECT_TRUE(std::isnan(record["B_left"][0]));
  EXPECT_NEAR(record["B_left"][1], 0, 1e-2 * record["B"][0]);
  EXPECT_EQ(record["changed_by_volume"][1] + record["changed_by_shear"][1], record["contacts_changed"][1]);
  EXPECT_TRUE(std::isnan(record["floppy"][1]));
}

/// sqrt(3 J2) of the balanced packing, strained by d2 so that eps_dev is `shear` and eps_vol is `volume`.
double deviator_at(const fs::path& snapshots, double shear, double volume) {
  const Material material;
  dem::StaticPacking packing(material,
                             dem::read_frame(snapshots.string(), {.nu = {}, .frame = 2, .segment = {}}));
  dem::MinimiseOptions options;
  options.residual = 1e-11;
  dem::minimise(packing, options);
  const double x = shear / std::sqrt(3.0), v = volume / 3;
  packing.deform(dem::Mat3::diagonal({std::exp(x - v), std::exp(-x - v), std::exp(-v)}) *
                 packing.cell().edges());
  dem::minimise(packing, options);
  return deviator_magnitude(packing.measure().stress) / material.stress_unit();
}

TEST_F(ProbeCommand, InvariantsAgainstDifferences) {
  ASSERT_EQ(run({"probe", "r/snapshots.h5", "--also", "invariants", "-o", "m.csv"}).status, 0);
  const Record record = read_moduli(folder / "m.csv");
  const fs::path snapshots = folder / "r/snapshots.h5";
  constexpr double h = 1e-6;
  const double q = deviator_at(snapshots, 0, 0), sign = record["sigma_dev"][1] < 0 ? -1 : 1;
  EXPECT_NEAR(record["sigma_dev_inv"][1], sign * q, 1e-9);
  EXPECT_NEAR(record["G_oct_inv"][1],
              sign * (deviator_at(snapshots, h, 0) - deviator_at(snapshots, -h, 0)) / (2 * h),
              1e-4 * record["B"][1]);
  EXPECT_NEAR(record["A2_inv"][1],
              sign * (deviator_at(snapshots, 0, h) - deviator_at(snapshots, 0, -h)) / (2 * h),
              1e-4 * record["B"][1]);
  EXPECT_GT(std::abs(record["G_oct_inv"][1] - record["G_oct"][1]), 1e-2 * record["B"][1]);
}

TEST_F(ProbeCommand, BadInput) {
  const auto refused = [&](Arguments arguments, const std::vector<std::string>& parts) {
    arguments.insert(arguments.begin(), {"probe", "r/snapshots.h5"});
    return refuses(run(arguments), parts);
  };
  EXPECT_TRUE(refused({"-o", "m.csv", "--axis", "x"}, {"--axis: must be d2 (-1, 1, 0), d3", "got x"}));
  EXPECT_TRUE(refused({"-o", "m.csv", "--also", "young,shear"},
                      {"--also: must be eigenvalues, symmetry, young, waves, floppy, invariants, affine or "
                       "stress, got shear"}));
  EXPECT_TRUE(refused({"-o", "m.csv", "--undo"}, {"--undo: must come with a strain to undo"}));
  EXPECT_TRUE(
      refused({"-o", "m.csv", "--amplitude", "0"}, {"--amplitude: must be a number >= 1e-09", "got 0"}));
  EXPECT_TRUE(refused({"-o", "m.csv", "--amplitude", "1e-6", "--amplitude", "0.000001"},
                      {"--amplitude: must be given once for each strain; got 0.000001 again"}));
  EXPECT_TRUE(refused({"-o", "m.csv", "--residual", "1e-8", "--amplitude", "1e-6"},
                      {"--amplitude: must be at least 1000 times the residual, which is 1e-08; got 1e-6"}));
  EXPECT_TRUE(refused({"-o", "m.csv", "--residual", "1e-3"},
                      {"--residual: must be a number >= 1e-13 and <= 1e-05, got 1e-3"}));
  EXPECT_TRUE(refused({"-o", "no/m.csv"}, {"-o: must lie in a directory that exists, got no/m.csv"}));
  EXPECT_TRUE(refused({"-o", "r/scene.json"}, {"-o", "r/scene.json"}));
  EXPECT_TRUE(refuses(run({"probe", "r", "-o", "m.csv"}),
                      {"r: is a directory; the snapshots of a record are its snapshots.h5"}));
  EXPECT_TRUE(refuses(run({"probe", "no.h5", "-o", "m.csv"}), {"no.h5: no such file"}));
  EXPECT_FALSE(fs::exists(folder / "m.csv"));
}

TEST_F(ProbeCommand, OptionsMayComeFirst) {
  EXPECT_EQ(run({"probe", "--amplitude", "1e-7", "r/snapshots.h5", "-o", "m.csv"}).status, 0);
}

TEST_F(ProbeCommand, WhereNothingBearsLoadItFails) {
  write(
      "gas.json",
      R"({"preparation": {"count": 64, "rate": 1e-3, "nu": 0.4, "relax": {"tolerance": 1e-3, "duration": 20}},
    "path": {"segments": [{"mode": "iso", "controls": {"nu": 0.45}, "rate": 1e-3}]},
    "measure": {"rows": 2, "time_step_gas": 0.1, "snapshots": [{"segment": 0}]}})");
  ASSERT_EQ(run({"simulate", "gas.json", "-o", "gas"}).status, 0);
  const Outcome outcome = run({"probe", "gas/snapshots.h5", "-o", "m.csv"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("gas/snapshots.h5: frame 0 is left out: unjammed"));
}

}  // namespace
}  // namespace grainlaw::apps
