#include "grainlaw/apps/elastic_columns.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "grainlaw/dem/stiffness/floppy_modes.hpp"
#include "grainlaw/element/elastic_moduli.hpp"
#include "grainlaw/element/error.hpp"
#include "grainlaw/element/moduli_table.hpp"
#include "grainlaw/element/path.hpp"
#include "grainlaw/element/stiffness.hpp"
#include "grainlaw/element/symmetry_class.hpp"
#include "grainlaw/element/waves.hpp"

namespace grainlaw::apps {

namespace {

struct Solid {
  const dem::StaticPacking& packing;
  const dem::LinearResponse& response;
  double k_star, density;
  StrainTensor axis;
};

constexpr std::array<Direction, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
/// x, y, z, yz, xz, xy, xyz
constexpr std::array<Direction, 7> rays{
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}}};

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
  for (const Direction& ray : rays)
    for (const Wave& wave : waves(solid.response.energy, solid.response.prestress, solid.density, ray))
      list.push_back(wave.speed);
  return list;
}

std::vector<double> floppy_columns(const Solid& solid) {
  return {static_cast<double>(dem::floppy_modes(solid.packing).count)};
}

/// Change of the stress by a strain of this size.
Sym6 stress_by(const Stiffness& c, const StrainTensor& strain) {
  Sym6 stress{};
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) stress[a] += (b < 3 ? 1 : 2) * c[a][b] * strain[b];
  return stress;
}

/// Eq. 4.7 of the whole tensor, with the sign of what lies along the axis, and its derivatives
/// d sqrt(3 J2) = (3/2) s : d(sigma)/sqrt(3 J2) for the strains of Eq. 4.10.
std::vector<double> invariant_columns(const Solid& solid) {
  const Sym6 &sigma = solid.response.prestress, fabric = solid.packing.measure().fabric;
  const auto sign = [&](const Sym6& q) { return deviator_along(q, solid.axis) < 0 ? -1 : 1; };
  const double mean = trace(solid.axis) / 3, size = deviator_magnitude(solid.axis);
  StrainTensor shear = solid.axis;
  for (std::size_t c = 0; c < 3; ++c) shear[c] -= mean;
  for (double& component : shear) component /= size;
  const StrainTensor volume{1.0 / 3, 1.0 / 3, 1.0 / 3};
  const auto derivative = [&](const StrainTensor& strain) {
    const double q = deviator_magnitude(sigma);
    return q > 0
               ? sign(sigma) * deviator_along(stress_by(solid.response.stress, strain), sigma) / solid.k_star
               : std::numeric_limits<double>::quiet_NaN();
  };
  return {sign(sigma) * deviator_magnitude(sigma) / solid.k_star, sign(fabric) * deviator_magnitude(fabric),
          derivative(volume), derivative(shear)};
}

/// The four moduli, were the grains to go along with the strain and no more.
std::vector<double> affine_columns(const Solid& solid) {
  const dem::Moduli m =
      dem::moduli_of(dem::derivative_of_stress(solid.response.affine, solid.response.prestress), solid.axis);
  return {m.B / solid.k_star, m.A1 / solid.k_star, m.A2 / solid.k_star, m.G_oct / solid.k_star};
}

std::vector<double> stress_columns(const Solid& solid) {
  std::vector<double> list;
  for (const double component : solid.response.prestress) list.push_back(component / solid.k_star);
  for (const Sym6& row : solid.response.stress)
    for (const double derivative : row) list.push_back(derivative / solid.k_star);
  return list;
}

/// In the order of elastic_groups().
using Values = std::vector<double> (*)(const Solid&);
constexpr std::array<Values, 8> values_of{eigenvalue_columns, symmetry_columns, young_columns,
                                          wave_columns,       floppy_columns,   invariant_columns,
                                          affine_columns,     stress_columns};

}  // namespace

ElasticColumns::ElasticColumns(const std::vector<std::string>& wanted) {
  const auto& groups = elastic_groups();
  std::set<std::size_t> chosen;
  for (const std::string& name : wanted) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [&](const ElasticGroup& g) { return g.name == name; });
    if (group == groups.end())
      throw Error(
          "", "--also",
          "must be eigenvalues, symmetry, young, waves, floppy, invariants, affine or stress, got " + name);
    chosen.insert(static_cast<std::size_t>(group - groups.begin()));
  }
  wanted_.assign(chosen.begin(), chosen.end());
}

std::vector<std::string> ElasticColumns::names() const {
  std::vector<std::string> list;
  for (const std::size_t g : wanted_) {
    const std::vector<std::string>& some = elastic_groups().at(g).columns;
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

std::vector<double> ElasticColumns::values(const dem::StaticPacking& packing,
                                           const dem::LinearResponse& response, const Material& material,
                                           const StrainTensor& axis) const {
  std::vector<double> list;
  if (wanted_.empty()) return list;
  const Solid solid{packing, response, material.stress_unit(), packing.measure().nu * material.rho, axis};
  for (const std::size_t g : wanted_) {
    const std::vector<double> some = values_of.at(g)(solid);
    list.insert(list.end(), some.begin(), some.end());
  }
  return list;
}

}  // namespace grainlaw::apps
