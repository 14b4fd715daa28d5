// Provenance: every key of docs/formats.md, and the unit of stress that a record's numbers stand in.
#include "grainlaw/dem/scene/provenance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grainlaw/dem/numbers/simd.hpp"
#include "grainlaw/element/version.hpp"

namespace grainlaw::dem {
namespace {

TEST(Provenance, HasEveryKeyInOrder) {
  const Json json = Provenance::begin({}).to_json();
  std::string keys;
  for (const auto& [key, value] : json.items()) keys += key + " ";
  EXPECT_EQ(
      keys,
      "version commit seed compiler simd started wall_time_s particle_steps particle_steps_per_s k_star "
      "k_star_kPa time_step warnings ");
}

TEST(Provenance, UnitOfStress) {
  Scene scene;
  scene.material.k = 4e4;
  scene.material.r_mean = 0.5;
  const auto provenance = Provenance::begin(scene);
  EXPECT_DOUBLE_EQ(provenance.k_star, 4e4);  // k/(2<r>)
  EXPECT_DOUBLE_EQ(provenance.k_star_kPa, 4e7);
  const auto thesis = Provenance::begin({});
  EXPECT_DOUBLE_EQ(thesis.k_star, 5e4);  // 1e8 kg/s^2 over 2 mm: 50 GPa
  EXPECT_DOUBLE_EQ(thesis.k_star_kPa, 5e7);
}

TEST(Provenance, SeedOfANewPackingOnly) {
  Scene scene;
  std::get<NewPacking>(scene.preparation).seed = 42;
  EXPECT_EQ(Provenance::begin(scene).to_json()["seed"], 42);
  scene.preparation = FromSnapshot{};
  EXPECT_TRUE(Provenance::begin(scene).to_json()["seed"].is_null());
}

TEST(Provenance, Effort) {
  Provenance provenance;
  EXPECT_EQ(provenance.particle_steps_per_s(), 0);
  provenance.particle_steps = 3'000'000;
  provenance.wall_time_s = 1.5;
  EXPECT_DOUBLE_EQ(provenance.to_json()["particle_steps_per_s"], 2e6);
  provenance.warnings = {"Slow down."};
  EXPECT_EQ(provenance.to_json()["warnings"].dump(), R"(["Slow down."])");
}

TEST(Provenance, WhoAndWhen) {
  const Json json = Provenance::begin({}).to_json();
  const auto text = [&](const char* key) { return json[key].get<std::string>(); };
  using testing::MatchesRegex;
  EXPECT_THAT(text("version"), MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_THAT(text("commit"), MatchesRegex("unknown|[0-9a-f]{7,40}(-dirty)?"));
  EXPECT_THAT(text("started"),
              MatchesRegex("20[0-9]{2}-[01][0-9]-[0-3][0-9]T[0-2][0-9]:[0-5][0-9]:[0-6][0-9]Z"));
  EXPECT_THAT(text("compiler"), MatchesRegex("(gcc|clang) [0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(text("simd"), simd_target());
  EXPECT_EQ(json["version"], version());
  EXPECT_EQ(json["commit"], commit());
}

}  // namespace
}  // namespace grainlaw::dem
