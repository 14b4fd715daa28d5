#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "grainlaw/apps/report/figure.hpp"
#include "grainlaw/apps/report/numbers.hpp"
#include "grainlaw/apps/report/prose.hpp"
#include "grainlaw/apps/report/sections.hpp"
#include "grainlaw/apps/report/symbols.hpp"
#include "grainlaw/model/laws/jamming_density.hpp"

namespace grainlaw::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t line_points = 80;

/// One measured point of a fit with the quantity that its law needs beside x.
struct Point {
  double x, y, known;
};

std::vector<Point> points_of(const FitView& fit, const std::string& known) {
  std::vector<Point> points;
  for (const Json& data : value_in(fit.json, "data")) {
    const auto x = numbers_in(data, "x"), y = numbers_in(data, "y"), z = numbers_in(data, known);
    for (std::size_t i = 0; i < std::min({x.size(), y.size(), z.size()}); ++i)
      points.push_back({x[i], y[i], z[i]});
  }
  return points;
}

/// Eqs. 5.1 and 5.5 with the fitted or the thesis's numbers; none where one is missing.
std::optional<model::OverCompression> law_of(const FitView& fit, std::optional<double> FitParameter::*which) {
  std::map<std::string, double> value;
  for (const FitParameter& p : fit.parameters)
    if (p.*which) value[p.name] = *(p.*which);
  for (const char* name : {"phi_SJ", "mu", "beta", "alpha_max", "alpha_phi"})
    if (!value.contains(name)) return std::nullopt;
  return model::OverCompression{value["phi_SJ"], value["mu"], value["beta"], value["alpha_max"],
                                value["alpha_phi"]};
}

/// Amplitudes as they were wanted, to 1e-4.
double amplitude(double phi_max) { return std::round(phi_max * 1e4) / 1e4; }

struct Cycles {
  std::map<double, Series> dots;  ///< phi_J over M, by amplitude
  double most = 1;                ///< M
};

Cycles cycles_of(const std::vector<Point>& points) {
  Cycles cycles;
  for (const Point& p : points) {
    Series& series = cycles.dots[amplitude(p.x)];
    series.x.push_back(p.known);
    series.y.push_back(p.y);
    cycles.most = std::max(cycles.most, p.known);
  }
  std::size_t i = 0;
  for (auto& [phi_max, series] : cycles.dots) {
    series.label = "φ_max = " + number(phi_max, 3);
    series.draw = Draw::dots;
    const double last = static_cast<double>(cycles.dots.size() - 1);
    series.colour = ramp(last > 0 ? static_cast<double>(i++) / last : 0);
  }
  return cycles;
}

Series over_cycles(const model::OverCompression& law, double phi_max, double most, const std::string& label,
                   Draw draw, const std::string& colour) {
  Series line{label, draw, colour, {}, {}};
  for (std::size_t i = 0; i < line_points; ++i) {
    const double M = std::pow(most, static_cast<double>(i) / (line_points - 1));
    line.x.push_back(M);
    line.y.push_back(model::jamming_density_after(law, phi_max, M));
  }
  return line;
}

Panel cycles_panel(const FitView& fit, Area area) {
  Panel panel{area, "", "cycles {/:Italic M} (–)", "jamming density {/:Italic φ}_J (–)", {}, {}, {}};
  panel.log_x = true;
  const Cycles cycles = cycles_of(points_of(fit, "M"));
  const auto law = law_of(fit, &FitParameter::value);
  for (const auto& [phi_max, dots] : cycles.dots) {
    panel.series.push_back(dots);
    if (!law) continue;
    panel.series.push_back(over_cycles(*law, phi_max, cycles.most, dots.label, Draw::line, dots.colour));
    panel.series.back().in_legend = false;
  }
  return panel;
}

Series over_amplitudes(const model::OverCompression& law, double M, double low, double high,
                       const std::string& label, Draw draw, const std::string& colour) {
  Series line{label, draw, colour, {}, {}};
  for (std::size_t i = 0; i < line_points; ++i) {
    const double phi_max = low + (high - low) * static_cast<double>(i) / (line_points - 1);
    line.x.push_back(phi_max);
    line.y.push_back(model::jamming_density_after(law, phi_max, M));
  }
  return line;
}

/// First and last cycle of each record over its amplitude.
Panel amplitudes_panel(const FitView& fit, Area area) {
  Panel panel{
      area, "", "largest volume fraction {/:Italic φ}_{max} (–)", "jamming density {/:Italic φ}_J (–)", {},
      {},   {}};
  Series first{"M = 1", Draw::dots, nth_colour(0), {}, {}}, ten{"M = 10", Draw::dots, nth_colour(1), {}, {}};
  double low = 1, high = 0;
  for (const Point& p : points_of(fit, "M")) {
    low = std::min(low, p.x);
    high = std::max(high, p.x);
    if (p.known != 1 && p.known != 10) continue;
    Series& series = p.known == 1 ? first : ten;
    series.x.push_back(p.x);
    series.y.push_back(p.y);
  }
  panel.series = {first, ten};
  const auto add = [&](const auto& law, Draw draw, const std::string& whose) {
    if (!law) return;
    const double from = std::min(low, law->phi_SJ);
    panel.series.push_back(over_amplitudes(*law, 1, from, high, whose, draw, nth_colour(0)));
    panel.series.push_back(over_amplitudes(*law, 10, from, high, whose, draw, nth_colour(1)));
    panel.series.push_back(over_amplitudes(*law, 1e9, from, high, whose + ", M → ∞", draw, ink));
    for (std::size_t i = 1; i <= 3; ++i) panel.series[panel.series.size() - i].in_legend = i == 1;
  };
  add(law_of(fit, &FitParameter::value), Draw::line, "fit");
  add(law_of(fit, &FitParameter::thesis), Draw::dashes, "thesis");
  return panel;
}

double value_of(const FitView& fit, const std::string& name) {
  for (const FitParameter& p : fit.parameters)
    if (p.name == name && p.value) return *p.value;
  return nan;
}

/// Strains over the distance from both densities, on which Eq. 5.2 is one curve.
Panel collapse_panel(const FitView& fit, Area area) {
  Panel panel{area,
              "",
              "({/:Italic φ} − {/:Italic φ}_{SJ})/({/:Italic φ}_J − {/:Italic φ}_{SJ}) (–)",
              "strain to jam {/:Italic ε}_{SJ} (–)",
              {},
              {},
              {}};
  const double limit = value_of(fit, "phi_SJ_sheared"), alpha = value_of(fit, "alpha"),
               eps0 = value_of(fit, "eps0");
  Series dots{"DEM, one run", Draw::dots, measured_colour, {}, {}};
  for (const Point& p : points_of(fit, "phi_J0")) {
    dots.x.push_back((p.x - limit) / (p.known - limit));
    dots.y.push_back(p.y);
  }
  Series line{"fit", Draw::line, mode_colour("d2"), {}, {}}, thesis{"thesis", Draw::dashes, ink, {}, {}};
  for (std::size_t i = 1; i < line_points; ++i) {
    const double scaled = static_cast<double>(i) / line_points;
    line.x.push_back(scaled);
    line.y.push_back(eps0 * std::pow(-std::log(scaled), 1 / alpha));
  }
  panel.series = {dots, line};
  std::map<std::string, double> theirs;
  for (const FitParameter& p : fit.parameters)
    if (p.thesis) theirs[p.name] = *p.thesis;
  if (theirs.contains("alpha") && theirs.contains("eps0")) {
    for (const double scaled : line.x) {
      thesis.x.push_back(scaled);
      thesis.y.push_back(theirs["eps0"] * std::pow(-std::log(scaled), 1 / theirs["alpha"]));
    }
    panel.series.push_back(thesis);
  }
  return panel;
}

Panel reversal_panel(const FitView& fit, Area area) {
  Panel panel{area, "", axis_label("nu", ""), "strain to jam again {/:Italic ε}_{SJ,R} (–)", {}, {}, {}};
  Series dots{"DEM, one run", Draw::dots, measured_colour, {}, {}};
  for (const FitPoints& data : fit.data) {
    dots.x.insert(dots.x.end(), data.x.begin(), data.x.end());
    dots.y.insert(dots.y.end(), data.y.begin(), data.y.end());
  }
  panel.series = {dots, {"fit", Draw::line, mode_colour("d2"), fit.curve.x, fit.curve.y}};
  return panel;
}

}  // namespace

Markup memory_figures(const std::vector<FitView>& fits) {
  std::vector<const FitView*> laws;
  for (const FitView& fit : fits)
    if (fit.group == "memory" && !fit.data.empty()) laws.push_back(&fit);
  if (laws.empty()) return {};
  Figure figure;
  figure.name = "memory";
  figure.alt =
      "Jamming density over cycles and amplitude of over-compression, and the strains that jam by shear";
  figure.smallest_width = "560px";
  std::size_t panels = laws.size();
  for (const FitView* fit : laws) panels += fit->family == "phi_J" ? 1 : 0;
  const auto areas = grid(figure, panels, 2, 240);
  std::size_t next = 0;
  figure.caption =
      "<b>Memory: the jamming density after over-compression, and shear jamming</b> (Figs. 5.1, 5.6, 5.2 and 5.13 of the thesis). "_html;
  for (const FitView* fit : laws) {
    if (fit->family == "phi_J") {
      figure.panels.push_back(cycles_panel(*fit, areas[next++]));
      figure.panels.push_back(amplitudes_panel(*fit, areas[next++]));
    } else if (fit->family == "eps_SJ") {
      figure.panels.push_back(collapse_panel(*fit, areas[next++]));
    } else {
      figure.panels.push_back(reversal_panel(*fit, areas[next++]));
    }
    figure.caption += prose(fit->law, fit->group) + ". "_html;
  }
  return "<h3>Memory of the jamming density</h3>\n"_html + draw(figure);
}

}  // namespace grainlaw::report
