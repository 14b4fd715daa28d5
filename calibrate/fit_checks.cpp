#include "grainlaw/calibrate/fit_checks.hpp"

#include <cmath>
#include <cstdio>
#include <string>

#include "grainlaw/element/error.hpp"

namespace grainlaw::calibrate {
namespace {

std::string rounded(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string with_error(const FitEstimate& e, int digits) {
  return rounded(e.value, digits) + (e.stderr_ ? " ± " + rounded(*e.stderr_, digits) : "");
}

Json check(const std::string& name, const std::string& value, bool known, bool holds) {
  return {{"name", name},
          {"value", known ? value : "not determined"},
          {"holds", known ? Json(holds) : Json(nullptr)}};
}

/// None where the mode has no fit or this parameter is not fitted.
const FitEstimate* fitted(const std::map<std::string, PackingFit>& packing, const std::string& mode,
                          FitResult PackingFit::*law, const std::string& name) {
  const auto found = packing.find(mode);
  if (found == packing.end() || !(found->second.*law).ran) return nullptr;
  const FitEstimate& e = (found->second.*law)[name];
  return e.determined && !e.held ? &e : nullptr;
}

/// The difference must be two standard errors.
Json jamming_order(const Account& account) {
  const std::string name = "nu_c(ISO) > nu_c(D2)";
  const FitEstimate* iso = fitted(account.packing, "iso", &PackingFit::pressure, "nu_c");
  const FitEstimate* d2 = fitted(account.packing, "d2", &PackingFit::pressure, "nu_c");
  if (iso == nullptr || d2 == nullptr) return check(name, "", false, false);
  const double difference = iso->value - d2->value;
  const double error = std::hypot(iso->stderr_.value_or(0), d2->stderr_.value_or(0));
  return check(name,
               with_error(*iso, 4) + (difference > 0 ? " > " : " <= ") + with_error(*d2, 4) + ", by " +
                   rounded(difference, 4) + " ± " + rounded(error, 4),
               true, difference > 2 * error);
}

/// Says how much C0 depends on the lowest pressure that rows are taken from.
Json isostatic(const Account& account) {
  const std::string name = "C0, left free, is 6 ± 0.2";
  const FitEstimate* C0 = fitted(account.packing, "iso", &PackingFit::contacts_free_C0, "C0");
  if (C0 == nullptr) return check(name, "", false, false);
  const FitEstimate* narrow = fitted(account.narrow, "iso", &PackingFit::contacts_free_C0, "C0");
  const std::string sensitivity =
      narrow == nullptr ? ""
                        : "; " + rounded(narrow->value, 2) + " from P >= " + to_text(account.narrow_P_min);
  return check(name, with_error(*C0, 2) + sensitivity, true, std::abs(C0->value - 6) <= 0.2);
}

Json pressure_slope(const Account& account) {
  const FitEstimate* p0 = fitted(account.packing, "iso", &PackingFit::pressure, "p0");
  return check("p0 is within 10 % of 0.042", p0 != nullptr ? with_error(*p0, 4) : "", p0 != nullptr,
               p0 != nullptr && std::abs(p0->value / 0.042 - 1) <= 0.1);
}

/// By a straight line through the runs, not by Eq. 2.20: the slope must be negative by two standard errors.
Json falls(const Account& account, ShearQuantity quantity) {
  const auto d2 = account.run_values.find("d2");
  const bool any = d2 != account.run_values.end() && d2->second.contains(quantity);
  const Trend trend = any ? trend_of(d2->second.at(quantity)) : Trend{};
  return check(name_of(quantity) + " falls with nu",
               "slope of a line: " + rounded(trend.slope, 3) + " ± " + rounded(trend.error, 3), trend.known,
               trend.slope < -2 * trend.error);
}

}  // namespace

Json physics_checks(const Account& account) {
  return Json::array({jamming_order(account), isostatic(account), falls(account, ShearQuantity::s_max),
                      falls(account, ShearQuantity::F_max), pressure_slope(account)});
}

}  // namespace grainlaw::calibrate
