#include <algorithm>
#include <array>
#include <map>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"
#include "grainlaw/element/median.hpp"

namespace grainlaw::report {
namespace {

Markup verdict(const Json& holds) {
  if (!holds.is_boolean()) return text(nothing);
  return holds.get<bool>() ? element("span", "✓ holds"_html, {{"class", "good"}})
                           : element("span", "✗ fails"_html, {{"class", "bad"}});
}

Markup checks(const Inputs& inputs) {
  const Json& list = value_in(inputs.fits, "checks");
  if (!list.is_array() || list.empty())
    return absent("No physics checks: fits.json is not there, or holds none.");
  Table table;
  table.column("Physics check"_html).column("Measured"_html).column("Verdict"_html);
  std::size_t held = 0, judged = 0;
  for (const Json& check : list) {
    const Json& holds = value_in(check, "holds");
    if (holds.is_boolean()) ++judged;
    if (holds.is_boolean() && holds.get<bool>()) ++held;
    const std::string value = text_in(check, "value");
    table.row({prose(text_in(check, "name")), value.empty() ? text(nothing) : prose(value), verdict(holds)});
  }
  const Markup sentence = element("p", text(std::to_string(held) + " of " + std::to_string(judged) +
                                            " checks that theory demands of the numbers hold."));
  return "<h3>Does the physics show?</h3>\n"_html + sentence + table.html();
}

/// Median error over all predicted runs, by form.
Markup prediction_summary(const Inputs& inputs) {
  const std::vector<std::string> quantities{"P", "sigma_dev", "s_dev", "F_dev"};
  std::vector<std::string> forms;
  std::map<std::pair<std::string, std::string>, std::vector<double>> errors;
  std::map<std::string, std::size_t> runs;
  for (const PredictedRun& run : inputs.predicted) {
    if (std::find(forms.begin(), forms.end(), run.form) == forms.end()) forms.push_back(run.form);
    ++runs[run.form];
    for (const std::string& quantity : quantities) {
      const auto error = number_in(value_in(run.entry, "errors"), quantity);
      if (error) errors[{run.form, quantity}].push_back(*error);
    }
  }
  if (forms.empty()) return {};
  Table table;
  table.column("Form of the law"_html).column("Runs predicted"_html, Table::Kind::figures);
  for (const std::string& quantity : quantities) table.column(symbol(quantity), Table::Kind::figures);
  for (const std::string& form : forms) {
    std::vector<Markup> cells{text(form_name(form)), text(std::to_string(runs[form]))};
    for (const std::string& quantity : quantities) {
      const auto& values = errors[{form, quantity}];
      cells.push_back(text(values.empty() ? nothing : percent(median(values))));
    }
    table.row(cells);
  }
  return "<h3>How well does the law predict tests it never saw?</h3>\n"_html + outdated_predictions(inputs) +
         "<p>Median over the predicted runs of "
         "the relative error "
         "along the path (root mean square of the difference over root mean square of the DEM's values).</p>\n"_html +
         table.html();
}

/// Parameters of one fit that share a reason, in one line. Fits that are listed as not made are left out.
Markup not_determined(const Inputs& inputs, const std::vector<FitView>& fits) {
  const Json& list = value_in(inputs.fits, "not_determined");
  if (!list.is_array() || list.empty()) return {};
  std::vector<std::pair<std::array<std::string, 2>, std::vector<Markup>>> lines;
  for (const Json& entry : list) {
    const std::array<std::string, 2> key{text_in(entry, "fit"), text_in(entry, "reason")};
    const bool idle = std::any_of(fits.begin(), fits.end(),
                                  [&](const FitView& fit) { return fit.name == key[0] && fit.idle(); });
    if (idle) continue;
    if (lines.empty() || lines.back().first != key) lines.push_back({key, {}});
    const std::string group = key[0].substr(0, key[0].find('.'));
    lines.back().second.push_back(symbol(text_in(entry, "parameter"), group));
  }
  if (lines.empty()) return {};
  Markup items;
  for (const auto& [key, names] : lines) {
    items += element("li", join(names, ", "_html) + " of "_html + element("code", text(key[0])) + ": "_html +
                               prose(key[1])) +
             "\n"_html;
  }
  return "<h3>What these data could not determine</h3>\n"_html + element("ul", items);
}

}  // namespace

Markup headline(const Inputs& inputs, const std::vector<FitView>& fits) {
  return checks(inputs) + prediction_summary(inputs) + parameter_tables(inputs, fits) +
         not_determined(inputs, fits);
}

}  // namespace grainlaw::report
