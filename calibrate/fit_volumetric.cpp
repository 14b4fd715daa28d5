#include "grainlaw/calibrate/fit_volumetric.hpp"

#include <cmath>

#include "grainlaw/calibrate/fit_law.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/shear_projection.hpp"

namespace grainlaw::calibrate {
namespace {

/// Volume strains closer than this count as one.
constexpr double strain_resolution = 1e-3;

struct DecayLaw {  // k; ln(nu/nu_0) is at.x
  template <class T>
  T operator()(const T* p, const FitPoint& at) const {
    using std::exp;
    return exp(-p[0] * at.x);
  }
};

/// The rows of a leg in order, behind the row that it starts from.
std::vector<std::size_t> rows_with_start(const TestRecord& test, std::size_t leg) {
  std::vector<std::size_t> rows;
  const std::vector<double>& segment = test.rows["segment"];
  for (std::size_t i = 0; i < segment.size(); ++i) {
    if (static_cast<std::size_t>(segment[i]) != leg) continue;
    if (rows.empty() && i > 0) rows.push_back(i - 1);
    rows.push_back(i);
  }
  return rows;
}

VolumetricCurve curve_of(const TestRecord& test, std::size_t leg, const std::vector<double>& fabric,
                         double P_min) {
  VolumetricCurve curve{test.name, test.seed, test.legs[leg].eps_vol[1] > test.legs[leg].eps_vol[0], {}, {}};
  const std::vector<std::size_t> rows = rows_with_start(test, leg);
  for (const std::size_t row : rows) {
    if (test.rows["P"][row] < P_min) break;
    curve.strain.push_back(std::log(test.rows["nu"][row] / test.rows["nu"][rows.front()]));
    curve.share.push_back(fabric[row] / fabric[rows.front()]);
  }
  return curve;
}

}  // namespace

std::vector<VolumetricCurve> volumetric_curves(const TestRecord& test, double P_min) {
  std::vector<VolumetricCurve> curves;
  if (test.mode != "iso" || !test.sheared_along) return curves;
  const ShearColumn fabric = shear_column(test, *test.sheared_along, "F_dev");
  if (!fabric.projected) return curves;
  for (std::size_t leg = 0; leg < test.legs.size(); ++leg)
    if (test.legs[leg].mode == Mode::iso) curves.push_back(curve_of(test, leg, fabric.values, P_min));
  return curves;
}

FitProblem volumetric_problem(const std::vector<VolumetricCurve>& curves, const std::string& name) {
  FitProblem problem;
  problem.law = differentiable<1>(DecayLaw{});
  for (const VolumetricCurve& curve : curves) {
    FitSeries series{curve.test, curve.group, {}};
    for (std::size_t i = 1; i < curve.strain.size(); ++i)  // the first is 1 by definition
      series.points.push_back({curve.strain[i], curve.share[i], 0, 0});
    if (curve.compression == (name == "compression")) problem.series.push_back(std::move(series));
  }
  problem.x_resolution = strain_resolution;
  problem.parameters = {known_parameter({}, name, 3, -50, 50, 5)};
  return problem;
}

VolumetricFit fit_volumetric(const std::vector<VolumetricCurve>& curves) {
  VolumetricFit out;
  out.compression_law = volumetric_problem(curves, "compression");
  out.decompression_law = volumetric_problem(curves, "decompression");
  out.compression = fit(out.compression_law);
  out.decompression = fit(out.decompression_law);
  return out;
}

}  // namespace grainlaw::calibrate
