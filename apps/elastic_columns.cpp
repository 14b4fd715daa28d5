#include "grainlaw/apps/elastic_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "grainlaw/dem/floppy_modes.hpp"
#include "grainlaw/element/elastic_moduli.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/stiffness.hpp"
#include "grainlaw/element/symmetry_class.hpp"
#include "grainlaw/element/waves.hpp"

namespace grainlaw::apps {

namespace {

struct Solid {
  const dem::StaticPacking& packing;
  const dem::LinearResponse& response;
  double k_star, density;
};

constexpr std::array<Direction, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

struct Ray {
  const char* name;
  Direction direction;
};
constexpr std::array<Ray, 7> rays{{{"x", {1, 0, 0}},
                                   {"y", {0, 1, 0}},
                                   {"z", {0, 0, 1}},
                                   {"yz", {0, 1, 1}},
                                   {"xz", {1, 0, 1}},
                                   {"xy", {1, 1, 0}},
                                   {"xyz", {1, 1, 1}}}};

std::vector<double> eigenvalue_columns(const Solid& solid) {
  std::vector<double> list;
  for (const double value : eigenvalues(solid.response.energy)) list.push_back(value / solid.k_star);
  return list;
}

std::vector<double> symmetry_columns(const Solid& solid) {
  const SymmetryClass s = symmetry_class(solid.response.energy);
  return {s.isotropic,
          s.transversely_isotropic[0],
          s.transversely_isotropic[1],
          s.transversely_isotropic[2],
          s.best_transversely_isotropic,
          s.best_axis[0],
          s.best_axis[1],
          s.best_axis[2],
          s.orthotropic,
          s.best_orthotropic};
}

/// Young's moduli, then Poisson's ratios of each axis that is compressed.
std::vector<double> young_columns(const Solid& solid) try {
  const ElasticModuli moduli(solid.response.stress);
  std::vector<double> list;
  for (const Direction& n : axes) list.push_back(moduli.young(n) / solid.k_star);
  for (const Direction& n : axes)
    for (const Direction& m : axes)
      if (n != m) list.push_back(moduli.poisson(n, m));
  return list;
} catch (const Error&) {  // singular: a strain without resistance
  return std::vector<double>(9, std::numeric_limits<double>::quiet_NaN());
}

std::vector<double> wave_columns(const Solid& solid) {
  std::vector<double> list;
  for (const Ray& ray : rays)
    for (const Wave& wave :
         waves(solid.response.energy, solid.response.prestress, solid.density, ray.direction))
      list.push_back(wave.speed);
  return list;
}

std::vector<double> floppy_columns(const Solid& solid) {
  return {static_cast<double>(dem::floppy_modes(solid.packing).count)};
}

std::vector<std::string> eigenvalue_names() {
  return {"eigenvalue_1", "eigenvalue_2", "eigenvalue_3", "eigenvalue_4", "eigenvalue_5", "eigenvalue_6"};
}
std::vector<std::string> symmetry_names() {
  return {"iso_share", "ti_x_share", "ti_y_share", "ti_z_share",  "ti_best_share",
          "ti_axis_x", "ti_axis_y",  "ti_axis_z",  "ortho_share", "ortho_best_share"};
}
std::vector<std::string> young_names() {
  std::vector<std::string> list;
  for (const char* n : axis_names) list.push_back(fmt::format("Young_{}", n));
  for (const char* n : axis_names)
    for (const char* m : axis_names)
      if (n != m) list.push_back(fmt::format("Poisson_{}{}", n, m));
  return list;
}
std::vector<std::string> wave_names() {
  std::vector<std::string> list;
  for (const Ray& ray : rays)
    for (const int k : {1, 2, 3}) list.push_back(fmt::format("speed_{}_{}", ray.name, k));
  return list;
}
std::vector<std::string> floppy_names() { return {"floppy"}; }

struct Group {
  const char* name;
  std::vector<std::string> (*names)();
  std::vector<double> (*values)(const Solid&);
};
constexpr std::array<Group, 5> groups{{{"eigenvalues", eigenvalue_names, eigenvalue_columns},
                                       {"symmetry", symmetry_names, symmetry_columns},
                                       {"young", young_names, young_columns},
                                       {"waves", wave_names, wave_columns},
                                       {"floppy", floppy_names, floppy_columns}}};

}  // namespace

ElasticColumns::ElasticColumns(const std::vector<std::string>& wanted) {
  std::set<std::size_t> chosen;
  for (const std::string& name : wanted) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.name == name; });
    if (group == groups.end())
      throw Error("", "--also", "must be eigenvalues, symmetry, young, waves or floppy, got " + name);
    chosen.insert(static_cast<std::size_t>(group - groups.begin()));
  }
  wanted_.assign(chosen.begin(), chosen.end());
}

std::vector<std::string> ElasticColumns::names() const {
  std::vector<std::string> list;
  for (const std::size_t g : wanted_) {
    const std::vector<std::string> some = groups.at(g).names();
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

std::vector<double> ElasticColumns::values(const dem::StaticPacking& packing,
                                           const dem::LinearResponse& response,
                                           const Material& material) const {
  std::vector<double> list;
  if (wanted_.empty()) return list;
  const Solid solid{packing, response, material.stress_unit(), packing.measure().nu * material.rho};
  for (const std::size_t g : wanted_) {
    const std::vector<double> some = groups.at(g).values(solid);
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

}  // namespace grainlaw::apps
