#include "grainlaw/calibrate/shear_projection.hpp"

#include <cmath>

#include "grainlaw/element/components.hpp"

namespace grainlaw::calibrate {
namespace {

/// Every component that counts is there.
bool has_all(const Record& rows, const ComponentNames& names, const StrainTensor& along) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (along[k] != 0 && !rows.has(names[k])) return false;
  return true;
}

/// What the components of Q must be multiplied with: the unit tensor along the axis, times sqrt(3/2). The sum
/// is sqrt(3 J2) of a Q that is along it.
StrainTensor projector(const StrainTensor& axis) {
  double squares = 0;
  for (std::size_t k = 0; k < 6; ++k) squares += (k < 3 ? 1 : 2) * axis[k] * axis[k];
  const double factor = std::sqrt(1.5 / squares);
  StrainTensor product;
  for (std::size_t k = 0; k < 6; ++k) product[k] = factor * (k < 3 ? 1 : 2) * axis[k];  // ab and ba
  return product;
}

}  // namespace

ShearColumn shear_column(const TestRecord& test, std::size_t leg, const std::string& quantity) {
  return shear_column(test, SignConvention(test.legs).axis(leg), quantity);
}

ShearColumn shear_column(const TestRecord& test, const StrainTensor& axis, const std::string& quantity) {
  const bool of_stress = quantity == "s_dev";
  const ComponentNames& names = of_stress ? stress_columns : fabric_columns;
  const StrainTensor along = projector(axis);
  if (!has_all(test.rows, names, along)) return {test.rows[quantity], false};
  ShearColumn column{std::vector<double>(test.rows.rows(), 0.0), true};
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    const double unit = of_stress ? test.rows["P"][i] : 1;
    for (std::size_t k = 0; k < along.size(); ++k)
      if (along[k] != 0) column.values[i] += along[k] * test.rows[names[k]][i] / unit;
  }
  return column;
}

}  // namespace grainlaw::calibrate
