#include <algorithm>
#include <cmath>
#include <map>

#include "grainlaw/apps/report/axis.hpp"
#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"

namespace grainlaw::report {
namespace {

constexpr std::size_t dots_per_run = 110;

/// Fits of one test (all its seeds), or of tests that one fit pools.
struct TestFits {
  std::string test;
  double nu = std::nan("");  ///< volume fraction of the first of them, NaN if unknown
  std::vector<const FitView*> fits;
};

std::string first_test(const FitView& fit) {
  for (const FitPoints& data : fit.data) {
    if (!data.test.empty()) return data.test;
  }
  const Json& tests = value_in(fit.json, "tests");
  return tests.is_array() && !tests.empty() && tests[0].is_string() ? tests[0].get<std::string>() : fit.name;
}

double density_of(const Inputs& inputs, const std::string& run_name) {
  const Run* run = inputs.run(run_name);
  return run && run->record ? (*run->record)["nu"].front() : std::nan("");
}

std::vector<TestFits> by_test(const Inputs& inputs, const std::vector<const FitView*>& fits) {
  std::vector<TestFits> tests;
  for (const FitView* fit : fits) {
    const std::string run = first_test(*fit), test = split_seed(run).first;
    auto found = std::find_if(tests.begin(), tests.end(), [&](const TestFits& t) { return t.test == test; });
    if (found == tests.end()) found = tests.insert(tests.end(), {test, density_of(inputs, run), {}});
    found->fits.push_back(fit);
  }
  std::stable_sort(tests.begin(), tests.end(),
                   [](const TestFits& a, const TestFits& b) { return a.nu < b.nu; });
  return tests;
}

std::string seed_label(const std::string& run) {
  const auto seed = split_seed(run).second;
  return seed ? "seed " + std::to_string(*seed) : run;
}

Panel test_panel(const TestFits& test, Area area) {
  const FitView& first = *test.fits[0];
  std::string title = enhanced(test.test);
  if (first.for_comparison()) title += " (comparison)";
  if (std::isfinite(test.nu)) title += ": {/:Italic ν} = " + number(test.nu, 3);
  Panel panel{
      area, title, axis_label(first.x_name, first.x_label), axis_label(first.y_name, first.y_label), {},
      {},   {}};
  std::size_t n = 0;
  for (const FitView* fit : test.fits) {
    for (const FitPoints& data : fit->data) {
      Series dots{seed_label(data.test), Draw::dots, nth_colour(n++), thinned(data.x, dots_per_run),
                  thinned(data.y, dots_per_run)};
      panel.series.push_back(std::move(dots));
    }
  }
  n = 0;
  for (const FitView* fit : test.fits) {
    const bool pooled = fit->data.size() > 1;
    Series line{pooled ? "fit to all seeds" : seed_label(first_test(*fit)) + ", fit", Draw::line,
                pooled ? ink : nth_colour(n), fit->curve.x, fit->curve.y};
    line.in_legend = pooled;
    panel.series.push_back(std::move(line));
    n += fit->data.size();
  }
  return panel;
}

/// The same axes in every panel, so that heights compare.
void share_ranges(Figure& figure) {
  std::vector<double> xs, ys;
  for (const Panel& panel : figure.panels) {
    for (const Series& series : panel.series) {
      xs.insert(xs.end(), series.x.begin(), series.x.end());
      ys.insert(ys.end(), series.y.begin(), series.y.end());
    }
  }
  for (Panel& panel : figure.panels) {
    panel.x_range = padded_range(xs);
    panel.y_range = padded_range(ys);
  }
}

Markup run_figure(const Inputs& inputs, const std::vector<const FitView*>& fits) {
  const FitView& first = *fits[0];
  const auto tests = by_test(inputs, fits);
  Figure figure;
  figure.name = "runs-" + first.mode + "-" + first.y_name;
  figure.alt = first.y_name + " over shear strain in mode " + mode_name(first.mode) + ", one panel per test";
  figure.smallest_width = "640px";
  const auto areas =
      grid(figure, tests.size(), std::min<std::size_t>(3, std::max<std::size_t>(2, tests.size())), 170);
  for (std::size_t i = 0; i < tests.size(); ++i) figure.panels.push_back(test_panel(tests[i], areas[i]));
  share_ranges(figure);
  figure.key = {{"DEM", Draw::dots, measured_colour, {}, {}}, {"fit", Draw::line, measured_colour, {}, {}}};
  figure.caption = element("b", text(mode_name(first.mode) + ", ") + symbol(first.y_name)) + ": "_html +
                   prose(first.law, first.group) + ". All panels have the same scales."_html;
  return draw(figure);
}

Panel saturation_panel(const FitView& fit, Area area) {
  Panel panel{area, "", axis_label("nu", ""), axis_label(fit.row, fit.y_label), {}, {}, {}};
  Series dots{"DEM, one run", Draw::dots, measured_colour, {}, {}};
  Series bars{"DEM, one run", Draw::bars, measured_colour, {}, {}};
  for (const FitPoints& data : fit.data) {
    Series& target = data.error.empty() ? dots : bars;
    target.x.insert(target.x.end(), data.x.begin(), data.x.end());
    target.y.insert(target.y.end(), data.y.begin(), data.y.end());
    target.error.insert(target.error.end(), data.error.begin(), data.error.end());
  }
  panel.series = {dots, bars, {"fit", Draw::line, mode_colour("d2"), fit.curve.x, fit.curve.y}};
  panel.series.push_back({"thesis, Table 2.2", Draw::dashes, ink, fit.thesis_curve.x, fit.thesis_curve.y});
  panel.series.back().sets_range = false;
  return panel;
}

}  // namespace

Markup shear_run_figures(const Inputs& inputs, const std::vector<FitView>& fits) {
  std::vector<std::pair<std::pair<std::string, std::string>, std::vector<const FitView*>>> families;
  for (const FitView& fit : fits) {
    if (!fit.of_one_run()) continue;
    const std::pair key{fit.mode, fit.y_name};
    auto found =
        std::find_if(families.begin(), families.end(), [&](const auto& f) { return f.first == key; });
    if (found == families.end()) found = families.insert(families.end(), {key, {}});
    found->second.push_back(&fit);
  }
  Markup figures;
  for (const auto& [key, members] : families) figures += run_figure(inputs, members);
  return figures;
}

Markup saturation_figure(const std::vector<FitView>& fits) {
  std::vector<const FitView*> laws;
  for (const FitView& fit : fits) {
    if (fit.group == "shear") laws.push_back(&fit);
  }
  if (laws.empty()) return {};
  Figure figure;
  figure.name = "saturation";
  figure.alt = "The four saturation quantities over volume fraction, with the fit and the thesis's curve";
  figure.smallest_width = "560px";
  const auto areas = grid(figure, laws.size(), 2, 220);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    figure.panels.push_back(saturation_panel(*laws[i], areas[i]));
  }
  figure.caption =
      "<b>How far and how fast shear goes, over volume fraction</b>: Q = Q<sub>max</sub> + Q<sub>v</sub> "
      "exp[−α(ν/ν<sub>c</sub> − 1)] (Eq. 2.20). Bars: one standard error of the run's own fit, where it is known."_html;
  return draw(figure);
}

Markup other_figures(const std::vector<FitView>& fits) {
  Markup figures;
  std::size_t n = 0;
  for (const FitView& fit : fits) {
    const bool past_thesis =
        fit.group == "shear_axial" || fit.group == "volumetric";  // without a figure of their own
    const bool shown = fit.of_one_run() || (!fit.group.empty() && !past_thesis);
    if (shown || fit.data.empty()) continue;
    Figure figure;
    figure.name = "fit-" + std::to_string(++n);
    figure.alt = "Data and curve of the fit " + fit.name;
    figure.width = 560;
    const auto areas = grid(figure, 1, 1, 240);
    Panel panel{areas[0], "", axis_label(fit.x_name, fit.x_label), axis_label(fit.y_name, fit.y_label), {},
                {},       {}};
    for (const FitPoints& data : fit.data) {
      panel.series.push_back(
          {"DEM", Draw::dots, measured_colour, thinned(data.x, 300), thinned(data.y, 300)});
    }
    panel.series.push_back({"fit", Draw::line, mode_colour(fit.mode), fit.curve.x, fit.curve.y});
    figure.panels.push_back(std::move(panel));
    figure.caption = element("b", text(fit.name)) + ": "_html + prose(fit.law, fit.group);
    figures += draw(figure);
  }
  return figures;
}

}  // namespace grainlaw::report
