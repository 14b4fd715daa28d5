#include "grainlaw/calibrate/fit_volumetric_account.hpp"

#include <utility>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

FitEntry entry_of(const std::string& name, const FitProblem& problem, const FitResult& result,
                  const Selection& selection) {
  FitEntry entry;
  entry.name = "volumetric." + name;
  entry.law = "F_dev/F_dev,0 = exp[−k ln(ν/ν_0)], k = " + name;
  entry.mode = "iso";
  entry.x_name = "eps_vol";
  entry.x_label = "volume strain ln(ν/ν_0) after shear";
  entry.y_name = "F_dev share";
  entry.y_label = "fabric F_dev over that at ν_0";
  entry.selection = "rows of the isotropic " + name + " of sheared packings, up to the first with P < " +
                    to_text(selection.P_min) + "; F_dev along the axis of the shear";
  entry.problem = problem;
  entry.result = result;
  return entry;
}

}  // namespace

void fit_volumetric_of(Account& account, const RecordFolder& folder, const Selection& selection) {
  std::vector<VolumetricCurve> curves;
  for (const TestRecord& test : folder.tests) {
    if (test.role != Role::fit || test.mode != "iso" || !test.sheared_along) continue;
    const std::vector<VolumetricCurve> some = volumetric_curves(test, selection.P_min);
    if (some.empty())
      account.left_out.push_back(
          {test.name, test.role, "volumetric: its record has no components of the fabric"});
    curves.insert(curves.end(), some.begin(), some.end());
  }
  if (curves.empty()) return;
  account.volumetric = fit_volumetric(curves);
  const VolumetricFit& fit = *account.volumetric;
  account.entries.push_back(entry_of("compression", fit.compression_law, fit.compression, selection));
  account.entries.push_back(entry_of("decompression", fit.decompression_law, fit.decompression, selection));
}

}  // namespace grainlaw::calibrate
