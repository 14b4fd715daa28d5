#include "grainlaw/calibrate/shear_projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainlaw::calibrate {
namespace {

using Components = std::array<const char*, 3>;
constexpr Components stress{"sxx", "syy", "szz"}, fabric{"Fxx", "Fyy", "Fzz"};

bool has_all(const Record& rows, const Components& names) {
  return std::all_of(names.begin(), names.end(), [&](const char* name) { return rows.has(name); });
}

/// Unit tensor along the axis, times sqrt(3/2): its product with Q is sqrt(3 J2) of a Q that is along it.
Strain3 projector(const Strain3& axis) {
  const double factor = std::sqrt(1.5) / std::hypot(axis[0], axis[1], axis[2]);
  return {factor * axis[0], factor * axis[1], factor * axis[2]};
}

}  // namespace

ShearColumn shear_column(const TestRecord& test, std::size_t leg, const std::string& quantity) {
  const bool of_stress = quantity == "s_dev";
  const Components& names = of_stress ? stress : fabric;
  if (!has_all(test.rows, names)) return {test.rows[quantity], false};
  const Strain3 along = projector(SignConvention(test.legs).axis(leg));
  ShearColumn column{std::vector<double>(test.rows.rows(), 0.0), true};
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    const double unit = of_stress ? test.rows["P"][i] : 1;
    for (std::size_t k = 0; k < 3; ++k) column.values[i] += along[k] * test.rows[names[k]][i] / unit;
  }
  return column;
}

}  // namespace grainlaw::calibrate
