#include <algorithm>

#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

Markup parameter_piece(const FitView& fit, const FitParameter& parameter) {
  Markup piece = parameter_symbol(fit, parameter.name) + " = "_html;
  // A parameter that the data leave open is held at the thesis's value; that value is not a result.
  piece += parameter.determined || parameter.held ? text(with_error(parameter.value, parameter.error))
                                                  : text(nothing);
  if (!parameter.determined) piece += element("span", " not determined"_html, {{"class", "off"}});
  if (parameter.held && parameter.determined) piece += element("span", " (held)"_html, {{"class", "quiet"}});
  if (parameter.at_bound) piece += element("span", " at its bound"_html, {{"class", "off"}});
  return element("span", piece, {{"class", "whole"}});
}

/// How the result depends on the lowest pressure that rows are taken from: not in the standard error.
Markup shifts(const FitView& fit) {
  std::vector<Markup> pieces;
  for (const FitParameter& parameter : fit.parameters) {
    if (!parameter.shift) continue;
    const std::string shift = number(*parameter.shift, 2);
    pieces.push_back(parameter_symbol(fit, parameter.name) +
                     text(*parameter.shift > 0 ? " +" + shift : " " + shift));
  }
  if (pieces.empty()) return {};
  return element("div", "from four times the lowest pressure on: "_html + join(pieces, ", "_html),
                 {{"class", "under"}});
}

Markup parameters_cell(const FitView& fit) {
  if (!fit.ran()) return text(nothing);
  std::vector<Markup> pieces;
  for (const FitParameter& parameter : fit.parameters) pieces.push_back(parameter_piece(fit, parameter));
  return pieces.empty() ? text(nothing) : join(pieces, ", "_html) + shifts(fit);
}

Markup points_cell(const FitView& fit) {
  const auto n = number_in(fit.json, "n"), effective = number_in(fit.json, "n_effective");
  Markup cell = text(number(n, 7));
  if (effective) cell += " ("_html + text(number(effective, 3)) + ")"_html;
  return cell;
}

Markup starts_cell(const FitView& fit) {
  const auto starts = number_in(fit.json, "starts"), best = number_in(fit.json, "best_found");
  if (!starts || *starts == 0) return text(nothing);
  return text((best ? number(best) : nothing) + " of " + number(starts));
}

/// What all fits say under a key, or nothing if they differ.
std::string common_text(const std::vector<const FitView*>& fits, const std::string& key) {
  const std::string first = text_in(fits[0]->json, key);
  const bool all =
      std::all_of(fits.begin(), fits.end(), [&](const FitView* f) { return text_in(f->json, key) == first; });
  return all ? first : "";
}

Markup name_cell(const FitView& fit) {
  Markup name = text(fit.name);
  if (fit.for_comparison()) name += element("div", "for comparison only"_html, {{"class", "under"}});
  return name;
}

/// Exit and source of the errors, in words.
Markup ending_cell(const FitView& fit, bool with_exit, bool with_errors) {
  const std::string exit = text_in(fit.json, "exit"), errors = text_in(fit.json, "stderr_from");
  Markup cell;
  if (with_exit) cell = prose(exit.empty() ? nothing : exit);
  // A fit that did not run has no errors.
  if (with_errors && fit.ran() && !errors.empty()) {
    if (with_exit) cell += "; errors from "_html;
    cell += prose(errors);
  }
  return element("div", cell, {{"class", "long"}});
}

/// Residual, condition and exit of a family of fits. What they all have in common stands above the table.
Markup quality_of(const std::string& title, const std::vector<const FitView*>& fits) {
  if (fits.empty()) return {};
  using Kind = Table::Kind;
  const std::string exit = common_text(fits, "exit"), errors = common_text(fits, "stderr_from");
  Table table;
  table.column("Fit"_html).column("Result"_html).column("Points (effective)"_html, Kind::figures);
  table.column("Residual, rms"_html, Kind::figures).column("Condition"_html, Kind::figures);
  table.column("Starts"_html, Kind::figures);
  const bool endings_differ = exit.empty() || errors.empty();
  if (endings_differ) table.column(exit.empty() ? "How it ended"_html : "Standard errors from"_html);
  for (const FitView* fit : fits) {
    std::vector<Markup> cells{name_cell(*fit),
                              parameters_cell(*fit),
                              points_cell(*fit),
                              text(number(number_in(fit->json, "rms"), 3)),
                              text(number(number_in(fit->json, "condition"), 2)),
                              starts_cell(*fit)};
    if (endings_differ) cells.push_back(ending_cell(*fit, exit.empty(), errors.empty()));
    table.row(cells);
  }
  Markup intro = element("b", text(title + ". "));
  if (!exit.empty()) intro += "All ended so: "_html + prose(exit) + ". "_html;
  if (!errors.empty()) intro += "Standard errors from: "_html + prose(errors) + ". "_html;
  return element("p", intro) + table.html("small");
}

/// A list of reasons, each with everything it holds for before it.
class Reasons {
 public:
  void add(const std::string& what, const std::string& reason) {
    const auto known =
        std::find_if(list_.begin(), list_.end(), [&](const auto& r) { return r.first == reason; });
    if (known == list_.end()) {
      list_.emplace_back(reason, what);
    } else {
      known->second += ", " + what;
    }
  }
  Markup html() const {
    Markup items;
    for (const auto& [reason, what] : list_) {
      items +=
          element("li", element("b", text(what)) + ": "_html + prose(reason.empty() ? nothing : reason)) +
          "\n"_html;
    }
    return items.empty() ? items : element("ul", items);
  }

 private:
  std::vector<std::pair<std::string, std::string>> list_;
};

/// Fits of tests kept for comparison that had too few data.
Markup not_run(const std::vector<FitView>& fits) {
  Reasons reasons;
  for (const FitView& fit : fits) {
    if (fit.idle()) reasons.add(fit.name, text_in(fit.json, "exit"));
  }
  const Markup list = reasons.html();
  return list.empty() ? list : element("p", "<b>For comparison only, too few data.</b>"_html) + list;
}

Markup quality(const std::vector<FitView>& fits) {
  std::vector<const FitView*> isotropic, runs, saturation, moduli, near, other;
  for (const FitView& fit : fits) {
    if (fit.idle()) continue;
    auto& family = fit.group == "isotropic"         ? isotropic
                   : fit.group.starts_with("shear") ? saturation
                   : fit.group == "moduli"          ? moduli
                   : fit.group == "near_jamming"    ? near
                   : fit.of_one_run()               ? runs
                                                    : other;
    family.push_back(&fit);
  }
  return "<h3>Residual, condition, exit</h3>\n"_html + quality_of("Isotropic laws", isotropic) +
         quality_of("Shear of single runs", runs) +
         quality_of("Saturation over volume fraction", saturation) +
         quality_of("Small-strain moduli", moduli) + quality_of("Near jamming", near) +
         quality_of("Other fits", other) + not_run(fits) +
         element("p",
                 "Points in brackets: how many independent points the rows are worth, since neighbouring "
                 "rows of one run resemble each other. Residual: root mean square of data − fit, in the unit "
                 "of the data. Condition: how much the worst-determined combination of parameters amplifies "
                 "noise compared with the best-determined one; large numbers mean that parameters can trade "
                 "off against each other. Starts: in how many of the starting points tried the best solution "
                 "was reached. From four times the lowest pressure on: how far a parameter moves where only "
                 "rows at larger pressure are taken; no part of the standard error."_html,
                 {{"class", "note"}});
}

Markup left_out(const Inputs& inputs) {
  const Json& list = value_in(inputs.fits, "left_out");
  Reasons reasons;
  if (list.is_array()) {
    for (const Json& entry : list) reasons.add(text_in(entry, "test"), text_in(entry, "reason"));
  }
  const Markup items = reasons.html();
  return items.empty() ? items : "<h3>Records that a fit did not take</h3>\n"_html + items;
}

}  // namespace

Markup fits_section(const Inputs& inputs, const std::vector<FitView>& fits) {
  if (fits.empty()) return absent("No fits: fits.json is not there, or holds none.");
  return "<h3>Isotropic laws</h3>\n"_html + isotropic_figures(inputs, fits) +
         "<h3>Shear at constant volume</h3>\n"_html + shear_run_figures(inputs, fits) +
         saturation_figure(fits) + moduli_figures(inputs, fits) + memory_figures(fits) +
         memory_states_figure(inputs, fits) + minimal_figure(inputs) + other_figures(fits) + quality(fits) +
         left_out(inputs);
}

}  // namespace grainlaw::report
