// One fit as fits.json tells it: data, curve, parameters beside the thesis's, and how far to trust them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grainlaw/calibrate/campaign.hpp"
#include "grainlaw/calibrate/fit_packing.hpp"
#include "grainlaw/calibrate/fit_problem.hpp"
#include "grainlaw/element/json.hpp"

namespace grainlaw::calibrate {

struct FitEntry {
  std::string name;  ///< "isotropic.iso.C_star"
  std::string law;   ///< in words and symbols, with the equation's number
  Role role = Role::fit;
  std::string mode;
  std::string x_name, x_label, y_name, y_label;
  std::string selection;          ///< which rows were taken, in words
  std::size_t rows_left_out = 0;  ///< by that rule
  FitProblem problem;             ///< as given, with its data
  FitResult result;
  KnownValues thesis;                ///< the thesis's values by parameter name, where it has them
  std::optional<double> curve_from;  ///< the curve begins here, if the data begin later
  std::string known_name;            ///< of that quantity, where the data are to tell it; else empty
  std::function<double(double)>
      known_at;               ///< the law's second measured quantity over x, for the curve; may be empty
  std::vector<double> shift;  ///< of each parameter where the selection starts at four times the pressure;
                              ///< NaN where that leaves out no row; may be empty
};

/// docs/fits.md lists the keys. A number that is not known is null.
Json to_json(const FitEntry& entry);

/// {"fit", "role", "parameter", "reason"} for every parameter that the fit does not determine, appended to
/// `list`.
void append_not_determined(const FitEntry& entry, Json& list);

}  // namespace grainlaw::calibrate
