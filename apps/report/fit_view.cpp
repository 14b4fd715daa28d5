#include "grainlaw/apps/report/fit_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

FitPoints read_points(const Json& json) {
  FitPoints points{text_in(json, "test"), numbers_in(json, "x"), numbers_in(json, "y"),
                   numbers_in(json, "error")};
  const std::size_t n = std::min(points.x.size(), points.y.size());
  points.x.resize(n);
  points.y.resize(n);
  if (points.error.size() < n) points.error.clear();
  if (!points.error.empty()) points.error.resize(n);
  return points;
}

bool flag(const Json& json, const std::string& key, bool otherwise) {
  const Json& value = value_in(json, key);
  return value.is_boolean() ? value.get<bool>() : otherwise;
}

FitParameter read_parameter(const Json& json) {
  return {text_in(json, "name"),         number_in(json, "value"),
          number_in(json, "stderr"),     number_in(json, "thesis"),
          flag(json, "at_bound", false), flag(json, "determined", true),
          flag(json, "held", false),     number_in(json, "shift_at_four_P_min")};
}

/// The parts of a name between its dots.
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts{""};
  for (const char c : name) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

FitView read_fit(const Json& json) {
  FitView fit;
  fit.json = json;
  fit.name = text_in(json, "name");
  fit.law = text_in(json, "law");
  fit.role = text_in(json, "role");
  fit.mode = text_in(json, "mode");
  fit.x_name = text_in(value_in(json, "x"), "name");
  fit.y_name = text_in(value_in(json, "y"), "name");
  fit.x_label = text_in(value_in(json, "x"), "label");
  fit.y_label = text_in(value_in(json, "y"), "label");
  const auto parts = parts_of(fit.name);
  const bool over_nu = fit.x_name == "nu" && parts.size() > 1;
  if (over_nu && (parts[0] == "isotropic" || parts[0] == "shear" || parts[0] == "shear_axial")) {
    fit.group = parts[0];
    fit.row = parts[1];
    fit.family = parts.size() > 2 ? parts[2] : fit.y_name;
  }
  if (over_nu && parts[0] == "near_jamming") {  // near_jamming.d2.C_star, near_jamming.s_max
    fit.group = parts[0];
    fit.row = parts[1];
    fit.family = parts.size() > 2 ? parts[2] : fit.y_name;
  }
  if ((parts[0] == "moduli" || parts[0] == "memory" || parts[0] == "volumetric") && parts.size() > 1) {
    fit.group = parts[0];
    fit.family = parts[1];
  }
  for (const Json& data : value_in(json, "data")) fit.data.push_back(read_points(data));
  fit.curve = read_points(value_in(json, "curve"));
  fit.thesis_curve = read_points(value_in(json, "thesis_curve"));
  for (const Json& parameter : value_in(json, "parameters")) {
    fit.parameters.push_back(read_parameter(parameter));
  }
  return fit;
}

}  // namespace

std::string FitView::mode_label() const {
  return mode_name(mode) + (for_comparison() ? " (for comparison only)" : "");
}

std::vector<FitView> fit_views(const Inputs& inputs) {
  std::vector<FitView> views;
  const Json& fits = value_in(inputs.fits, "fits");
  if (!fits.is_array()) return views;
  for (const Json& fit : fits) {
    if (fit.is_object()) views.push_back(read_fit(fit));
  }
  return views;
}

double fitted(const FitView& fit, double x) {
  const auto& xs = fit.curve.x;
  for (std::size_t i = 1; i < xs.size(); ++i) {
    const bool within = (xs[i - 1] <= x && x <= xs[i]) || (xs[i] <= x && x <= xs[i - 1]);
    if (!within || xs[i] == xs[i - 1]) continue;
    const double t = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
    return (1 - t) * fit.curve.y[i - 1] + t * fit.curve.y[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Markup parameter_symbol(const FitView& fit, const std::string& name) {
  const std::string quantity = fit.y_name == "s_dev" ? "s" : fit.y_name == "F_dev" ? "F" : "";
  if (!fit.of_one_run() || quantity.empty()) return symbol(name, fit.group);
  if (name == "max") return symbol(quantity + "_max");
  if (name == "beta") return symbol("beta_" + quantity);
  if (name == "initial") return element("var", text(quantity)) + "<sub>0</sub>"_html;
  return symbol(name);
}

}  // namespace grainlaw::report
