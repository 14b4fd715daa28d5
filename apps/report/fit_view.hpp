// One entry of fits.json as the report shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grainlaw/apps/report/html.hpp"
#include "grainlaw/apps/report/inputs.hpp"

namespace grainlaw::report {

/// Points of one test in a fit, or of a curve.
struct FitPoints {
  std::string test;  ///< TEST-sSEED; "" for a curve
  std::vector<double> x, y;
  std::vector<double> error;  ///< standard errors of y; empty where they are not known
};

struct FitParameter {
  std::string name;
  std::optional<double> value, error, thesis;
  bool at_bound = false, determined = true, held = false;
  std::optional<double> shift;  ///< of the value, where only rows of four times the pressure are taken
};

struct FitView {
  Json json;
  std::string name, law, role, mode;
  std::string
      family;  ///< of the isotropic laws: what follows the mode in the name, "C_star", "C_star_free_C0", …
  std::string
      group;  ///< "isotropic", "shear" (Q over nu), "near_jamming", "moduli", "memory", "" for any other
  std::string
      row;  ///< the mode (isotropic), the quantity (shear), either (near_jamming), "" (moduli, memory)
  std::string x_name, y_name, x_label, y_label;
  std::vector<FitPoints> data;
  FitPoints curve, thesis_curve;  ///< empty where there is none
  std::vector<FitParameter> parameters;

  /// False where the data were too few for a fit.
  bool ran() const { return !curve.x.empty(); }
  /// One run's s_dev or F_dev over eps_dev.
  bool of_one_run() const { return x_name == "eps_dev"; }
  bool for_comparison() const { return role == "predict"; }
  /// Neither needed by a prediction nor made, for want of data.
  bool idle() const { return for_comparison() && !ran(); }
  /// "D2", "D2 (for comparison only)".
  std::string mode_label() const;
};

std::vector<FitView> fit_views(const Inputs& inputs);

/// The fit's curve at x by straight lines between its points; NaN outside.
double fitted(const FitView& fit, double x);

/// The symbol of a parameter of the fit: "max" of a fit of s_dev is s_max.
Markup parameter_symbol(const FitView& fit, const std::string& name);

}  // namespace grainlaw::report
