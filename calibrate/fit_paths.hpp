// A polish after the fits law by law: chosen parameters fitted to whole measured paths, stress and fabric
// together, with an account of what the paths determine, what not, and at whose cost.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "grainlaw/calibrate/path_series.hpp"
#include "grainlaw/element/json.hpp"
#include "grainlaw/model/parameters.hpp"

namespace grainlaw::calibrate {

struct PolishOptions {
  std::vector<std::string> names;  ///< parameters to fit; empty: polished_by_default()
  PathSelection selection;
  ColumnsCompared compared = all_columns;
  model::Choice form;     ///< and terms past the thesis
  double rtol = 1e-6;     ///< of the integrations
  bool trade_off = true;  ///< sweep the weight of fabric against stress, where both are compared
  bool profiles = true;   ///< profile likelihoods
  bool held_out = true;   ///< compare predictions of tests of role predict, before and after
};

/// Moduli and saturation laws that shear at constant volume depends on in this form, of those that the set
/// has. The densities nu_c that laws count from stay, as in the fits law by law.
std::vector<std::string> polished_by_default(const model::ParameterSet& set, const model::Choice& form);

struct PolishOutput {
  /// The start with fitted values (source "fit", standard errors); the start itself where nothing could be
  /// fitted.
  model::ParameterSet parameters;
  Json account;  ///< docs/fits.md lists its keys
};

/// Fits the records of `dir` (see read_records) from `start` on. Throws Error for records that cannot be read
/// or none of the modes, and for names the set lacks. A law that does not come along a path is an outcome:
/// `account["exit"]` begins with "failed".
PolishOutput polish(const std::filesystem::path& dir, const model::ParameterSet& start,
                    const PolishOptions& options = {});
PolishOutput polish(const RecordFolder& folder, const model::ParameterSet& start,
                    const PolishOptions& options = {});

}  // namespace grainlaw::calibrate
