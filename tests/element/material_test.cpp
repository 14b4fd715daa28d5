// The material's derived scales against the thesis's numbers, and g3(w) (Eq. 3.8).
#include "grainlaw/element/material.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grainlaw/element/error.hpp"

namespace grainlaw {
namespace {

TEST(Material, ContactDurationsOfTheThesis) {  // section 2.2.2
  const Material material;
  EXPECT_NEAR(material.contact_duration(1.0), 0.6432, 5e-5);
  EXPECT_NEAR(material.contact_duration(material.r_min()), 0.2279, 5e-5);
}

TEST(Material, StressUnit) {
  const Material material;  // k = 1e8 kg/s^2, 2<r> = 2 mm: 5e10 Pa
  EXPECT_DOUBLE_EQ(material.stress_unit_kPa(), 5e7);
}

TEST(Material, FabricSizeFactor) {  // Eq. 3.8, values at w = 1 ... infinity
  const double w[] = {1, 1.5, 2, 3, 5, 10, 1e9},
               g3[] = {1, 1.04172, 1.10980, 1.22475, 1.35654, 1.48033, 1.62636};
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(fabric_size_factor(w[i]), g3[i], 5e-6) << "w = " << w[i];
}

TEST(Material, RefusesAnOverdampedContact) {
  const auto read = [](const char* text) { return Material::read({parse_json(text, "m.json"), "m.json"}); };
  EXPECT_NO_THROW(read(R"({"gamma": 10000})"));
  EXPECT_THROW(read(R"({"gamma": 1e6})"), Error);
  EXPECT_THROW(read(R"({"k": -1})"), Error);
}

TEST(MaterialFile, DefaultViscositiesDampAsMuchAsTheThesis) {
  const auto read = [](const std::string& text) {
    return Material::read(Reader(parse_json(text, "m"), "m"));
  };
  const Material thesis = read("{}"), other = read(R"({"k": 7e3, "r_mean": 0.1, "rho": 2650})");
  EXPECT_EQ(thesis.gamma, 1000);
  EXPECT_EQ(thesis.gamma_b, 100);
  // gamma / sqrt(k m) and the contact duration over sqrt(m/k), of equal grains of mean size.
  const auto mass = [](const Material& m) { return m.rho * std::pow(m.r_mean, 3); };
  const auto damping = [&](const Material& m) { return m.gamma / std::sqrt(m.k * mass(m)); };
  const auto duration = [&](const Material& m) {
    return m.contact_duration(m.r_mean) / std::sqrt(mass(m) / m.k);
  };
  EXPECT_NEAR(damping(other), damping(thesis), 1e-12 * damping(thesis));
  EXPECT_NEAR(duration(other), duration(thesis), 1e-12 * duration(thesis));
  EXPECT_EQ(read(R"({"k": 7e3, "gamma": 3})").gamma, 3);
}

}  // namespace
}  // namespace grainlaw
