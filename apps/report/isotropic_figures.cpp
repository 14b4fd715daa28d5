#include <algorithm>
#include <cmath>
#include <iterator>

#include "grainlaw/apps/report/axis.hpp"
#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr std::size_t dots_per_test = 90;

std::vector<Series> measured(const FitView& fit) {
  std::vector<Series> all;
  for (const FitPoints& data : fit.data) {
    Series series{data.test, Draw::dots, mode_colour(fit.mode), thinned(data.x, dots_per_test),
                  thinned(data.y, dots_per_test)};
    series.in_legend = false;
    if (!data.error.empty()) {
      series.draw = Draw::bars;
      series.error = thinned(data.error, dots_per_test);
    }
    all.push_back(std::move(series));
  }
  return all;
}

Series line_of(const FitView& fit, const FitPoints& curve, Draw draw, const std::string& label) {
  return {label, draw, mode_colour(fit.mode), curve.x, curve.y};
}

/// All modes in one plot: dots behind, lines before them, the thesis's dashed.
Panel overview(const std::vector<const FitView*>& fits, const Inputs& inputs, Area area) {
  const FitView& first = *fits[0];
  Panel panel{area, "", axis_label(first.x_name, first.x_label), axis_label(first.y_name, first.y_label), {},
              {},   {}};
  for (const FitView* fit : fits) {
    for (Series& series : measured(*fit)) panel.series.push_back(std::move(series));
  }
  for (const FitView* fit : fits) {
    if (!fit->ran()) continue;
    panel.series.push_back(line_of(*fit, fit->curve, Draw::line, fit->mode_label()));
    panel.series.push_back(line_of(*fit, fit->thesis_curve, Draw::dashes, mode_name(fit->mode) + ", thesis"));
    panel.series.back().in_legend = false;
    panel.series.back().sets_range = false;
  }
  const auto unit = inputs.stress_unit_kPa();
  if (unit && first.y_name == "P") {
    panel.right_unit = *unit;
    panel.right_label = "{/:Italic P} (kPa)";
  }
  return panel;
}

/// What the fit leaves over, a strip per fit, all of one scale.
std::vector<Panel> residuals(const std::vector<const FitView*>& fits, Area area) {
  std::vector<Panel> strips;
  std::vector<double> all;
  const double height = area.height / static_cast<double>(fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const FitView& fit = *fits[i];
    const bool lowest = i + 1 == fits.size();
    const double top = area.top + height * static_cast<double>(i) + 18;
    Panel panel{{area.left, top, area.width, height - (lowest ? 18 : 26)},
                enhanced(mode_name(fit.mode)) + (fit.for_comparison() ? ", comparison" : ""),
                axis_label(fit.x_name, fit.x_label),
                "",
                {},
                {},
                {}};
    panel.x_numbers = lowest;
    panel.zero_line = true;
    for (Series& series : measured(fit)) {
      for (std::size_t k = 0; k < series.x.size(); ++k) {
        series.y[k] -= fitted(fit, series.x[k]);
        const double reach = series.draw == Draw::bars ? series.error[k] : 0;
        all.insert(all.end(), {series.y[k] - reach, series.y[k] + reach});
      }
      panel.series.push_back(std::move(series));
    }
    strips.push_back(std::move(panel));
  }
  const auto range = padded_range(all);
  const double reach = std::max(std::abs(range[0]), std::abs(range[1]));
  for (Panel& panel : strips) panel.y_range = {-reach, reach};
  return strips;
}

std::array<double, 2> common_range(const Panel& panel) {
  std::vector<double> xs;
  for (const Series& series : panel.series) {
    if (series.sets_range) xs.insert(xs.end(), series.x.begin(), series.x.end());
  }
  return padded_range(xs);
}

Markup caption_of(const FitView& fit) {
  Markup caption = element("b", symbol(fit.y_name)) + ": "_html + prose(fit.law, fit.group) + ". "_html;
  const std::string selection = text_in(fit.json, "selection");
  if (!selection.empty()) caption += text(mode_name(fit.mode) + ": ") + prose(selection) + ". "_html;
  return caption + "Left, all modes; right, data − curve."_html;
}

Markup family_figure(const std::vector<const FitView*>& fits, const Inputs& inputs) {
  const FitView& first = *fits[0];
  Figure figure;
  figure.name = "isotropic-" + first.family;
  figure.alt = "Data and fitted curves of " + first.y_name + " over volume fraction, one colour per mode";
  figure.smallest_width = "640px";

  std::vector<const FitView*> with_curve;
  std::copy_if(fits.begin(), fits.end(), std::back_inserter(with_curve),
               [](const FitView* fit) { return fit->ran(); });
  const double height = std::max(300.0, 92.0 * static_cast<double>(with_curve.size()));
  figure.height = height + 62;
  figure.panels = residuals(with_curve, {640, 12, 266, height});
  figure.panels.insert(figure.panels.begin(), overview(fits, inputs, {66, 12, 450, height}));
  const auto x_range = common_range(figure.panels[0]);
  for (Panel& panel : figure.panels) panel.x_range = x_range;
  for (const FitView* fit : fits) {
    if (!fit->ran())
      figure.key.push_back(
          {mode_name(fit->mode) + ", too few for a fit", Draw::dots, mode_colour(fit->mode), {}, {}});
  }
  figure.key.push_back({"DEM", Draw::dots, measured_colour, {}, {}});
  figure.key.push_back({"fit", Draw::line, measured_colour, {}, {}});
  const bool with_thesis =
      std::any_of(fits.begin(), fits.end(), [](const FitView* fit) { return !fit->thesis_curve.x.empty(); });
  if (with_thesis) figure.key.push_back({"thesis, Table 2.1", Draw::dashes, measured_colour, {}, {}});
  figure.caption = caption_of(first);
  return draw(figure);
}

}  // namespace

Markup isotropic_figures(const Inputs& inputs, const std::vector<FitView>& fits) {
  std::vector<std::string> families;
  for (const FitView& fit : fits) {
    const bool seen = std::find(families.begin(), families.end(), fit.family) != families.end();
    if (fit.group == "isotropic" && !seen) families.push_back(fit.family);
  }
  Markup figures;
  for (const std::string& family : families) {
    std::vector<const FitView*> members;
    for (const FitView& fit : fits) {
      if (fit.group == "isotropic" && fit.family == family) members.push_back(&fit);
    }
    figures += family_figure(members, inputs);
  }
  return figures;
}

}  // namespace grainlaw::report
