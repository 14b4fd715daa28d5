#include "grainlaw/calibrate/fit_entry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainlaw::calibrate {
namespace {

constexpr int curve_points = 120;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json parameter_json(const FitEntry& entry, std::size_t i) {
  const FitEstimate& e = entry.result.parameters[i];
  Json json{{"name", e.name},
            {"value", number_or_null(e.value)},
            {"stderr", nullptr},
            {"thesis", nullptr},
            {"unit", e.unit}};
  if (e.stderr_) json["stderr"] = number_or_null(*e.stderr_);
  if (const auto known = entry.thesis.find(e.name); known != entry.thesis.end())
    json["thesis"] = known->second.value;
  json["at_bound"] = e.at_bound;
  json["determined"] = e.determined;
  json["held"] = e.held;
  json["interval95"] = nullptr;
  if (e.interval95) json["interval95"] = {e.interval95->first, e.interval95->second};
  if (!entry.shift.empty() && !e.held) json["shift_at_four_P_min"] = number_or_null(entry.shift[i]);
  return json;
}

Json data_json(const FitEntry& entry) {
  Json data = Json::array();
  for (const FitSeries& series : entry.problem.series) {
    Json x = Json::array(), y = Json::array(), error = Json::array(), known = Json::array();
    bool errors = true;
    for (const FitPoint& p : series.points) {
      x.push_back(p.x);
      y.push_back(p.y);
      error.push_back(p.error);
      known.push_back(p.known);
      errors = errors && p.error > 0;
    }
    if (series.points.empty()) continue;
    data.push_back({{"test", series.test}, {"x", x}, {"y", y}});
    if (errors) data.back()["error"] = error;
    if (!entry.known_name.empty()) data.back()[entry.known_name] = known;
  }
  return data;
}

/// The law over the range of the data.
Json curve_json(const FitEntry& entry, const std::vector<double>& p) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const FitSeries& series : entry.problem.series) {
    for (const FitPoint& point : series.points) {
      low = std::min(low, point.x);
      high = std::max(high, point.x);
    }
  }
  if (entry.curve_from) low = std::min(low, *entry.curve_from);
  Json x = Json::array(), y = Json::array();
  for (int i = 0; i < curve_points && high > low; ++i) {
    FitPoint at;
    at.x = low + (high - low) * i / (curve_points - 1);
    if (entry.known_at) at.known = entry.known_at(at.x);
    const double value = entry.problem.law(p, at, {});
    if (!std::isfinite(value)) continue;
    x.push_back(at.x);
    y.push_back(value);
  }
  return {{"x", x}, {"y", y}};
}

/// The law with the thesis's values, where it has all of them.
Json thesis_curve(const FitEntry& entry) {
  std::vector<double> p;
  for (const FitEstimate& e : entry.result.parameters) {
    const auto known = entry.thesis.find(e.name);
    if (known == entry.thesis.end()) return nullptr;
    p.push_back(known->second.value);
  }
  return curve_json(entry, p);
}

}  // namespace

Json to_json(const FitEntry& entry) {
  const FitResult& r = entry.result;
  Json json{{"name", entry.name}, {"law", entry.law}, {"role", name_of(entry.role)}, {"mode", entry.mode}};
  json["tests"] = Json::array();
  for (const FitSeries& series : entry.problem.series) {
    if (!series.points.empty()) json["tests"].push_back(series.test);
  }
  json["x"] = {{"name", entry.x_name}, {"label", entry.x_label}};
  json["y"] = {{"name", entry.y_name}, {"label", entry.y_label}};
  json["selection"] = entry.selection;
  json["rows_left_out"] = entry.rows_left_out;
  json["data"] = data_json(entry);
  json["curve"] = r.ran ? curve_json(entry, r.values()) : Json(nullptr);
  json["thesis_curve"] = thesis_curve(entry);
  json["parameters"] = Json::array();
  for (std::size_t i = 0; i < r.parameters.size(); ++i)
    json["parameters"].push_back(parameter_json(entry, i));
  json["rms"] = r.ran ? number_or_null(r.rms) : Json(nullptr);
  json["n"] = r.n;
  json["n_effective"] = r.ran ? number_or_null(r.n_effective) : Json(nullptr);
  json["degrees_of_freedom"] = r.ran ? number_or_null(r.degrees_of_freedom) : Json(nullptr);
  json["extra_scatter"] = r.ran ? number_or_null(r.extra_scatter) : Json(nullptr);
  json["stderr_from"] = r.stderr_from;
  json["condition"] = r.ran ? number_or_null(r.condition) : Json(nullptr);
  json["starts"] = r.starts;
  json["best_found"] = r.best_found;
  json["exit"] = r.exit;
  return json;
}

void append_not_determined(const FitEntry& entry, Json& list) {
  for (const FitEstimate& e : entry.result.parameters) {
    if (e.determined) continue;
    list.push_back(
        {{"fit", entry.name}, {"role", name_of(entry.role)}, {"parameter", e.name}, {"reason", e.reason}});
  }
}

}  // namespace grainlaw::calibrate
